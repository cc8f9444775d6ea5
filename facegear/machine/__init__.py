"""The lumped model: bodies, meshes, matrices, statics, natural modes and poses."""
