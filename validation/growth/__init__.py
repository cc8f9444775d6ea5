"""Time and memory against the size of what is asked for."""
