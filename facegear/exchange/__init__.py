"""Machines for other programs."""
