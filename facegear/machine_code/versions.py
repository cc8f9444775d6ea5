"""The numba versions whose private parts this package was tried with.

With any other version `compiler.py` and `lanes.py` use the plain, public `njit`: the results are the same,
but nothing is stored between processes and the first call of each process takes a minute or more.
"""

import sys

import numba

KNOWN = ("0.68",)


def is_known(version: str) -> bool:
    """Whether numba of a version, such as 0.68.1, has the private parts that are used here."""
    return ".".join(version.split(".")[:2]) in KNOWN


NUMBA_IS_KNOWN = is_known(numba.__version__) and not numba.config.DISABLE_JIT


def warn_once() -> None:
    """Say on the first plain compilation why this takes long."""
    if not numba.config.DISABLE_JIT and not getattr(warn_once, "done", False):
        warn_once.done = True  # type: ignore[attr-defined]
        text = f"numba {numba.__version__} is not one of {', '.join(KNOWN)}: machine code is not stored"
        print(text, file=sys.stderr, flush=True)
