"""Thousands of variants of one machine: sampling of tolerances, chunks that resume, statistics."""
