"""Strength of the teeth: flank pressure, root stress, safety and life under dynamic load."""
