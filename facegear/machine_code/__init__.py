"""How functions are compiled: stored machine code, inlining, choice by type, and four numbers at a time."""
