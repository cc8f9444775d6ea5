"""Stiffness and mass matrices of finite-element programs, one module for each file format."""
