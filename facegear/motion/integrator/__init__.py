"""A system as the compiled kernels integrate it."""
