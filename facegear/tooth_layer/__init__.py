"""The layer that stands for the teeth of a face gear that bends, fitted to one sector of its own teeth."""
