"""Direct elimination of sparse symmetric systems: nested dissection, fronts, Schur complements."""
