"""Mesh stiffness: its curve and Fourier series, and the force laws of contacts."""
