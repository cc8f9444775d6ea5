"""Speed sweeps and their jumps."""
