"""Natural frequencies of a gear body with all its real teeth, from one sector of the whole gear in space.

The tooth stands on the rim's upper part; the section below it is turned round the axis through one pitch,
with the same nodes on the plane between. Elements are scikit-fem's bricks of 27 nodes. In a wave of n nodal
diameters the cut that follows moves as the cut before, turned by a pitch and later by the phase n times the
pitch. There is no layer, and no wave inside the elements.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from time import process_time

import numpy as np
import pandas as pd
import scipy.sparse as sp
from scipy.sparse.linalg import LinearOperator, eigsh, splu
from skfem import Basis, BilinearForm, ElementHex2, ElementVector, asm
from skfem.helpers import dot
from skfem.models.elasticity import lame_parameters, linear_elasticity

from facegear.arrays import Array, Integers
from facegear.parts.body_mesh import BodyMesh, body_mesh
from facegear.parts.matrices import body_matrices
from facegear.parts.modes import order_modes
from facegear.parts.section import Layer, Section
from facegear.parts.tooth_layer import SIZES, fitted_teeth
from facegear.parts.wheel import Hub, Rim, Web, web_ends, wheel
from facegear.teeth.design import FaceGearGeometry, Material, PairDesign, PinionGeometry, Shaper
from facegear.teeth.mesh_quality import hex_mesh
from facegear.teeth.mesh_sizes import MeshSizes
from facegear.teeth.section_outline import tooth_fill
from facegear.teeth.tooth_mesh import gear_tooth

STEEL, DENSITY = Material(206e9, 0.3), 7850.0
LAST_ORDER = 6
FINENESSES = (1.0, 1.5)
"""Fineness of the meshes: ratio of the fit's element size to theirs."""


@dataclass(frozen=True)
class Gear:
    """A pair whose face gear stands on hub and web; the tooth mesh ends at height 0."""

    name: str
    pair: PairDesign
    hub: Hub
    web: Web
    rim_back: float

    @property
    def rim(self) -> Rim:
        """Rim from the back to the root land."""
        gear = self.pair.face_gear
        return Rim(gear.inner_radius, gear.outer_radius, self.rim_back, gear.rim_thickness)

    def section(self, layer: Layer | None = None) -> Section:
        """Return the section for Fourier elements, bore held.

        Parameters
        ----------
        layer : Layer or None
            Layer of the teeth, None without teeth.

        Returns
        -------
        Section
            The section.
        """
        corners = wheel(self.hub, self.web, self.rim)
        inside = np.isclose(corners[:, 0], self.hub.bore_radius)
        is_fixed = tuple((inside & np.roll(inside, -1)).tolist())
        return Section(
            corners, is_fixed, (self.rim.inner_radius, self.rim.outer_radius), STEEL, DENSITY, layer
        )

    def layer(self, density: float) -> Layer:
        """Return the layer of the teeth with the fractions of every gear.

        Parameters
        ----------
        density : float
            Density of the layer over that of steel, fraction.

        Returns
        -------
        Layer
            The layer.
        """
        rim, top = (
            self.rim,
            self.pair.face_gear.addendum + self.pair.shaper.addendum + self.pair.face_gear.rim_thickness,
        )
        return Layer(rim.inner_radius, rim.outer_radius, rim.front, top, density)


def paper() -> Gear:
    """Return the paper's teeth on the section of docs/explanation/bodies.md.

    Returns
    -------
    Gear
        The gear.
    """
    module = 3.75e-3
    pair = PairDesign(
        module=module,
        pressure_angle=np.radians(25.0),
        pinion=PinionGeometry(23, 25e-3, module, 1.25 * module, 0.1 * module, 20e-3),
        face_gear=FaceGearGeometry(143, 0.250, 0.275, module, 12e-3),
        shaper=Shaper(26, 1.25 * module),
    )
    return Gear("paper", pair, Hub(0.12, 0.14, -0.05, 0.0), Web(0.018, 0.012, -0.006, 25 / 110), -0.012)


def second() -> Gear:
    """Return a gear with fewer and larger teeth of 20 degrees, on a thinner rim and a flat web.

    Returns
    -------
    Gear
        The gear.
    """
    module = 5e-3
    pair = PairDesign(
        module=module,
        pressure_angle=np.radians(20.0),
        pinion=PinionGeometry(25, 20e-3, module, 1.25 * module, 0.1 * module, 20e-3),
        face_gear=FaceGearGeometry(61, 0.149, 0.170, module, 4e-3),
        shaper=Shaper(26, 1.25 * module),
    )
    return Gear("second", pair, Hub(0.05, 0.062, -0.016, 0.0), Web(0.008, 0.008, -0.005, 0.0), -0.010)


@dataclass(frozen=True, eq=False)
class CyclicSector:
    """Nodes (n, 3) in m and bricks (e, 27) of one pitch (rad).

    `left` and `right`: nodes of its two cuts in pairs; `fixed_nodes`: the nodes that are held.
    """

    nodes: Array
    bricks: Integers
    left: Integers
    right: Integers
    fixed_nodes: Integers
    pitch: float


def flat_section(gear: Gear, size: float, across: int, top: float) -> tuple[Array, Integers]:
    """Mesh the section up to a height with quadrilaterals of nine nodes.

    Parameters
    ----------
    gear : Gear
        The gear.
    size : float
        Size of the elements, m.
    across : int
        Number of elements along the rim's radius.
    top : float
        Height, m.

    Returns
    -------
    (n, 2) array, (q, 9) array of int
        Nodes, m, and indices of the nodes of each quadrilateral.
    """
    hub, rim = gear.hub, gear.rim
    (hub_low, hub_high), (rim_low, rim_high) = web_ends(hub, gear.web, rim)
    rows = max(2, round((hub_high - hub_low) / size))
    hub_across = max(2, round((hub.outer_radius - hub.bore_radius) / size))
    web_across = max(4, round((rim.inner_radius - hub.outer_radius) / size))
    web = [(hub.outer_radius, hub_low), (rim.inner_radius, rim_low)]
    web += [(rim.inner_radius, rim_high), (hub.outer_radius, hub_high)]
    parts = [_lattice(np.array(web), web_across, rows)]
    for inner, outer, columns, lines, joint in (
        (hub.bore_radius, hub.outer_radius, hub_across, (hub.back, hub_low, hub_high, hub.front), hub_low),
        (rim.inner_radius, rim.outer_radius, across, (rim.back, rim_low, rim_high, 0.0, top), rim_low),
    ):
        heights = np.unique(np.round(lines, 12)).tolist()
        for low, high in pairwise(heights):
            count = rows if abs(low - joint) < 1e-9 else max(1, round((high - low) / size))
            corners = np.array([(inner, low), (outer, low), (outer, high), (inner, high)])
            parts.append(_lattice(corners, columns, count))
    starts = np.cumsum([0, *(len(nodes) for nodes, _ in parts)])
    nodes, quads = _merge_nodes(
        np.concatenate([nodes for nodes, _ in parts]),
        np.concatenate([quads + start for (_, quads), start in zip(parts, starts, strict=False)]),
    )
    return nodes, quads


def _lattice(corners: Array, columns: int, rows: int) -> tuple[Array, Integers]:
    """Cut a block between four corners into columns and rows of quadrilaterals of nine nodes."""
    s, t = (grid[..., None] for grid in np.meshgrid(*(np.linspace(0, 1, 2 * n + 1) for n in (columns, rows))))
    lower, upper = corners[0] + s * (corners[1] - corners[0]), corners[3] + s * (corners[2] - corners[3])
    nodes = (lower + t * (upper - lower)).reshape(-1, 2)
    row = 2 * columns + 1
    first = (2 * row * np.arange(rows)[:, None] + 2 * np.arange(columns)).ravel()
    offsets = (row * np.arange(3)[:, None] + np.arange(3)).ravel()
    return nodes, first[:, None] + offsets


def _merge_nodes(nodes: Array, elements: Integers) -> tuple[Array, Integers]:
    """Merge nodes that stand at one point to 1 nm."""
    _, first_index, number = np.unique(np.round(1e9 * nodes), axis=0, return_index=True, return_inverse=True)
    return nodes[first_index], number.ravel()[elements]


def cyclic_sector(gear: Gear, sizes: MeshSizes, size: float) -> CyclicSector:
    """Mesh one tooth on its part of the body.

    Parameters
    ----------
    gear : Gear
        The gear.
    sizes : MeshSizes
        Sizes of the tooth's elements.
    size : float
        Size of the body's elements, m.

    Returns
    -------
    CyclicSector
        The sector.
    """
    tooth = gear_tooth(gear.pair, sizes)
    back = np.unique(tooth.faces["rim_back"])
    drop = tooth.nodes[back, 2].mean()
    nodes = tooth.nodes - [0.0, 0.0, drop]
    r, angle = np.hypot(nodes[:, 0], nodes[:, 1]), np.arctan2(nodes[:, 0], nodes[:, 1])
    radii = np.unique(np.round(r[back], 9))
    stations = np.stack([np.sort(angle[back[np.abs(r[back] - radius) < 1e-8]]) for radius in radii])
    flat, quads = flat_section(gear, size, (len(radii) - 1) // 2, 0.0)
    below, bricks = revolve(flat, quads, radii, stations)
    whole, elements = _merge_nodes(
        np.concatenate([nodes, below]), np.concatenate([tooth.hexes, bricks + len(nodes)])
    )
    return _cut(whole, elements, gear.pair.face_gear.teeth, gear.hub.bore_radius)


def bare_sector(gear: Gear, columns: int, size: float) -> CyclicSector:
    """Mesh one pitch of the body without its tooth.

    Parameters
    ----------
    gear : Gear
        The gear.
    columns : int
        Number of elements round the pitch.
    size : float
        Size of the elements, m.

    Returns
    -------
    CyclicSector
        The sector.
    """
    rim, teeth = gear.rim, gear.pair.face_gear.teeth
    across = max(2, round((rim.outer_radius - rim.inner_radius) / size))
    flat, quads = flat_section(gear, size, across, rim.front)
    stations = np.linspace(-np.pi, np.pi, 2 * columns + 1) / teeth
    nodes, bricks = revolve(flat, quads, np.array([1.0]), stations[None])
    return _cut(nodes, bricks, teeth, gear.hub.bore_radius)


def revolve(flat: Array, quads: Integers, radii: Array, stations: Array) -> tuple[Array, Integers]:
    """Revolve a section into bricks of 27 nodes.

    Parameters
    ----------
    flat : (n, 2) array
        Nodes of the section, m.
    quads : (q, 9) array of int
        Indices of the nodes of each quadrilateral.
    radii : (radii,) array
        Radii at which the angles are given, m; the nearest counts.
    stations : (radii, 2 k + 1) array
        Angles of the nodes, rad.

    Returns
    -------
    (m, 3) array, (e, 27) array of int
        Nodes, m, and indices of the nodes of each brick.
    """
    angle = stations[np.abs(flat[:, :1] - radii).argmin(axis=1)]
    r, height = flat[:, :1], np.broadcast_to(flat[:, 1:], angle.shape)
    nodes = np.stack([r * np.sin(angle), r * np.cos(angle), height], axis=-1)
    count = angle.shape[1]
    # Angles grow from y towards x, so that (angle, r, height) is a right-handed system.
    step = 2 * np.arange((count - 1) // 2)
    local = np.arange(3)[None, :] + count * quads[:, :, None].reshape(len(quads), 9, 1)
    bricks = (local[:, None] + step[None, :, None, None]).reshape(-1, 27)
    return nodes.reshape(-1, 3), bricks


def _cut(nodes: Array, bricks: Integers, teeth: int, bore: float) -> CyclicSector:
    r, angle = np.hypot(nodes[:, 0], nodes[:, 1]), np.arctan2(nodes[:, 0], nodes[:, 1])
    half = np.pi / teeth
    cuts = [np.flatnonzero(np.abs(angle - side) < 1e-7) for side in (-half, half)]
    left, right = (cut[np.lexsort(np.round(1e8 * np.stack([nodes[cut, 2], r[cut]])))] for cut in cuts)
    assert left.size == right.size
    assert np.allclose(r[left], r[right], atol=1e-8) and np.allclose(
        nodes[left, 2], nodes[right, 2], atol=1e-8
    )
    return CyclicSector(nodes, bricks, left, right, np.flatnonzero(r < bore + 1e-8), 2 * half)


def frequencies(sector: CyclicSector, orders: Sequence[int], count: int = 1) -> Array:
    """Compute the first frequencies of the whole gear in each order.

    Parameters
    ----------
    sector : CyclicSector
        One pitch of the gear.
    orders : Sequence[int]
        Numbers of nodal diameters.
    count : int
        Number of frequencies in each order.

    Returns
    -------
    (orders, count) array
        Frequencies, Hz.
    """
    mesh, number = hex_mesh(sector.nodes, sector.bricks)
    basis = Basis(mesh, ElementVector(ElementHex2()), intorder=5)
    stiffness = asm(linear_elasticity(*lame_parameters(STEEL.young_modulus, STEEL.poisson_ratio)), basis)
    mass = asm(BilinearForm(lambda u, v, w: DENSITY * dot(u, v)), basis)
    return np.stack([_order(sector, number, stiffness, mass, order, count) for order in orders])


def _order(
    sector: CyclicSector,
    number: Integers,
    stiffness: sp.csr_matrix,
    mass: sp.csr_matrix,
    order: int,
    count: int,
) -> Array:
    size = len(number)
    free = np.setdiff1d(np.arange(size), np.concatenate([sector.right, sector.fixed_nodes]))
    column = np.full(size, -1)
    column[free] = np.arange(free.size)
    moving_nodes = np.flatnonzero(column[sector.left] >= 0)
    selection = sp.csr_matrix((np.ones(free.size), (number[free], np.arange(free.size))), (size, free.size))
    cut = sp.csr_matrix(
        (np.ones(moving_nodes.size), (number[sector.right[moving_nodes]], column[sector.left[moving_nodes]])),
        (size, free.size),
    )
    c, s = np.cos(sector.pitch), np.sin(sector.pitch)
    turn = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])  # angles grow from y towards x
    constraint = sp.kron(selection, np.eye(3)) + np.exp(-1j * order * sector.pitch) * sp.kron(cut, turn)
    constraint = constraint.tocsr()
    left, right = ((constraint.conj().T @ matrix @ constraint).tocsc() for matrix in (stiffness, mass))
    factor = splu(left, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    inverse = LinearOperator(left.shape, matvec=factor.solve, dtype=complex)
    start = np.ones(left.shape[0], complex)
    squared = eigsh(left, count, right, sigma=0.0, OPinv=inverse, v0=start, return_eigenvectors=False)
    return np.sqrt(np.sort(squared)) / (2.0 * np.pi)


def fourier(gear: Gear, layer: Layer | None, mesh: BodyMesh) -> Array:
    """Compute the first frequency of every order by the Fourier elements of facegear.

    Parameters
    ----------
    gear : Gear
        The gear.
    layer : Layer or None
        Layer of the teeth, None without teeth.
    mesh : BodyMesh
        Mesh of the section.

    Returns
    -------
    (orders,) array
        Frequencies, Hz.
    """
    body = body_matrices(gear.section(layer), mesh)
    orders = range(LAST_ORDER + 1)
    return np.array([order_modes(body, order, np.inf, expected_count=1).frequencies[0] for order in orders])


def peer_table(gears: Sequence[Gear], finenesses: Sequence[float]) -> pd.DataFrame:
    """Compare sector and Fourier elements, with and without teeth.

    Parameters
    ----------
    gears : Sequence[Gear]
        Gears to compare.
    finenesses : Sequence[float]
        Fineness of each mesh of the sector, ratio.

    Returns
    -------
    DataFrame
        One row for each gear, mesh and nodal diameter.
    """
    return pd.concat([_compare(gear, fine) for gear in gears for fine in finenesses], ignore_index=True)


def _compare(gear: Gear, fine: float) -> pd.DataFrame:
    module, orders = gear.pair.module, range(LAST_ORDER + 1)
    size = 0.5 * (gear.web.rim_thickness - 1e-3) / fine
    sizes = MeshSizes(*(part * module / fine for part in SIZES))
    start = process_time()
    toothed = frequencies(cyclic_sector(gear, sizes, size), orders)[:, 0]
    bare = frequencies(bare_sector(gear, 2, size), orders)[:, 0]
    cpu = process_time() - start
    common = gear.layer(Layer.density)
    fill_density, centre = tooth_fill(gear.pair)
    layer = replace(common, density=fill_density, taper=6.0 * (0.5 - centre))
    fitted_layer = fitted_teeth(gear.section(layer), gear.pair).layer
    assert fitted_layer is not None
    mesh = body_mesh(gear.section(common))
    return pd.DataFrame(
        {
            "gear": gear.name,
            "fineness": fine,
            "nodal_diameters": orders,
            "sector_hz": toothed,
            "sector_without_teeth_hz": bare,
            "fitted_hz": fourier(gear, fitted_layer, mesh),
            "common_hz": fourier(gear, common, mesh),
            "without_teeth_hz": fourier(gear, None, body_mesh(gear.section())),
            "density": fitted_layer.density,
            "taper": fitted_layer.taper,
            "hoop": fitted_layer.hoop,
            "shear": fitted_layer.shear,
            "sector_cpu_seconds": cpu,
        }
    )
