"""Elasticity of a gear: elements of one tooth, its substructure, the ring of all teeth."""
