"""Strain gauges on free surfaces against Lame's ring and Kirsch's plate with a hole, in plane strain."""

from dataclasses import replace

import numpy as np
import pytest
from contact_bodies import STEEL
from skfem import MeshHex1, MeshHex2

from facegear.contact.bodies.assembly import Part, stiffness_matrix
from facegear.contact.bodies.factor import solve_sparse
from facegear.contact.bodies.gauges import gauges_on

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


def stresses(across, around, outer_displacement):
    """Angles and hoop stress at the gauges of the hole, for displacements (n, 2) on the outer radius."""
    mesh, hole = quarter_annulus(across, around)
    points = mesh.doflocs.T
    count = len(points)
    part = Part(mesh, np.arange(mesh.nelements), np.arange(count))
    stiffness = stiffness_matrix([part], count, STEEL).tocsr()
    given = np.full((count, 3), np.nan)
    given[:, 2] = 0.0
    given[points[:, 1] < 1e-12, 1] = 0.0
    given[points[:, 0] < 1e-12, 0] = 0.0
    outer = np.hypot(points[:, 0], points[:, 1]) > OUTER * (1 - 1e-9)
    given[outer, :2] = outer_displacement(points[outer])
    fixed = np.isfinite(given).ravel()
    u = np.where(fixed, np.nan_to_num(given).ravel(), 0.0)
    free = ~fixed
    u[free] = solve_sparse(stiffness[free][:, free], -(stiffness[free] @ u)[:, None])[:, 0]
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
    assert errors[-1] < 4e-3, errors
    assert orders.min() > 2.5, (errors, orders)
