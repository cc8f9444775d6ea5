"""Two blocks pressed on each other: the pressure of a uniform state must come out uniform."""

import numpy as np
import pytest
from contact_bodies import STEEL, block, hats_of
from references import against, agrees

from facegear.contact.bodies.compliance import flank_compliance
from facegear.contact.bodies.layer import tied_system
from facegear.contact.bodies.surface import interpolation
from facegear.contact.options import Refinement
from facegear.contact.position_solver import solve_contact

PRESSURE = 2e8
HEIGHTS = (1.0, 0.7)


def resting(p):
    """Rollers below and on two sides, so that the block gives way uniformly."""
    return np.stack([p[:, 0] < 1e-12, p[:, 1] < 1e-12, p[:, 2] < 1e-12], axis=1)


def column(height, elements):
    """Block of 1 x 1 (m) and a height with so many elements along x and z."""
    ends = (np.linspace(0, 1, n + 1) for n in elements)
    x, z = ends
    return block(x, np.linspace(0, height, 3), z, held=resting)


def pressed_blocks(lower, upper, cuts):
    """Pressures (n,) at the lower block's hats over the exact one, and approach over the exact one."""
    first, second = column(HEIGHTS[0], lower), column(HEIGHTS[1], upper)
    bodies = [
        flank_compliance(body, refinement) for body, refinement in ((first, cuts), (second, Refinement()))
    ]
    surface = tied_system(first, cuts).surface
    shape = surface.shape[:2]
    points, weight, area = hats_of(surface)
    share = (points / (np.array(shape) - 1)) * (np.array(second.flank.shape) - 1)
    loads = [
        weight @ interpolation(where, grid) for where, grid in ((points, shape), (share, second.flank.shape))
    ]
    matrix = sum(load @ (load @ body.loaded_tooth).T for load, body in zip(loads, bodies, strict=True))
    contact = solve_contact(
        0.5 * (matrix + matrix.T), np.zeros(len(area)), np.ones(len(area)), PRESSURE * area.sum()
    )
    exact = PRESSURE * sum(HEIGHTS) / STEEL.young_modulus
    return contact.force / area / PRESSURE, contact.rotation / exact


@against(
    "manufactured",
    "patch test of contact: uniform pressure",
    capability="contact",
    module="facegear.contact.position_solver",
)
@pytest.mark.parametrize("cuts", [Refinement(), Refinement(2, 3, 2, 2.0)])
def test_matching_blocks_pass_a_uniform_pressure_to_rounding(cuts):
    pressure, approach = pressed_blocks((2, 3), (2 * cuts.profile, 3 * cuts.width), cuts)
    agrees("pressure over the applied one", pressure, 1.0, relative=1e-7, absolute=1e-9)
    agrees("approach over the exact one", approach, 1.0, relative=1e-11)


@against(
    "manufactured",
    "patch test of contact: uniform pressure",
    capability="contact",
    module="facegear.contact.position_solver",
)
def test_blocks_that_do_not_match_pass_a_uniform_pressure_ever_better():
    worst = []
    for cuts in (Refinement(), Refinement(2, 2), Refinement(4, 4)):
        pressure, approach = pressed_blocks((3, 2), (4, 3), cuts)
        worst.append(np.abs(pressure - 1).max())
        agrees("approach over the exact one", approach, 1.0, relative=1e-3)
    assert max(worst) < 0.03
    assert worst[2] < 0.4 * worst[0]
