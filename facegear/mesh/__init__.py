"""Structured hexahedral meshes of both bodies on the exact surfaces."""
