"""Modes of a turning body with the static rest, against its whole matrices at one frequency."""

import gear_bodies
import numpy as np
import pytest
import scipy.sparse.linalg
from references import against, agrees

from facegear.parts.gear_body import modal_compliance
from facegear.parts.matrices import around
from facegear.parts.modes import held_solver, order_modes

LAG = 1e-11
"""Damping that is left out, over the frequency: next to nothing."""
AS_LIGHT = np.sqrt(7850.0)
"""Factor by which every motion is faster than in steel: the disc has 1 kg/m3."""
TURNING, W = 150.0 * AS_LIGHT, 2 * np.pi * 2900.0 * AS_LIGHT


@pytest.fixture(scope="module")
def disc():
    return gear_bodies.rectangular(0.1, 0.27, 0.02, gear_bodies.STEEL, True, 2)


def of_matrices(disc, order):
    """Means (3, 3) by unit loads that stand in space, from K - W^2 M with all terms of a turning body."""
    free = disc.free
    stiffness, stress = (matrix.at(order)[free][:, free] for matrix in (disc.stiffness, disc.stress))
    mass, coriolis, centrifugal = (
        (around(order) * matrix)[free][:, free] for matrix in (disc.mass, disc.coriolis, disc.centrifugal)
    )
    carried = stress - centrifugal - order**2 * mass - 2 * order * coriolis
    whole = (1 + 1j * W * LAG - 1j * order * TURNING * LAG) * stiffness - W**2 * mass + TURNING**2 * carried
    whole = whole + 2 * W * TURNING * (order * mass + coriolis)
    loads = disc.on_teeth[:, free]
    return loads @ scipy.sparse.linalg.spsolve(whole.tocsc(), loads.T.astype(complex))


def of_modes(disc, order, up_to):
    """Dynamic stiffness from modes up to a frequency and their static remainder."""
    solve = held_solver(disc, order)
    modes = order_modes(disc, order, up_to, solve)
    squared = np.diag((2 * np.pi * modes.frequencies) ** 2)
    one = np.eye(len(squared))
    carried = modes.stress - modes.centrifugal - order**2 * one - 2 * order * modes.coriolis
    whole = (1 + 1j * W * LAG - 1j * order * TURNING * LAG) * squared - W**2 * one + TURNING**2 * carried
    whole = whole + 2 * W * TURNING * (order * one + modes.coriolis)
    means = disc.on_teeth
    left_out = means @ solve(means.T) - modal_compliance(modes)
    return modes.teeth @ np.linalg.solve(whole, modes.teeth.T) + left_out


@against(
    "analytic",
    "dynamic stiffness of all degrees of freedom, without modes",
    capability="gear_bodies",
    module="facegear.parts.modes",
)
@pytest.mark.parametrize("order", [1, 4])
def test_modes_and_the_static_rest_answer_a_load_in_space_as_the_whole_turning_body(disc, order):
    """The inertia left out falls at least with the square of the frequency up to which modes go."""
    exact = of_matrices(disc, order)
    size = np.abs(exact[:2, :2]).max()
    off = [
        np.abs(of_modes(disc, order, up_to * AS_LIGHT) - exact)[:2, :2].max() / size
        for up_to in (8e3, 16e3, 64e3)
    ]
    agrees("compliance over the largest, modes to 64 kHz", off[2], 0.0, absolute=2e-6)
    assert off[1] < off[0] / 3.5 and off[2] < off[1] / 3.5
    static = disc.on_teeth @ held_solver(disc, order)(disc.on_teeth.T)
    assert np.abs(static - exact)[:2, :2].max() > 0.1 * size
