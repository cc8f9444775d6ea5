"""Unit loads by which a pair of teeth can touch: their gaps, arms and nodal forces on both bodies."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from facegear.contact.options import Refinement
from facegear.contact.surface import cell_areas, cell_points, hat_values, interpolation
from facegear.contact.teeth import ContactSide, pinion_points
from facegear.geometry.design import PairDesign
from facegear.geometry.pinion_surface import SurfacePoints

SMALLEST_COVER = 0.02
"""Part of a hat's area below which it is left out: the tooth opposite ends there."""


@dataclass(frozen=True, eq=False)
class PinionSurface:
    """The pinion's pressure hats and the exact points their integrals are taken at.

    For q points: `points`, `area` (q,) m2, `arm` (q,) m (speed along the normal per rotation), `nodal` (q, n)
    and `hats` (q, n) interpolation to lattice nodes, `coarse` (q, c) to nodes before refinement; `element`
    (q,) the flat index of the unrefined element (ne_u, ne_v) a point belongs to.
    """

    design: PairDesign
    side: ContactSide
    refinement: Refinement

    @property
    def shape(self) -> tuple[int, int]:
        """Refined lattice."""
        nu, nv = self.side.shape
        return (nu - 1) * self.refinement.profile + 1, (nv - 1) * self.refinement.width + 1

    @cached_property
    def lattice(self) -> NDArray[np.float64]:
        return cell_points(self.shape)

    @cached_property
    def points(self) -> SurfacePoints:
        return pinion_points(self.design, self.side, self.refinement, self.lattice)

    @cached_property
    def area(self) -> NDArray[np.float64]:
        nodes = np.stack(np.meshgrid(*map(np.arange, self.shape), indexing="ij"), axis=-1).reshape(-1, 2)
        surface = pinion_points(self.design, self.side, self.refinement, nodes.astype(float)).position
        return cell_areas(surface.reshape(*self.shape, 3))

    @cached_property
    def arm(self) -> NDArray[np.float64]:
        x, z = self.points.position[:, 0], self.points.position[:, 2]
        return x * self.points.normal[:, 2] - z * self.points.normal[:, 0]

    @cached_property
    def nodal(self) -> sp.csr_matrix:
        return interpolation(self.lattice, self.shape)

    @cached_property
    def hats(self) -> sp.csr_matrix:
        return hat_values(self.lattice, self.shape)

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
    def coarse(self) -> sp.csr_matrix:
        factors = np.array([self.refinement.profile, self.refinement.width])
        return interpolation(self.lattice / factors, self.side.shape)

    @cached_property
    def element(self) -> NDArray[np.int64]:
        factors = 2 * np.array([self.refinement.profile, self.refinement.width])
        row, column = np.floor(self.lattice / factors).astype(np.int64).T
        return row * ((self.side.shape[1] - 1) // 2) + column

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

    hats (m,) lattice nodes; gap (m,) m and arm (m,) m averaged over the hat; area (m,) m2, `whole` where no
    edge cuts it; loads on the lattice nodes `pinion` (m, n1) and `gear` (m, n2), and on the unrefined ones
    `pinion_coarse`, `gear_coarse`.
    """

    tooth: int
    hats: NDArray[np.int64]
    gap: NDArray[np.float64]
    arm: NDArray[np.float64]
    area: NDArray[np.float64]
    whole: NDArray[np.bool_]
    pinion: sp.csr_matrix
    gear: sp.csr_matrix
    pinion_coarse: sp.csr_matrix
    gear_coarse: sp.csr_matrix


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
    """Hats over those integration points (q,) of the pinion that face the gear.

    `gap` (q,) m and where the gear is hit, `coordinates` (q, 2) of its refined lattice; `gear_shape` is its
    lattice before refinement. Returns the hats that a turn by `limit` (rad) would close, or None.
    """
    if points.size == 0:
        return None
    weight = surface.hats[points].multiply(surface.area[points, None]).T.tocsr()
    area = np.asarray(weight.sum(axis=1)).ravel()
    hats = np.flatnonzero(area > SMALLEST_COVER * surface.full_area)
    weight = sp.diags_array(1.0 / area[hats]) @ weight[hats]
    found = spread_loads(
        tooth,
        weight.tocsr(),
        gap,
        surface.arm[points],
        (surface.nodal[points], surface.coarse[points]),
        gear_loads(coordinates, gear_shape, gear_refinement),
        limit,
    )
    if found is None:
        return None
    candidates, near = found
    hats, area = hats[near], area[hats][near]
    return replace(candidates, hats=hats, area=area, whole=_whole(surface, hats, area))


def gear_loads(
    coordinates: NDArray[np.float64], shape: tuple[int, int], refinement: Refinement
) -> tuple[sp.csr_matrix, sp.csr_matrix]:
    """Interpolation (q, n) from refined and from unrefined lattice nodes to refined coordinates (q, 2)."""
    factors = np.array([refinement.profile, refinement.width])
    fine = tuple((n - 1) * int(f) + 1 for n, f in zip(shape, factors, strict=True))
    return interpolation(coordinates, fine), interpolation(coordinates / factors, shape)


def spread_loads(
    tooth: int,
    weight: sp.csr_matrix,
    gap: NDArray[np.float64],
    arm: NDArray[np.float64],
    pinion: tuple[sp.csr_matrix, sp.csr_matrix],
    gear: tuple[sp.csr_matrix, sp.csr_matrix],
    limit: float,
) -> tuple[Candidates, NDArray[np.bool_]] | None:
    """Candidates of unit forces spread over points by `weight` (m, q), rows summing to one, and which rows
    they are.

    `gap`, `arm` (q,) and the interpolations `pinion`, `gear` (refined, unrefined) belong to the points. Rows
    that a turn by `limit` (rad) does not close are left out; None if that is all of them.
    """
    mean_gap, mean_arm = weight @ gap, weight @ arm
    near = mean_gap < limit * mean_arm
    if not near.any():
        return None
    rows = weight[near].tocsr()
    none = np.zeros(0)
    loads = [(rows @ part).tocsr() for part in (*pinion, *gear)]
    empty = Candidates(
        tooth, none, mean_gap[near], mean_arm[near], none, none, loads[0], loads[2], loads[1], loads[3]
    )
    return empty, near


def merged(parts: list[Candidates]) -> Candidates:
    """All candidates of one tooth pair as one."""
    if len(parts) == 1:
        return parts[0]
    flat = {
        name: np.concatenate([getattr(part, name) for part in parts])
        for name in ("hats", "gap", "arm", "area", "whole")
    }
    loads = {
        name: sp.vstack([getattr(part, name) for part in parts], format="csr")
        for name in ("pinion", "gear", "pinion_coarse", "gear_coarse")
    }
    return Candidates(tooth=parts[0].tooth, **flat, **loads)


def _whole(surface: PinionSurface, hats: NDArray[np.int64], area: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Hats that neither the gear's edges cut nor the pinion's, which are those of its lattice."""
    row, column = np.divmod(hats, surface.shape[1])
    inside = (row > 0) & (column > 0) & (column < surface.shape[1] - 1)
    return inside & (area > (1 - 1e-9) * surface.full_area[hats])
