"""How evenly the meshes share the load: coefficients, studies, summaries."""
