"""The lumped model: bodies, meshes, matrices, statics and natural modes."""
