"""Bodies of gears against other programs."""
