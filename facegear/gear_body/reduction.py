"""Reduce a solved body to its modes."""

import numpy as np
import scipy.linalg

from facegear.arrays import Array
from facegear.gear_body.body import SolvedBody
from facegear.gear_body.patch import Patch
from facegear.gear_body.reduced_body import ReducedBody
from facegear.gear_body.section import section_properties


def reduced_body(
    body: SolvedBody, patch: Patch, damping_ratio: float, stiffness_damping: float = 0.0
) -> ReducedBody:
    """Return the modes of a body and its static compliance below a mesh.

    Parameters
    ----------
    body : SolvedBody
        The solved body.
    patch : Patch
        Area on which a mesh presses.
    damping_ratio : float
        Damping ratio of every mode.
    stiffness_damping : float
        beta of D = beta K, s.

    Returns
    -------
    ReducedBody
        SI units.
    """
    orders = body.orders
    order = np.concatenate([np.full(modes.frequencies.size, modes.order) for modes in orders])
    zero = orders[0]
    mass, _, _, moment = section_properties(body.section)
    return ReducedBody(
        order=order,
        frequency=np.concatenate([modes.frequencies for modes in orders]),
        coriolis=_blocks([modes.coriolis for modes in orders]),
        stiffening=_blocks([modes.stress - modes.centrifugal for modes in orders]),
        mesh=np.concatenate([patch.rows(modes.order, modes.teeth) for modes in orders], axis=1),
        hub=np.concatenate([modes.hub for modes in orders], axis=1),
        hub_spin=np.concatenate([modes.hub_spin for modes in orders]),
        round=np.concatenate([np.round(zero.torsional), np.zeros(order.size - zero.frequencies.size)]),
        static=body.static(patch),
        damping_ratio=np.array(damping_ratio),
        pitch_height=np.array(patch.height),
        slope=np.concatenate([patch.factor(modes.order) * modes.slope for modes in orders]),
        leaning=body.leaning(patch),
        mass=np.array(mass),
        moment=np.array(moment),
        stiffness_damping=np.array(stiffness_damping),
    )


def _blocks(matrices: list[Array]) -> Array:
    """Matrices along the diagonal; those without entries take no room."""
    size = sum(len(matrix) for matrix in matrices)
    return np.asarray(scipy.linalg.block_diag(*(m for m in matrices if m.size), np.zeros((0, 0)))).reshape(
        size, size
    )
