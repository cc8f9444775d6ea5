"""A session of gmsh that leaves the process as it was: no output, no signal handlers of its own."""

import os
from collections.abc import Iterator
from contextlib import contextmanager

from facegear.errors import extras_named

with extras_named():
    import gmsh

VARIABLE = "PETSC_OPTIONS"
"""Environment variable that PETSc reads its options from."""
NO_HANDLERS = "-no_signal_handler"
"""Option by which PETSc leaves signals alone."""


@contextmanager
def gmsh_session(name: str) -> Iterator[None]:
    """Open a session of gmsh with one empty model. gmsh is global: one session at a time.

    PETSc, which gmsh brings, takes over signals when it starts and leaves them at the system's default when
    it ends: a broken pipe would then kill the process, and faulthandler be silent. An environment variable
    tells it not to.

    Parameters
    ----------
    name : str
        Name of the model.

    Yields
    ------
    None
        Once, while the session is open.
    """
    with _asked_of_petsc():
        gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.model.add(name)
        yield
    finally:
        gmsh.finalize()


@contextmanager
def _asked_of_petsc() -> Iterator[None]:
    """Set the environment variable by which PETSc leaves signals alone, and restore it at the end."""
    before = os.environ.get(VARIABLE)
    os.environ[VARIABLE] = f"{before or ''} {NO_HANDLERS}".strip()
    try:
        yield
    finally:
        if before is None:
            del os.environ[VARIABLE]
        else:
            os.environ[VARIABLE] = before
