"""The kernels compiled once for all processes that start together."""

from functools import cache

import numpy as np

from facegear.dynamics.abreast.many import FEWEST, run_many
from facegear.dynamics.integrator.integrator import Integrator
from facegear.dynamics.integrator.system import FlankRubbing, System
from facegear.mesh_law.force_table import ForceTable
from facegear.mesh_law.law import MeshLaw
from facegear.mesh_law.linear import LinearLaw
from facegear.mesh_law.load_dependent import LoadDependentLaw


def prepare_for(system: System) -> None:
    """`prepare` for the kind of a system."""
    prepare(
        system.ring_clearance.size > 0,
        system.rubbing is not None,
        isinstance(system.law, LoadDependentLaw),
    )


@cache
def prepare(clearance: bool = False, friction: bool = False, load_dependent: bool = False) -> None:
    """Load the stored machine code of the time integration, or compile and store it while others wait.

    clearance, friction, load_dependent: the machine code for machines with bearing clearance, with friction,
    and with the load-dependent law in place of the linear one.
    """
    Integrator(_smallest(clearance, friction, load_dependent), 1.0, 1e-2, 6).run(
        np.zeros((2, 1)), 1, fine=True
    )


@cache
def prepare_abreast() -> None:
    """The same for machines that run side by side."""
    integrator = Integrator(_smallest(False, False, False), 1.0, 1e-2, 6)
    run_many([integrator] * FEWEST, [np.zeros((2, 1))] * FEWEST, 1)


def _smallest(clearance: bool, friction: bool, load_dependent: bool = False) -> System:
    """One coordinate and one mesh, with a ring or without, rubbing or not, of either law: the types are those
    of any such machine.
    """
    rings = np.ones(int(clearance))
    unit, rows, nothing = np.ones(1), np.ones(1 + 3 * rings.size), np.zeros((1, 2, 1))
    row_kinds = np.zeros(rows.size, dtype=np.int64)
    law: MeshLaw = LinearLaw(nothing + 1.0, row_kinds[:1])
    if load_dependent:
        forces = np.arange(2.0)[:, None, None] * nothing
        law = LoadDependentLaw((ForceTable(np.arange(2.0), forces, forces),), row_kinds[:1])
    return System(
        mesh_jacobian=rows[:, None],
        omega_squared=unit,
        damping=unit,
        mesh_damping=rows,
        lower=-rows,
        upper=rows,
        law=law,
        error=nothing,
        error_kind=row_kinds,
        load=nothing,
        ring_stiffness=rings,
        ring_clearance=rings,
        damping_when_open=True,
        scale=1.0,
        rubbing=FlankRubbing(row_kinds[:1], nothing, rows[:1, None]) if friction else None,
    )
