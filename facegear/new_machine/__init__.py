"""A config to start from, made of what a user knows of a machine."""
