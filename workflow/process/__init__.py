"""Process control of a run: what it prints, how it ends, and what a killed one has left behind."""
