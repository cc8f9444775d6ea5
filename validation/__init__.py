"""Independent answers and speed against error: nothing of the library imports this package."""
