"""Casings: matrices of finite-element programs, reduced to the seats, feet and sensors of a machine."""
