"""Answers of a gearbox: tables, figures and files of stages, chapter by chapter."""
