"""Steady states of a machine at one speed."""
