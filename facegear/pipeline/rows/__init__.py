"""The rows of the table of stages, chapter by chapter, and what rows have in common."""
