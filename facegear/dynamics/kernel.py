"""How the hot functions are compiled."""

from numba import njit

kernel = njit(cache=True, nogil=True, fastmath={"contract"}, _nrt=False)
"""Compiled without reference counts: kernels allocate nothing, and counting every array of a Packed or Work
at every use would cost more than the arithmetic."""
