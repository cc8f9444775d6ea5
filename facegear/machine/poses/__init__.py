"""Poses of meshes: where motions of the bodies put the teeth, and what contact makes of it."""
