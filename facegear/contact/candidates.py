"""Where a pair of teeth can touch at a position: gaps, arms and loads of the pressure hats there."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from facegear.contact.options import Refinement
from facegear.contact.surface import cell_areas, cell_points, hat_values, interpolation
from facegear.contact.teeth import ContactSide, GearLattice, pinion_points
from facegear.geometry.design import PairDesign
from facegear.geometry.pinion_surface import SurfacePoints
from facegear.geometry.separation import separation

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
    """Pressure hats of one tooth pair that may touch: a unit force each, spread over the hat's covered area.

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


def find_candidates(
    surface: PinionSurface,
    lattice: GearLattice,
    phi1: float,
    phi2: float,
    teeth: NDArray[np.int64],
    limit: float,
    fillet: bool,
) -> list[Candidates]:
    """Hats of the pairs `teeth` that a turn of the pinion by `limit` (rad) would bring into the gear.

    phi1, phi2 (rad) place the unloaded gears. Pairs without such hats are left out.
    """
    probes, elements = surface.probes
    seen = separation(surface.design, probes, phi1, phi2, teeth)
    depth = limit * surface.design.pinion_base_radius
    reach = 3.0 * depth + 20e-6
    found = []
    for tooth, gap in zip(teeth, seen.gap, strict=True):
        near = (gap[elements] < depth + 10e-6).any(axis=1) & (np.abs(gap[elements]) < 1e-3).any(axis=1)
        points = np.flatnonzero(near[surface.element])
        if points.size:
            pair = _pair_candidates(surface, lattice, (phi1, phi2, int(tooth)), points, limit, reach, fillet)
            if pair is not None:
                found.append(pair)
    return found


def _pair_candidates(
    surface: PinionSurface,
    lattice: GearLattice,
    place: tuple[float, float, int],
    points: NDArray[np.int64],
    limit: float,
    reach: float,
    fillet: bool,
) -> Candidates | None:
    where = SurfacePoints(surface.points.position[points], surface.points.normal[points])
    seen = separation(surface.design, where, *place[:2], place[2], reach=max(reach, 1e-4))
    edge = 0.1 * surface.design.module
    coordinates = lattice.coordinates(seen, fillet, edge)[0]
    usable = np.isfinite(coordinates).all(axis=1) & np.isfinite(seen.gap[0])
    if not fillet:
        usable &= surface.lattice[points, 0] <= (surface.side.flank_rows - 1) * surface.refinement.profile
    return hats_over(
        surface,
        lattice.side.shape,
        lattice.refinement,
        place[2],
        points[usable],
        seen.gap[0][usable],
        coordinates[usable],
        limit,
    )


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
    mean_gap, arm = weight @ gap, weight @ surface.arm[points]
    near = mean_gap < limit * arm
    if not near.any():
        return None
    weight = weight[near].tocsr()
    factors = np.array([gear_refinement.profile, gear_refinement.width])
    fine = tuple((n - 1) * int(f) + 1 for n, f in zip(gear_shape, factors, strict=True))
    return Candidates(
        tooth,
        hats[near],
        mean_gap[near],
        arm[near],
        area[hats][near],
        _whole(surface, hats[near], area[hats][near]),
        (weight @ surface.nodal[points]).tocsr(),
        (weight @ interpolation(coordinates, fine)).tocsr(),
        (weight @ surface.coarse[points]).tocsr(),
        (weight @ interpolation(coordinates / factors, gear_shape)).tocsr(),
    )


def _whole(surface: PinionSurface, hats: NDArray[np.int64], area: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Hats that neither the gear's edges cut nor the pinion's, which are those of its lattice."""
    row, column = np.divmod(hats, surface.shape[1])
    inside = (row > 0) & (column > 0) & (column < surface.shape[1] - 1)
    return inside & (area > (1 - 1e-9) * surface.full_area[hats])
