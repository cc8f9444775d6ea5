"""The force of a contact as an object: what it is at a phase and a deflection, and how a motion expands it.

`law.py` says what a law offers, `terms.py` what the compiled functions ask of it, `linear.py` and
`linear_terms.py` are the first law: stiffness times deflection. `force_table.py`,
`load_dependent.py` and `load_dependent_terms.py` are the second: a table of forces over the deflection.
"""
