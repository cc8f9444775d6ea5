"""Both flanks of a pair as lattices of nodes on exact surfaces."""

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import NamedTuple

import numpy as np
import scipy.sparse as sp
from skfem import Basis

from facegear.arrays import Array, Integers
from facegear.contact.basis_functions import Lattice
from facegear.contact.bodies.surface import (
    cell_areas,
    cell_points,
    edge_hats,
    hat_values,
    interpolation,
    pressure_basis,
)
from facegear.contact.options import Refinement
from facegear.contact.teeth import ContactSide, pinion_points
from facegear.teeth import face_gear_fillet
from facegear.teeth.design import PairDesign
from facegear.teeth.modifications import tip_edge_as_made
from facegear.teeth.opposite import FilletCurve, GearHits, fillet_curve
from facegear.teeth.surfaces import SurfacePoints

OF_AN_EDGE = 0.5
"""Length that one of the two points between neighbouring nodes of an edge stands for, in their distance."""


class PinionPoints(NamedTuple):
    """Points (q,) of a pinion that may touch, with their share of the fields of `FacingPoints`.

    `position` and outward `normal` (q, 3) in the body frame, m; `at` (q, 2) refined lattice coordinates;
    `lever_arm` (q,) m; `hats` (q, 4) numbers of the basis functions there and `values` (q, 4) of them;
    `area` (q,) m2, for points of an edge OF_AN_EDGE node distances.
    """

    position: Array
    normal: Array
    at: Array
    lever_arm: Array
    hats: Integers
    values: Array
    area: Array


@dataclass(frozen=True, eq=False)
class PinionSurface:
    """The pinion's pressure basis functions (hats) and the exact points their integrals are taken at.

    For q Gauss points, four in each cell between refined nodes: `at` (q, 2) on the refined lattice,
    `points`, `area` (q,) m2, `lever_arm` (q,) m (speed along the normal per rotation), `hats` (q, n)
    their values, four a point; `cell` (q,) the flat index of the cell between refined nodes that a point
    lies in, `element` that of the unrefined element (ne_u, ne_v) of each cell.
    """

    design: PairDesign
    side: ContactSide
    lattice: Lattice

    @property
    def shape(self) -> tuple[int, int]:
        """Number of nodes along profile and face of the refined lattice."""
        return self.lattice.shape

    def exact(self, at: Array) -> SurfacePoints:
        """Compute exact points of the surface.

        Parameters
        ----------
        at : (n, 2) array
            Refined lattice coordinates, dimensionless.

        Returns
        -------
        SurfacePoints
            Points and normals (n, 3), m.
        """
        return pinion_points(self.design, self.side, self.lattice.refinement, at)

    @cached_property
    def nodes(self) -> Array:
        """Positions (n, 3) of the refined nodes, m."""
        at = np.stack(np.meshgrid(*map(np.arange, self.shape), indexing="ij"), axis=-1).reshape(-1, 2)
        return self.exact(at.astype(float)).position

    @cached_property
    def planes(self) -> Array:
        """Positions (nv,), m, along the pinion's axis of the lattice's columns of nodes, the planes
        across the axis.
        """
        return self.nodes.reshape(*self.shape, 3)[0, :, 1]

    @cached_property
    def pressure(self) -> Basis:
        """Bilinear pressure functions on the refined lattice with their Gauss points, see
        `pressure_basis`.
        """
        return pressure_basis(self.shape)

    @cached_property
    def at(self) -> Array:
        """Refined lattice coordinates (q, 2) of each integration point, in node distances across profile
        and along face.
        """
        return cell_points(self.pressure)

    @cached_property
    def points(self) -> SurfacePoints:
        """Exact surface points with normals at the integration points."""
        return self.exact(self.at)

    @cached_property
    def area(self) -> Array:
        """Area (q,) that each integration point stands for, m2."""
        return cell_areas(self.nodes.reshape(*self.shape, 3))

    @cached_property
    def lever_arm(self) -> Array:
        """Lever arm (q,) of each point's normal about the pinion's axis, m: normal displacement per
        rotation.
        """
        return self.points.lever_arm

    @cached_property
    def hats(self) -> sp.csr_matrix:
        """Values of the basis functions at the integration points, sparse (points, nodes)."""
        return hat_values(self.pressure)

    @cached_property
    def under(self) -> tuple[Integers, Array]:
        """Numbers (q, 4) of the hats that are not zero at each integration point, and their values (q, 4)
        there.
        """
        hats = self.hats
        return hats.indices.reshape(-1, 4).astype(np.int64), hats.data.reshape(-1, 4)

    @cached_property
    def full_area(self) -> Array:
        """Area (n,) under each hat, the integral of its values, where nothing is cut off, m2."""
        return self.hats.T @ self.area

    @property
    def width(self) -> float:
        """Width of the flank along the tooth, m."""
        return float(np.ptp(self.side.v[0]))

    @cached_property
    def element(self) -> Integers:
        """Number (cells,) of the unrefined finite element's face below each cell between refined nodes."""
        rows, columns = (np.arange(count - 1) for count in self.shape)
        row, column = (
            part // (2 * cut) for part, cut in zip((rows, columns), self.lattice.factors, strict=True)
        )
        return (row[:, None] * ((self.side.shape[1] - 1) // 2) + column).ravel()

    @cached_property
    def tip(self) -> tuple[Array, SurfacePoints]:
        """Lattice coordinates (q, 2) of the Gauss points along the tip edge, row 0 of the lattice, and
        the points, m.
        """
        along, _, _ = edge_hats(self.shape[1])
        coordinates = np.stack([np.zeros(along.size), along], axis=1)
        return coordinates, self.exact(coordinates)

    @cached_property
    def facing_points(self) -> PinionPoints:
        """The integration points of the flank and then those of the tip edge.

        The basis functions of the tip edge are numbered after those of the flank.
        """
        (under, values), (coordinates, tip), columns = self.under, self.tip, self.shape[1]
        _, edge_under, edge_values = edge_hats(columns)
        return PinionPoints(
            position=np.concatenate([self.points.position, tip.position]),
            normal=np.concatenate([self.points.normal, tip.normal]),
            at=np.concatenate([self.at, coordinates]),
            lever_arm=np.concatenate([self.lever_arm, tip.lever_arm]),
            hats=np.concatenate([under, np.tile(edge_under + self.shape[0] * columns, 2)]),
            values=np.concatenate([values, np.pad(edge_values, ((0, 0), (0, 2)))]),
            area=np.concatenate([self.area, np.full(len(edge_under), OF_AN_EDGE)]),
        )

    @cached_property
    def fillet_nodes(self) -> Array:
        """Angles gamma (rad) of the fillet's rows before refinement, from the flank's last on."""
        return np.concatenate([self.side.junction[:1], self.side.u[self.side.flank_rows :, 0]])

    @cached_property
    def fillet_curve(self) -> FilletCurve | None:
        """The part of the fillet's section that can touch, None where none can."""
        ends = self.fillet_nodes
        return fillet_curve(self.design, ends[0], ends[-1]) if ends.size > 1 else None

    @cached_property
    def probes(self) -> tuple[SurfacePoints, Integers]:
        """Exact points of the nodes before refinement, and the nine nodes (elements, 9) of each element's
        face.
        """
        nu, nv = self.side.shape
        nodes = np.arange(nu * nv).reshape(nu, nv)
        coarse = np.stack(np.meshgrid(np.arange(nu), np.arange(nv), indexing="ij"), axis=-1).reshape(-1, 2)
        points = self.exact(coarse * self.lattice.factors.astype(float))
        corners = [nodes[a : nu - 2 + a : 2, b : nv - 2 + b : 2].ravel() for a in range(3) for b in range(3)]
        return points, np.stack(corners, axis=-1)

    @property
    def between_probes(self) -> sp.csr_matrix:
        """Interpolation (n, probes) from the probes to the refined nodes: shared."""
        return _between_probes(self.lattice)

    @cached_property
    def cell(self) -> Integers:
        """Number (q,) of the cell between refined nodes that each integration point lies in, row by row."""
        row, column = np.floor(self.at).astype(np.int64).T
        return row * (self.shape[1] - 1) + column

    def coordinates(self, flank: Array, fillet: Array, y: Array) -> Array:
        """Compute lattice coordinates of feet of perpendiculars, see `EdgeFeet`.

        Parameters
        ----------
        flank : (n,) array
            Fraction of the flank's height, nan in the fillet.
        fillet : (n,) array
            Angle gamma in the fillet, rad.
        y : (n,) array
            Position along the pinion's axis, m.

        Returns
        -------
        (n, 2) array
            Refined lattice coordinates, dimensionless; nan beside the pinion's ends.
        """
        rows, columns = self.side.flank_rows, self.shape[1] - 1
        gammas = self.fillet_nodes
        beyond = rows - 1 + np.interp(fillet, gammas, np.arange(gammas.size))
        row = np.where(np.isnan(flank), beyond, flank * (rows - 1)) * self.lattice.refinement.profile
        column = (y - self.side.v[0, 0]) / self.width * columns
        return np.stack([row, np.where((column >= 0) & (column <= columns), column, np.nan)], axis=-1)


@lru_cache(maxsize=8)
def _between_probes(lattice: Lattice) -> sp.csr_matrix:
    """Return the interpolation (n, c) from the c nodes of a lattice before refinement to its n refined
    nodes.
    """
    nodes = np.argwhere(np.ones(lattice.shape)) / lattice.factors
    return interpolation(nodes, lattice.coarse)


@dataclass(frozen=True, eq=False)
class GearSurface:
    """The gear's contact surface, which maps hits of pinion normals to refined lattice coordinates."""

    design: PairDesign
    side: ContactSide
    lattice: Lattice

    @cached_property
    def tip(self) -> tuple[Array, Array]:
        """Lattice coordinates (q, 2) of the Gauss points of the left tip edge, and the points (q, 3) of
        tooth 0, m.
        """
        gear, columns = self.design.face_gear, self.lattice.shape[1]
        along, _, _ = edge_hats(columns)
        radius = gear.inner_radius + along / (columns - 1) * (gear.outer_radius - gear.inner_radius)
        points = tip_edge_as_made(self.design, radius) * np.array([-1.0, 1.0, 1.0])
        return np.stack([np.zeros(along.size), along], axis=1), points

    @cached_property
    def _fillet_nodes(self) -> Array:
        """Fractions (rows,) of the fillet at its rows of nodes, the same on all planes, 0 at the flank.

        They count the turn of the fillet's normal from the flank, 0, to the root, 1, see
        `fillet_fraction`.
        """
        first = self.side.v[-1, 0], self.side.u[self.side.flank_rows :, 0]
        return np.concatenate([[0.0], face_gear_fillet.fillet_fraction(self.design, *first)])

    def coordinates(self, hits: GearHits, fillet: bool, edge: float | Array) -> Array:
        """Compute lattice coordinates of hits, nan where nothing that can touch is hit.

        Parameters
        ----------
        hits : GearHits
            Where pinion normals (p, n) hit the gear.
        fillet : bool
            Whether the fillet counts, and the tip land within `edge` of the flank, which moves as the tip
            edge does.
        edge : float or array (n,)
            Width of the tip land that counts, m.

        Returns
        -------
        (p, n, 2) array
            Refined lattice coordinates (across the profile from the tip, along the radius from the inner
            end), dimensionless.
        """
        face, rows, fillet_shares = self.design.face_gear, self.side.flank_rows, self._fillet_nodes
        row = hits.flank * (rows - 1)
        if fillet and fillet_shares.size > 1:
            on = hits.fillet <= fillet_shares[-1]
            row = np.where(
                on, rows - 1 + np.interp(hits.fillet, fillet_shares, np.arange(fillet_shares.size)), row
            )
        if fillet:
            row = np.where(hits.beyond <= edge, 0.0, row)
        along = (hits.radius - face.inner_radius) / (face.outer_radius - face.inner_radius)
        column = along * (self.side.shape[1] - 1)
        return np.stack([row, column], axis=-1) * self.lattice.factors


@dataclass(frozen=True, eq=False)
class FlankPair:
    """The flanks of a pair that touch when the pinion drives."""

    pinion: PinionSurface
    gear: GearSurface

    @property
    def design(self) -> PairDesign:
        """Design of the pair of gears."""
        return self.pinion.design


def flank_pair(
    design: PairDesign,
    sides: tuple[ContactSide, ContactSide],
    cuts: tuple[Refinement, Refinement],
    linear: bool = False,
) -> FlankPair:
    """Build the contact surfaces of pinion and gear, each refined by its own cuts.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    sides : tuple[ContactSide, ContactSide]
        Contact surfaces of pinion and gear before refinement.
    cuts : tuple[Refinement, Refinement]
        Refinement of both.
    linear : bool
        Whether displacements are linear between nodes, not quadratic over elements.

    Returns
    -------
    FlankPair
        Surfaces of both gears.
    """
    first, second = (
        Lattice(side.shape, cut, linear, side.flank_rows) for side, cut in zip(sides, cuts, strict=True)
    )
    return FlankPair(PinionSurface(design, sides[0], first), GearSurface(design, sides[1], second))
