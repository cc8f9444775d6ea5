"""Figures 6 to 20 of the paper, drawn from our results under the paper's numbers."""
