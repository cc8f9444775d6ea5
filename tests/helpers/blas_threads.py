"""One thread of BLAS for all tests: their processes share the cores, and sums come in one order everywhere.

It is read when NumPy is imported, and so this module is imported before.
"""

import os

for library in ("OMP", "MKL", "OPENBLAS"):
    os.environ.setdefault(f"{library}_NUM_THREADS", "1")
