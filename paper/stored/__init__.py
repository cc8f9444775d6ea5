"""What the repository stores of the search for the inputs that the paper leaves out (docs/validation.md)."""
