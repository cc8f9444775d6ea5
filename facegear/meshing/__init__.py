"""Mesh stiffness: its curve and Fourier series, and the force laws of contacts.

`law.py` says what a law offers: the force of a contact at a phase and a deflection. `linear.py` is the first
law: stiffness times deflection. `force_table.py` and `load_dependent.py` are the second: a table of forces
over the deflection. The integrator's side of both is C++: `facegear/_kernels/src/motion/laws`.
"""
