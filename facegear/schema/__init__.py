"""Sections of the config and their validation as far as it needs no geometry."""
