"""Load sharing between meshes: coefficients, hunting cycle, maps and advice."""
