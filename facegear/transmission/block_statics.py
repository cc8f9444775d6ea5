"""Static equilibrium of pinions that touch each other through the gears only, by a compiled kernel.

The method stands in `facegear/_kernels/src/statics/settle.hpp`: a semismooth Newton method with an exact line
search, each pinion eliminated by itself.
"""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np

from facegear._kernels import statics
from facegear.arrays import Array, Integers
from facegear.mesh_law.law import LawAtPhases
from facegear.mesh_law.laws_at_phases import LinearHeld, LoadDependentHeld

KERNELS: Mapping[type, Callable[..., Any]] = {
    LinearHeld: statics.settle_linear,
    LoadDependentHeld: statics.settle_load_dependent,
}
"""The kernel of each law."""


class Springs(NamedTuple):
    """One-sided flanks, bearings and forces of a machine. All unknowns are lengths.

    F flanks, P pinions, n unknowns: x, y, turn of every pinion, then w of every gear. N, m.

    Attributes
    ----------
    jacobian : (F, 3 + w)
        By the unknowns of the flank's pinion and its gear.
    pinion, gear : (F,)
        First unknown of that pinion and of that gear.
    pinion_bearing : (P, 3)
        Stiffness xx, xy, yy, N/m.
    clearance : (P,)
        Clearance of the bearing, m. Where it is positive, xx = yy and xy = 0.
    core_row, core_column, core_value : (E,)
        Entries, row <= column, of the symmetric stiffness among the other n - 3 P unknowns, counted from the
        first of them, N/m.
    loads : (n,)
        Forces on the unknowns, N.
    """

    jacobian: Array
    pinion: Integers
    gear: Integers
    pinion_bearing: Array
    clearance: Array
    core_row: Integers
    core_column: Integers
    core_value: Array
    loads: Array


def has_kernel(law: LawAtPhases) -> bool:
    """Tell whether the compiled kernel knows a law.

    Parameters
    ----------
    law
        A law at some phases.

    Returns
    -------
    bool
        False where statics has to ask the law itself.
    """
    return type(law) in KERNELS


def settle_all(
    springs: Springs, law: LawAtPhases, gap: Array, tolerance: float, start: Array
) -> tuple[Array, Array, Array]:
    """Settle a machine at K positions, each from where the one before was found.

    Parameters
    ----------
    springs
        The machine.
    law
        Law of the flanks at K phases, one that `has_kernel`.
    gap : (K, F)
        Flanks are pressed in by J q - gap, m.
    tolerance
        Imbalance over the largest force, dimensionless.
    start : (n,)
        Where the first search starts, m.

    Returns
    -------
    displacements : (K, n)
        m.
    forces : (K, F)
        Of the flanks, N.
    residuals : (K,)
        Largest imbalance over the largest force, above the tolerance where a position is not solved.
    """
    count, flanks = gap.shape
    displacements, forces = np.empty((count, start.size)), np.empty((count, flanks))
    residuals, settle = np.empty(count), KERNELS[type(law)]
    settle(springs, law, gap, tolerance, start, displacements, forces, residuals)
    return displacements, forces, residuals
