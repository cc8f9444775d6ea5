"""Figures as data, drawn from stored results alone, chapter by chapter."""
