"""Exact tooth surfaces of the pair, unloaded contact, and structured meshes of both bodies."""
