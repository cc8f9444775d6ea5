"""The self-contained HTML page of a case, its figures, and the comparison of two folders of results."""
