"""Unit loads by which a pair of teeth can touch: their gaps, arms and nodal forces on both bodies."""

from dataclasses import dataclass, fields
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from skfem import Basis

from facegear.contact.averages import Rows, hat_averages, rows_of, spread, stacked
from facegear.contact.bodies.surface import cell_areas, cell_points, edge_hats, hat_values, pressure_basis
from facegear.contact.options import Refinement
from facegear.contact.teeth import ContactSide, pinion_points
from facegear.geometry.design import PairDesign
from facegear.geometry.pinion_surface import SurfacePoints, fillet_points

FILLET_SAMPLES = 2000

SMALLEST_COVER = 0.02
"""Part of a hat's area below which it is left out: the tooth opposite ends there."""


@dataclass(frozen=True, eq=False)
class PinionSurface:
    """The pinion's pressure hats and the exact points their integrals are taken at.

    For q points: `points`, `area` (q,) m2, `arm` (q,) m (speed along the normal per rotation), `hats` (q, n)
    their values, four a point; `element` (q,) the flat index of the unrefined element (ne_u, ne_v) a point
    belongs to. `linear` says that both bodies are of elements linear between nodes.
    """

    design: PairDesign
    side: ContactSide
    refinement: Refinement
    linear: bool = False

    @property
    def shape(self) -> tuple[int, int]:
        """Refined lattice."""
        nu, nv = self.side.shape
        return (nu - 1) * self.refinement.profile + 1, (nv - 1) * self.refinement.width + 1

    @cached_property
    def pressure(self) -> Basis:
        return pressure_basis(self.shape)

    @cached_property
    def lattice(self) -> NDArray[np.float64]:
        return cell_points(self.pressure)

    @cached_property
    def points(self) -> SurfacePoints:
        return pinion_points(self.design, self.side, self.refinement, self.lattice)

    @cached_property
    def area(self) -> NDArray[np.float64]:
        nodes = np.stack(np.meshgrid(*map(np.arange, self.shape), indexing="ij"), axis=-1).reshape(-1, 2)
        surface = pinion_points(self.design, self.side, self.refinement, nodes.astype(float)).position
        return cell_areas(surface.reshape(*self.shape, 3), self.pressure)

    @cached_property
    def arm(self) -> NDArray[np.float64]:
        x, z = self.points.position[:, 0], self.points.position[:, 2]
        return x * self.points.normal[:, 2] - z * self.points.normal[:, 0]

    @cached_property
    def hats(self) -> sp.csr_matrix:
        return hat_values(self.pressure)

    @cached_property
    def full_area(self) -> NDArray[np.float64]:
        """Area (n,) of each hat where nothing is cut off."""
        return self.hats.T @ self.area

    @cached_property
    def row_height(self) -> float:
        """Mean distance (m) of node rows: the height that a pressure at an edge is averaged over."""
        width = float(np.ptp(self.side.v[0]))
        return float(self.area.sum()) / width / (self.shape[0] - 1)

    @cached_property
    def element(self) -> NDArray[np.int64]:
        factors = 2 * np.array([self.refinement.profile, self.refinement.width])
        row, column = np.floor(self.lattice / factors).astype(np.int64).T
        return row * ((self.side.shape[1] - 1) // 2) + column

    @cached_property
    def tip(self) -> tuple[NDArray[np.float64], SurfacePoints]:
        """Lattice coordinates (q, 2) of points along the tip edge, and the points."""
        along, _, _ = edge_hats(self.shape[1])
        coordinates = np.stack([np.zeros(along.size), along], axis=1)
        return coordinates, pinion_points(self.design, self.side, self.refinement, coordinates)

    @cached_property
    def fillet(self) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Points (n, 2) of the fillet's section (x, -z), outward normals (n, 2), unrefined rows (n,)."""
        rows = self.side.flank_rows
        ends = np.concatenate([self.side.junction[:1], self.side.u[rows:, 0]])
        gamma = np.linspace(ends[0], ends[-1], FILLET_SAMPLES)
        points = fillet_points(self.design, gamma, self.design.mean_radius)
        curve, normal = (part[:, [0, 2]] * np.array([1.0, -1.0]) for part in (points.position, points.normal))
        return curve, normal, rows - 1 + np.interp(gamma, ends, np.arange(ends.size))

    @cached_property
    def probes(self) -> tuple[SurfacePoints, NDArray[np.int64]]:
        """Points of the lattice before refinement, and the nodes (elements, 9) of its elements."""
        nu, nv = self.side.shape
        nodes = np.arange(nu * nv).reshape(nu, nv)
        coarse = np.stack(np.meshgrid(np.arange(nu), np.arange(nv), indexing="ij"), axis=-1).reshape(-1, 2)
        factors = np.array([self.refinement.profile, self.refinement.width])
        points = pinion_points(self.design, self.side, self.refinement, coarse * factors.astype(float))
        corners = [nodes[a : nu - 2 + a : 2, b : nv - 2 + b : 2].ravel() for a in range(3) for b in range(3)]
        return points, np.stack(corners, axis=-1)


@dataclass(frozen=True, eq=False)
class Candidates:
    """Loads of one tooth pair that may act: a unit force each, spread over a hat's covered area or along an
    edge.

    hats (m,) lattice nodes and their `column` along the width; gap (m,) m and arm (m,) m averaged over the
    hat; area (m,) m2, `whole` where no edge cuts it; loads on the lattice nodes `pinion` (m, n1) and `gear`
    (m, n2), and on the unrefined ones `pinion_coarse`, `gear_coarse`.
    """

    tooth: int
    hats: NDArray[np.int64]
    column: NDArray[np.int64]
    gap: NDArray[np.float64]
    arm: NDArray[np.float64]
    area: NDArray[np.float64]
    whole: NDArray[np.bool_]
    pinion: sp.csr_matrix
    gear: sp.csr_matrix
    pinion_coarse: sp.csr_matrix
    gear_coarse: sp.csr_matrix

    def only(self, keep: NDArray[np.bool_]) -> "Candidates":
        """Those marked (m,)."""
        if keep.all():
            return self
        parts = [getattr(self, field.name) for field in fields(self)[1:]]
        parts = [rows_of(part, keep) if sp.issparse(part) else part[keep] for part in parts]
        return Candidates(self.tooth, *parts)


@dataclass(frozen=True, eq=False)
class Loads:
    """Unit forces of one tooth pair, each spread over points of the pinion or of an edge by a row of `rows`.

    For m forces: `hats`, `area` and `whole` as in `Candidates`. For q points: `gap` (m), `arm` (m), and where
    they are on both refined lattices, `pinion` and `gear` (q, 2).
    """

    rows: Rows
    hats: NDArray[np.int64]
    area: NDArray[np.float64]
    whole: NDArray[np.bool_]
    gap: NDArray[np.float64]
    arm: NDArray[np.float64]
    pinion: NDArray[np.float64]
    gear: NDArray[np.float64]


def candidates_of(
    surface: PinionSurface,
    gear_shape: tuple[int, int],
    gear_refinement: Refinement,
    tooth: int,
    parts: list[Loads],
    limit: float,
) -> Candidates | None:
    """Those of the loads that a turn by `limit` (rad) would close, or None.

    `gear_shape` is the gear's lattice before refinement.
    """
    if not parts:
        return None
    rows = stacked([part.rows for part in parts], [part.gap.size for part in parts])
    hats, area, whole, gap, arm, pinion, gear = (
        np.concatenate([getattr(part, field.name) for part in parts]) for field in fields(Loads)[1:]
    )
    mean_gap, mean_arm = rows.mean(gap), rows.mean(arm)
    near = mean_gap < limit * mean_arm
    if not near.any():
        return None
    rows = rows.only(near)
    loads = []
    for place, shape, cuts in (
        (pinion, surface.side.shape, surface.refinement),
        (gear, gear_shape, gear_refinement),
    ):
        factors = np.array([cuts.profile, cuts.width])
        fine = (shape[0] - 1) * cuts.profile + 1, (shape[1] - 1) * cuts.width + 1
        loads.append(
            [spread(rows, at, n, surface.linear) for at, n in ((place, fine), (place / factors, shape))]
        )
    (on_pinion, pinion_coarse), (on_gear, gear_coarse) = loads
    return Candidates(
        tooth,
        hats[near],
        hats[near] % surface.shape[1],
        mean_gap[near],
        mean_arm[near],
        area[near],
        whole[near],
        on_pinion,
        on_gear,
        pinion_coarse,
        gear_coarse,
    )


def hat_loads(
    surface: PinionSurface,
    points: NDArray[np.int64],
    gap: NDArray[np.float64],
    coordinates: NDArray[np.float64],
) -> Loads:
    """Loads of the hats over those integration points (q,) of the pinion that face the gear.

    `gap` (q,) m and where the gear is hit, `coordinates` (q, 2) of its refined lattice.
    """
    under, values = surface.hats.indices.reshape(-1, 4), surface.hats.data.reshape(-1, 4)
    rows, hats, area = hat_averages(
        under[points], values[points], surface.area[points], SMALLEST_COVER * surface.full_area
    )
    whole = _whole(surface, hats, area)
    return Loads(rows, hats, area, whole, gap, surface.arm[points], surface.lattice[points], coordinates)


def hats_over(
    surface: PinionSurface,
    gear_shape: tuple[int, int],
    gear_refinement: Refinement,
    tooth: int,
    points: NDArray[np.int64],
    gap: NDArray[np.float64],
    coordinates: NDArray[np.float64],
    limit: float,
) -> Candidates | None:
    """The hats of `hat_loads` that a turn by `limit` (rad) would close, or None."""
    loads = [hat_loads(surface, points, gap, coordinates)] if points.size else []
    return candidates_of(surface, gear_shape, gear_refinement, tooth, loads, limit)


def _whole(surface: PinionSurface, hats: NDArray[np.int64], area: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Hats that neither the gear's edges cut nor the pinion's, which are those of its lattice."""
    row, column = np.divmod(hats, surface.shape[1])
    inside = (row > 0) & (column > 0) & (column < surface.shape[1] - 1)
    return inside & (area > (1 - 1e-9) * surface.full_area[hats])
