"""The kernels compiled once for all processes that start together."""

import fcntl
import sys
from functools import cache
from pathlib import Path

import numpy as np

from facegear.dynamics.integrator.integrator import Integrator
from facegear.dynamics.integrator.kernel import SOURCES
from facegear.dynamics.integrator.periods import run_periods
from facegear.dynamics.integrator.system import FlankRubbing, System
from facegear.machine_code.compiler import stored_in
from facegear.machine_code.sources import text_of
from facegear.mesh_law.linear import LinearLaw


@cache
def prepare(clearance: bool = False, friction: bool = False) -> None:
    """Load the stored machine code of the time integration, or compile and store it while others wait.

    clearance, friction: the machine code for machines with bearing clearance and with friction; the law is
    linear. Without this, jobs that start at once on a fresh checkout each compile the same for several
    seconds.
    """
    folder = stored_in(run_periods)
    if folder is None:
        return
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with open(folder / "compiling.lock", "w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            parts = f"{'-clearance' if clearance else ''}{'-friction' if friction else ''}"
            _compile(folder / f"compiled-{text_of(*SOURCES)[:16]}{parts}", _smallest(clearance, friction))
    except OSError:
        # A folder that cannot be written keeps no machine code either: each process compiles its own.
        return


def _compile(done: Path, smallest: System) -> None:
    if not done.exists():
        print("compiling the time integration once, some 15 s", file=sys.stderr, flush=True)
    Integrator(smallest, 1.0, 1e-2, 6).run(np.zeros((2, 1)), 1, fine=True)
    done.touch()


def _smallest(clearance: bool, friction: bool) -> System:
    """One coordinate and one mesh, with a ring or without, rubbing or not: the types are those of any such
    machine.
    """
    rings = np.ones(int(clearance))
    unit, rows, nothing = np.ones(1), np.ones(1 + 3 * rings.size), np.zeros((1, 2, 1))
    row_kinds = np.zeros(rows.size, dtype=np.int64)
    return System(
        mesh_jacobian=rows[:, None],
        omega_squared=unit,
        damping=unit,
        mesh_damping=rows,
        lower=-rows,
        upper=rows,
        law=LinearLaw(nothing + 1.0, row_kinds[:1]),
        error=nothing,
        error_kind=row_kinds,
        load=nothing,
        ring_stiffness=rings,
        ring_clearance=rings,
        damping_when_open=True,
        scale=1.0,
        rubbing=FlankRubbing(row_kinds[:1], nothing, rows[:1, None]) if friction else None,
    )
