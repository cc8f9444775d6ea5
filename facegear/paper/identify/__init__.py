"""Search for the inputs that the paper leaves out."""
