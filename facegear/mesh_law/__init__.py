"""The force of a contact as an object: what it is at a phase and a deflection.

`law.py` says what a law offers. `linear.py` is the first law: stiffness times deflection. `force_table.py`
and `load_dependent.py` are the second: a table of forces over the deflection. `laws_at_phases.py` holds a law
at some phases for statics. The integrator's side of both is C++: `facegear/_kernels/src/motion/laws`.
"""
