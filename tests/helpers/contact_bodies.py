"""Bodies for the contact tests: mapped blocks of 27-node hexahedra, and the paper's pair."""

from dataclasses import replace
from math import radians

import numpy as np
import pytest
import scipy.sparse as sp
from skfem import MeshHex1, MeshHex2

from facegear.contact.bodies.elements import ElasticBody, elements_of
from facegear.contact.bodies.layer import tied_system
from facegear.contact.bodies.substructure import condense
from facegear.contact.bodies.surface import cell_areas, cell_points, hat_values, interpolation, pressure_basis
from facegear.contact.options import Refinement
from facegear.contact.position_solver import solve_contact
from facegear.teeth.design import FaceGearGeometry, Material, PairDesign, PinionGeometry, Shaper
from facegear.teeth.mesh_sizes import MeshSizes

STEEL = Material(206e9, 0.3)
FINE = MeshSizes(1.5e-3, 3.2e-3, 3e-3), Refinement(4, 2, 2, 2.0)
COARSE = MeshSizes(1.5e-3, 6e-3, 3e-3), Refinement(2, 1, 1)
"""Resolutions of the paper's pair: sizes of the mesh, cuts of the layer under the flank."""


def stations(ends):
    """Node positions of quadratic elements with the given ends."""
    ends = np.asarray(ends, dtype=float)
    full = np.empty(2 * len(ends) - 1)
    full[::2], full[1::2] = ends, 0.5 * (ends[1:] + ends[:-1])
    return full


def graded(first, total, ratio):
    """Element ends 0..total, sizes growing by about `ratio` from about `first`."""
    sizes = [first]
    while sum(sizes) < total:
        sizes.append(sizes[-1] * ratio)
    return np.concatenate([[0.0], np.cumsum(sizes)]) * total / sum(sizes)


def block(x, y, z, mapping=None, held=None, normal=(0.0, 1.0, 0.0)):
    """Block with element ends x, y, z; the contact surface is the face of largest y, profile along x, width
    z.
    """
    mesh = MeshHex2.from_mesh(MeshHex1.init_tensor(x, y, z))
    reference = mesh.doflocs.T
    top = np.flatnonzero(reference[:, 1] == reference[:, 1].max())
    shape = len(stations(x)), len(stations(z))
    flank = top[np.lexsort(np.round(reference[top][:, [2, 0]].T, 12))].reshape(shape)
    normals = np.broadcast_to(np.array(normal), (*flank.shape, 3)).copy()
    if mapping is not None:
        mesh = replace(mesh, doflocs=np.ascontiguousarray(mapping(reference).T))
    return ElasticBody(mesh, STEEL, flank, normals, held(reference))


def half_disc(radius, elements_x, elements_y):
    """Upper half of a disc in plane strain, one element thick (1 m), resting on its plane of symmetry."""

    def mapping(p):
        x, y, z = p.T
        return np.stack([radius * x * np.sqrt(1 - y**2 / 2), radius * y * np.sqrt(1 - x**2 / 2), z], axis=1)

    def held(p):
        fixed = np.zeros(p.shape, dtype=bool)
        fixed[:, 1] = p[:, 1] < 1e-12
        fixed[:, 0] = fixed[:, 1] & (np.abs(p[:, 0]) < 1e-12)
        fixed[:, 2] = True
        return fixed

    x = elements_x[elements_x > 0]
    return block(np.concatenate([-x[::-1], [0.0], x]), elements_y, [0.0, 1.0], mapping, held)


def quarter_space(size, total, loaded, ratio=2.0):
    """Quarter of a half space (x, z > 0 by symmetry), elements of `size` growing outwards to `total`.

    The first `loaded` x `loaded` elements of the surface can touch; the far faces are clamped.
    """
    ends = np.concatenate(
        [size * np.arange(loaded), size * loaded + graded(size, total - size * loaded, ratio)]
    )
    depth = -graded(size, total, ratio)[::-1]

    def held(p):
        far = (p[:, 1] < -total * 0.999999) | (p[:, 0] > total * 0.999999) | (p[:, 2] > total * 0.999999)
        return np.stack([far | (p[:, 0] < 1e-15), far, far | (p[:, 2] < 1e-15)], axis=1)

    body = block(ends, depth, ends, held=held)
    rows = slice(0, 2 * loaded + 1)
    return replace(body, flank=body.flank[rows, rows], normals=body.normals[rows, rows])


def stiffness(parts):
    """Matrix (n, n) that small ones add up to."""
    total = 0.0
    for part in parts:
        count, width = part.rows.shape
        at = np.repeat(part.rows, width, axis=1), np.tile(part.rows, (1, width))
        entries = part.matrices(np.arange(count)).ravel(), tuple(each.ravel() for each in at)
        small = sp.csr_matrix(entries, shape=(part.transformation.shape[0],) * 2)
        total = total + part.transformation.T @ small @ part.transformation
    return total.tocsr()


def stiffness_of(mesh, element="hex27"):
    """Stiffness of all elements of a mesh on its own nodes."""
    numbers, moved = np.arange(mesh.nelements), sp.eye(3 * mesh.doflocs.shape[1], format="csr")
    return stiffness([elements_of(mesh, numbers, numbers, moved, STEEL, element)])


def pressed(body, refinement, gap_of, force, reach=None):
    """Press a rigid surface, `gap_of` (n, 3) points, on a body; returns the contact, pressures and hat
    centres.
    """
    system = tied_system(body, refinement)
    compliance = condense(system).flank
    shape = system.surface.shape[:2]
    points, weight, area = hats_of(system.surface)
    matrix = weight @ interpolation(points, shape)
    surface = system.surface.reshape(-1, 3)
    gap = matrix @ gap_of(surface)
    near = np.flatnonzero(gap <= (np.inf if reach is None else reach))
    loads = matrix[near]
    influence = loads @ (loads @ compliance).T
    contact = solve_contact(influence, gap[near], np.ones(near.size), force)
    return contact, contact.force / area[near], surface[near]


def hats_of(surface):
    """Integration points of a lattice (nu, nv, 3), unit hats at them (n, q), and the hats' areas."""
    shape = surface.shape[:2]
    basis = pressure_basis(shape)
    points = cell_points(basis)
    weight = hat_values(basis).multiply(cell_areas(surface)[:, None]).T.tocsr()
    area = np.asarray(weight.sum(axis=1)).ravel()
    return points, sp.diags_array(1 / area) @ weight, area


def pair_design(
    shaper_teeth: int = 26,
    rack_tip_radius: float = 0.1,
    pinion_width: float = 0.030,
    radii: tuple[float, float] = (0.250, 0.275),
) -> PairDesign:
    m = 3.75e-3
    pinion = PinionGeometry(23, pinion_width, m, 1.25 * m, rack_tip_radius * m, 0.025)
    return PairDesign(
        m, radians(25), pinion, FaceGearGeometry(143, *radii, m, 0.012), Shaper(shaper_teeth, 1.25 * m)
    )


def sound(results):
    """Loaded positions that meet the conditions of contact, balance the torque and have whole load shares.

    Stiffness is positive; the average one may be unknown where fillets are in the way.
    """
    for result in results:
        assert result.residual < 1e-12
        assert result.load_share.sum() == pytest.approx(1.0, abs=1e-10)
        assert (result.load_share >= 0).all()
        assert result.k_average > 0 or (np.isnan(result.k_average) and result.overlap > 0)
        assert result.k_local > 0
        assert sum(spot.force.sum() for spot in result.spots) > 0
    return results
