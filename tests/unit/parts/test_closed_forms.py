"""Rings, discs and plates whose answers are known, and rigid motions that feel no rotation."""

import gear_bodies
import numpy as np
import pytest
import scipy.linalg
from references import against, agrees

from facegear.parts.body_mesh import body_mesh
from facegear.parts.matrices import around, body_matrices, rigid_motions
from facegear.parts.modes import held_solver, order_modes
from facegear.teeth.design import Material

UNIT = Material(1.0, 0.3)


@against("analytic", "free thin ring, inextensional", capability="gear_bodies", module="facegear.parts.modes")
def test_free_ring_bends_in_its_plane_with_the_coriolis_and_stress_factors_of_a_thin_one():
    ring = gear_bodies.rectangular(0.99, 1.01, 0.02, UNIT, held=False, across=2)
    for n in (2, 3, 4):
        modes = order_modes(ring, n, np.inf, expected_count=2)
        in_plane = (modes.shapes[2::3] ** 2).sum(axis=0) < 0.1 * (modes.shapes**2).sum(axis=0)
        mode = int(np.flatnonzero(in_plane)[0])
        agrees("gyroscopic factor", modes.gyroscopic_factors[mode], -2 * n / (n**2 + 1), absolute=4e-4)
        expected = n**2 * (n**2 - 3) / (n**2 + 1)
        agrees("stiffening factor", modes.stiffening_factors[mode], expected, relative=1e-3)


@against(
    "analytic",
    "Lamb and Southwell: rotating membrane",
    capability="gear_bodies",
    module="facegear.parts.matrices",
)
def test_disc_that_only_rotation_holds_vibrates_as_a_rotating_membrane():
    """Its modes are polynomials of the radius, r^n the slowest."""
    disc = gear_bodies.rectangular(0.01, 1.0, 0.02, UNIT, held=False, across=1)
    r = disc.elements.shape_points[0]
    for n, expected in ((1, 1.0), (2, 2.35), (3, 4.05)):
        axial = np.zeros((disc.elements.size, 3))
        axial[2::3] = r[:, None] ** (n + 2 * np.arange(3))
        stress, mass = axial.T @ (disc.stress.at(n) @ axial), around(n) * axial.T @ (disc.mass @ axial)
        first = scipy.linalg.eigh(stress, mass, eigvals_only=True)[0]
        agrees("squared frequency over that of rotation", first, expected, relative=2e-3)


PLATE = [6.660367, 6.552314, 7.956487, 13.275733, 22.073777]
RIM = [0.02211413, 0.04601575, 0.03258650, 0.01290077, 0.00529067]


@against(
    "analytic",
    "Kirchhoff plate held at 0.3 of its radius",
    capability="gear_bodies",
    module="facegear.parts.modes",
)
def test_thin_disc_held_at_its_bore_is_a_kirchhoff_plate():
    """The error of a plate of finite thickness is proportional to it: two thicknesses, extrapolated."""
    found = []
    for thickness in (0.02, 0.01):
        rigidity = Material(12 * (1 - 0.3**2) / thickness**3, 0.3)
        plate = gear_bodies.rectangular(0.3, 1.0, thickness, rigidity, held=True, across=1)
        rim, each = 3 * gear_bodies.at(plate, 1.0, 0.0) + 2, []
        load = np.zeros(plate.elements.size)
        load[rim] = 1.0
        for n in range(5):
            solve = held_solver(plate, n)
            frequency = order_modes(plate, n, np.inf, solve, expected_count=0).frequencies[0]
            each.append((2 * np.pi * frequency * np.sqrt(thickness), solve(load)[rim]))
        found.append(np.array(each).T)
    frequencies, compliances = 2 * found[1] - found[0]
    agrees("dimensionless frequency of 0 to 4 nodal diameters", frequencies, PLATE, relative=1.5e-3)
    agrees("rim's deflection by a force on it, orders 0 to 4", compliances, RIM, relative=2e-3)


@against(
    "analytic",
    "a rigid body that stands in space feels no rotation",
    capability="gear_bodies",
    module="facegear.parts.matrices",
)
@pytest.mark.parametrize("order", [0, 1])
def test_rigid_motions_of_a_free_body_strain_nothing_and_feel_no_rotation_where_they_stand_in_space(order):
    """Also with the stress of its own rotation: translation n M + g = 0, tilt half the polar inertia, and
    S - P - n^2 M - 2 n g = 0 for both.
    """
    section = gear_bodies.section(held=False)
    body = body_matrices(section, body_mesh(section, 1, 10.0))
    rigid = rigid_motions(body.elements, order)
    project = lambda matrix: rigid.T @ (matrix @ rigid)  # noqa: E731
    mass, coriolis, centrifugal = (
        around(order) * project(matrix) for matrix in (body.mass, body.coriolis, body.centrifugal)
    )
    stiff = np.abs(body.stiffness.at(order)).max() * np.abs(rigid).max() ** 2
    agrees("stiffness over the largest entry", project(body.stiffness.at(order)) / stiff, 0.0, absolute=1e-11)
    if order == 0:
        agrees("mass kg, polar inertia kg m2", np.diagonal(mass), [29.7516, 1.262375], relative=2e-6)
        return
    agrees("mass kg, diametral inertia kg m2", np.diagonal(mass), [29.7516, 0.643123], relative=2e-6)
    gyroscopic = mass + coriolis
    agrees("gyroscopic mass of a translation, kg", gyroscopic[0], 0.0, absolute=1e-11)
    agrees("gyroscopic inertia of a tilt, kg m2", gyroscopic[1, 1], 0.5 * 1.262375, relative=2e-6)
    left = project(body.stress.at(1)) - centrifugal - mass - 2 * coriolis
    agrees("stiffness from rotation in space, kg and kg m2", left, 0.0, absolute=1e-9)
