"""Branches of periodic motions, stable or not, and the points where they change."""
