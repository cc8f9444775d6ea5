"""Thousands of samples: what they cost, and how the error of their statistics falls with their number."""
