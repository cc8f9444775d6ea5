"""Strain gauges on free surfaces against Lame's ring and Kirsch's plate with a hole, in plane strain."""

from dataclasses import replace

import numpy as np
import pytest
from contact_bodies import STEEL, stiffness_of
from references import against, agrees
from skfem import MeshHex1, MeshHex2

from facegear.contact.bodies.surface import gauges_on
from facegear.sparse.matrices import solve_sparse

INNER, OUTER = 1.0, 3.0


def quarter_annulus(across, around):
    """Quarter of a ring one element thick: mesh, and its nodes on the inner face by angle and along z."""
    radial = INNER * (OUTER / INNER) ** np.linspace(0.0, 1.0, across + 1)
    mesh = MeshHex2.from_mesh(MeshHex1.init_tensor(radial, np.linspace(0, np.pi / 2, around + 1), [0.0, 0.2]))
    radius, angle, z = mesh.doflocs
    inner = np.flatnonzero(radius == INNER)
    nodes = inner[np.lexsort(np.round(np.array([z, angle])[:, inner], 9))].reshape(2 * around + 1, 3)
    bent = np.stack([radius * np.cos(angle), radius * np.sin(angle), z])
    return replace(mesh, doflocs=bent), nodes


def displaced(mesh, given, force=None):
    """Displacements (3 n,) with those `given` (n, 3) where not nan, and nodal forces (n, 3)."""
    stiffness = stiffness_of(mesh)
    free = np.isnan(given).ravel()
    u = np.nan_to_num(given).ravel()
    load = np.zeros(u.size) if force is None else force.ravel()
    u[free] = solve_sparse(stiffness[free][:, free], (load - stiffness @ u)[free][:, None])[:, 0]
    return u


def stresses(across, around, outer_displacement):
    """Angles and hoop stress at the gauges of the hole, for displacements (n, 2) on the outer radius."""
    mesh, hole = quarter_annulus(across, around)
    points = mesh.doflocs.T
    count = len(points)
    given = np.full((count, 3), np.nan)
    given[:, 2] = 0.0
    given[points[:, 1] < 1e-12, 1] = 0.0
    given[points[:, 0] < 1e-12, 0] = 0.0
    outer = np.hypot(points[:, 0], points[:, 1]) > OUTER * (1 - 1e-9)
    given[outer, :2] = outer_displacement(points[outer])
    u = displaced(mesh, given)
    gauges = gauges_on(points, hole, STEEL)
    angle = np.arctan2(gauges.position[..., 1], gauges.position[..., 0])
    return angle[:, 0], (gauges.normal @ u).reshape(angle.shape)[:, 0]


def plane_strain(polar):
    """Displacements (n, 2) from radial and hoop ones as a function of radius and angle."""

    def displacement(points):
        radius, angle = np.hypot(points[:, 0], points[:, 1]), np.arctan2(points[:, 1], points[:, 0])
        radial, hoop = polar(radius, angle)
        c, s = np.cos(angle), np.sin(angle)
        return np.stack([radial * c - hoop * s, radial * s + hoop * c], axis=1)

    return displacement


def ring(radius, angle):
    """Ring pulled at its outer radius: hoop stress 2 at the free hole for a stress of 1 far away (Lame)."""
    shear, kappa = STEEL.young_modulus / 2 / (1 + STEEL.poisson_ratio), 3 - 4 * STEEL.poisson_ratio
    return (kappa - 1) * radius / 4 / shear + INNER**2 / radius / 2 / shear, np.zeros_like(angle)


def kirsch(radius, angle):
    """Plate with a hole under unit tension along x."""
    shear, kappa = STEEL.young_modulus / 2 / (1 + STEEL.poisson_ratio), 3 - 4 * STEEL.poisson_ratio
    r, a = radius / INNER, INNER / 8 / shear
    double = 2 * angle
    radial = a * (
        r * (kappa - 1 + 2 * np.cos(double)) + 2 / r * (1 + (1 + kappa - 1 / r**2) * np.cos(double))
    )
    hoop = a * (-2 * r * np.sin(double) + 2 / r * (1 - kappa - 1 / r**2) * np.sin(double))
    return radial, hoop


@against(
    "analytic",
    "stress around a hole in closed form",
    capability="root_stress",
    module="facegear.contact.root_gauges",
)
@pytest.mark.parametrize(
    ("field", "exact"),
    [(ring, lambda angle: 2.0 + 0.0 * angle), (kirsch, lambda angle: 1.0 - 2.0 * np.cos(2 * angle))],
    ids=["Lame ring", "plate with a hole"],
)
def test_stress_of_a_free_hole_converges_with_order_three_or_better(field, exact):
    errors = []
    for cuts in (2, 4, 8):
        angle, found = stresses(cuts, cuts, plane_strain(field))
        errors.append(np.abs(found - exact(angle)).max())
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    agrees("error of the stress at the hole, relative", errors[-1], 0.0, absolute=4e-3)
    assert orders.min() > 2.5, (errors, orders)


def strip(columns, rows, mapping):
    """Strip one element thick over the unit square, bent by `mapping`; its nodes on y = 1 and y = 0."""
    mesh = MeshHex2.from_mesh(MeshHex1.init_tensor(columns, rows, [0.0, 0.1]))
    x, y, z = mesh.doflocs
    sides = []
    for level in (1.0, 0.0):
        on = np.flatnonzero(y == level)
        sides.append(on[np.lexsort(np.round(np.array([z, x])[:, on], 9))].reshape(-1, 3))
    bent = np.stack([*mapping(x, y), z])
    return replace(mesh, doflocs=bent), *sides


@against(
    "analytic",
    "moment of a cantilever",
    capability="root_stress",
    module="facegear.contact.root_gauges",
)
def test_moment_of_the_gauges_over_a_section_is_the_one_applied():
    length, height, force = 5.0, 1.0, 2.0
    mesh, top, bottom = strip(
        np.linspace(0, 1, 21), np.linspace(0, 1, 5), lambda x, y: (length * x, height * (y - 0.5))
    )
    points = mesh.doflocs.T
    given = np.full(points.shape, np.nan)
    given[:, 2] = 0.0
    given[points[:, 0] < 1e-12] = 0.0
    end = np.flatnonzero(points[:, 0] > length * (1 - 1e-12))
    load = np.zeros(points.shape)
    load[end, 1] = force / end.size
    u = displaced(mesh, given, load)
    readings = []
    for side in (top, bottom):
        gauges = gauges_on(points, side, STEEL)
        readings.append((gauges.normal @ u).reshape(gauges.position.shape[:2]).mean(axis=1))
    at = gauges.position[:, 0, 0]
    middle = np.abs(at - length / 2) < 0.3 * length
    moment = 0.1 * height**2 / 6 * 0.5 * (readings[1] - readings[0])
    agrees("bending moment, N m", moment[middle], force * (length - at[middle]), relative=5e-3)


@against(
    "external source",
    "charts of stress concentration of a notched strip",
    capability="root_stress",
    module="facegear.contact.root_gauges",
)
def test_notched_strip_has_the_stress_concentration_of_the_charts():
    """Opposite half-round notches in tension, each a quarter of the width deep: Peterson, net section."""
    radius, half, length = 0.5, 1.0, 4.0
    arc = 10

    def mapping(s, y):
        angle = np.minimum(s / 0.5, 1.0) * np.pi / 2
        beyond = np.maximum(s - 0.5, 0.0) / 0.5
        top_x = radius * np.sin(angle) + (length - radius) * beyond**1.5
        top = half - radius * np.cos(angle)
        bottom_x = length * (np.where(s < 0.5, 0.3 * s / 0.5, 0.3 + 0.7 * beyond**1.5))
        graded = 1 - (1 - y) ** 1.5
        return bottom_x + (top_x - bottom_x) * graded, top * graded

    ends = np.concatenate([np.linspace(0, 0.5, arc + 1), np.linspace(0.5, 1, 9)[1:]])
    mesh, top, _ = strip(ends, np.linspace(0, 1, 9), mapping)
    points = mesh.doflocs.T
    given = np.full(points.shape, np.nan)
    given[:, 2] = 0.0
    given[points[:, 0] < 1e-9, 0] = 0.0
    given[points[:, 1] < 1e-9, 1] = 0.0
    far = points[:, 0] > length * (1 - 1e-9)
    given[far, 0] = 1e-6
    u = displaced(mesh, given)
    gauges = gauges_on(points, top, STEEL)
    largest = (gauges.normal @ u).max()
    force = (stiffness_of(mesh) @ u).reshape(-1, 3)[far, 0].sum()
    nominal = force / (0.1 * (half - radius))
    part = radius / half
    chart = 3.065 - 3.472 * part + 1.009 * part**2 + 0.405 * part**3
    agrees("stress concentration", largest / nominal, chart, relative=0.015)
