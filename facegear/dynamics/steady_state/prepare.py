"""The kernels compiled once for all processes that start together."""

from functools import cache

import numpy as np

from facegear.dynamics.integrator.integrator import Integrator
from facegear.dynamics.integrator.system import FlankRubbing, System
from facegear.mesh_law.linear import LinearLaw


@cache
def prepare(clearance: bool = False, friction: bool = False) -> None:
    """Load the stored machine code of the time integration, or compile and store it while others wait.

    clearance, friction: the machine code for machines with bearing clearance and with friction; the law is
    linear.
    """
    Integrator(_smallest(clearance, friction), 1.0, 1e-2, 6).run(np.zeros((2, 1)), 1, fine=True)


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
