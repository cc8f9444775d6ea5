"""Stored results of the search for inputs that the paper leaves out (docs/explanation/validation.md)."""
