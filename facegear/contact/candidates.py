"""Loads of a pair of teeth that may act: points that can touch, gaps, lever arms and influence.

Points at which a pair of teeth can touch, under the basis functions of a flank or along a tip edge. Off the
line of action an edge meets the opposite flank at an angle: the gap is least exactly on the edge and grows by
micrometres within a node distance, so that averages over the surface beside it come too late. Edges therefore
carry loads of their own: basis functions along the edge with gaps taken on it.
"""

from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np
import scipy.sparse as sp

from facegear.arrays import AnyArray, Array, Integers, Mask
from facegear.contact.basis_functions import (
    Cover,
    FacingPairs,
    FacingPoints,
    Lattice,
    Rows,
    chosen_rows,
    functions_within,
)
from facegear.contact.bodies.compliance import FlankCompliance
from facegear.contact.flanks import OF_AN_EDGE, PinionPoints, PinionSurface


@dataclass(frozen=True, eq=False)
class Candidates:
    """Loads of one tooth pair that may act: unit forces, each spread over a basis function's covered area or
    along an edge.

    hats (m,): lattice nodes of the basis functions; gap (m,) m and lever_arm (m,) m: averages over each
    basis function; `fillet` (m,): whether it presses on a fillet of either gear; `averages`: weights of
    the points under each basis function, which lie at refined coordinates `at` (q, 2) on the `lattices` of
    pinion and gear.
    """

    tooth: int
    hats: Integers
    gap: Array
    lever_arm: Array
    fillet: Mask
    averages: Rows
    at: tuple[Array, Array]
    lattices: tuple[Lattice, Lattice]
    _load_cache: dict[tuple[int, bool], sp.csr_matrix] = field(default_factory=dict, init=False)

    def loads(self, side: int, is_refined: bool) -> sp.csr_matrix:
        """Return the nodal forces of all loads on one gear's lattice.

        Parameters
        ----------
        side : int
            0 for the pinion, 1 for the gear.
        is_refined : bool
            Whether the nodes are those after refinement.

        Returns
        -------
        (m, nodes) sparse matrix
            Dimensionless: forces on nodes of unit loads.
        """
        if (side, is_refined) not in self._load_cache:
            self._load_cache[side, is_refined] = self.lattices[side].loads(
                self.averages, self.at[side], is_refined
            )
        return self._load_cache[side, is_refined]

    def only(self, keep: Mask) -> "Candidates":
        """Return the candidates that a mask marks.

        Parameters
        ----------
        keep : (m,) array of bool
            Marks the loads to return.

        Returns
        -------
        Candidates
            Marked loads.
        """
        if keep.all():
            return self
        return replace(
            self,
            hats=self.hats[keep],
            gap=self.gap[keep],
            lever_arm=self.lever_arm[keep],
            fillet=self.fillet[keep],
            averages=chosen_rows(self.averages, keep),
        )


def candidates_of(
    pinion: Lattice,
    gear: Lattice,
    tooth: int,
    points: FacingPoints,
    min_area: Array,
    limit: float,
    first: int = 0,
) -> list[Candidates]:
    """Return the loads of basis functions whose gap a rotation would close.

    Parameters
    ----------
    pinion : Lattice
        Lattice of the pinion.
    gear : Lattice
        Lattice of the gear.
    tooth : int
        Number of the pair.
    points : FacingPoints
        Points of the pair.
    min_area : (functions,) array
        Covered area below which a basis function is left out, m2.
    limit : float
        Rotation, rad.
    first : int
        Number of the first basis function of the pinion's nodes; all others are those of edges.

    Returns
    -------
    list[Candidates]
        One entry, or none if no gap is closed.
    """
    starts, teeth = np.array([0, points.gap.size]), np.array([tooth])
    cover = Cover(min_area, first, pinion.shape, (pinion.flank_end, gear.flank_end))
    functions = functions_within(FacingPairs(points, starts, teeth), cover, limit)
    if functions.node.size == 0:
        return []
    return [
        Candidates(
            tooth=tooth,
            hats=functions.node,
            gap=functions.gap,
            lever_arm=functions.lever_arm,
            fillet=functions.fillet,
            averages=functions.average,
            at=(points.pinion, points.gear),
            lattices=(pinion, gear),
        )
    ]


SMALLEST_COVER = 0.02
"""Fraction of a basis function's area below which it is left out: the opposite tooth ends there."""


def flank_points(
    surface: PinionSurface, points: Integers, gap: Array, lever_arm: Array, gear: Array, first: int = 0
) -> FacingPoints:
    """Return integration points of the pinion with the basis functions over them.

    Parameters
    ----------
    surface : PinionSurface
        Contact surface of the pinion.
    points : (q,) array of int
        Numbers of the points.
    gap : (q,) array
        m.
    lever_arm : (q,) array
        m.
    gear : (q, 2) array
        Refined lattice coordinates on the gear, dimensionless.
    first : int
        Number of the first basis function of the pinion.

    Returns
    -------
    FacingPoints
        Points (q,), in SI units.
    """
    under, values = surface.under
    return FacingPoints(
        gap, lever_arm, surface.at[points], gear, under[points] + first, values[points], surface.area[points]
    )


class EdgePoints(NamedTuple):
    """Points (e,) of the gear's tip edge in p placements.

    gap, lever_arm (p, e) m; refined lattice coordinates `pinion` (p, e, 2) and `gear` (e, 2); `hats` and
    `values` (e, 2) as returned by `edge_hats`.
    """

    gap: Array
    lever_arm: Array
    pinion: Array
    gear: Array
    hats: Integers
    values: Array


def gather_points(
    points: PinionPoints, first: int, hits: tuple[Integers, Integers, Array, Array], edge: EdgePoints
) -> tuple[FacingPoints, Integers]:
    """Join the points of p pairs of teeth: for each pair those of the gear's tip edge, then those of the
    pinion.

    Parameters
    ----------
    points : PinionPoints
        Points of the pinion.
    first : int
        Number of the first basis function of the pinion.
    hits : tuple of arrays
        Numbers (q,) of points of the pinion, ends of each pair's points (p + 1,) with 0 first, gaps (q,)
        in m, and refined lattice coordinates (q, 2) on the gear.
    edge : EdgePoints
        Points of the gear's tip edge.

    Returns
    -------
    tuple[FacingPoints, Integers]
        Points of all pairs, and the start of each pair's points (p + 1,).
    """
    number, ends, gap, gear = hits
    pairs, beside = edge.gap.shape

    starts = ends + beside * np.arange(pairs + 1)
    bounds = list(zip(starts.tolist(), ends.tolist(), ends[1:].tolist(), strict=False))

    def join_points(on_edge: AnyArray, on_pinion: AnyArray, numbers: Integers | None = None) -> AnyArray:
        """Return values of the edge's points (p, e, ...) and the pinion's (q, ...) as one array, pair by
        pair.

        Each pair has its edge points first. With `numbers` (q,) the row numbers[i] of `on_pinion` belongs
        to point i of the pairs; without, row i does.
        """
        values = np.empty((starts[-1], *on_pinion.shape[1:]), on_pinion.dtype)
        for (start, begin, end), edge_values in zip(bounds, on_edge, strict=True):
            values[start : start + beside] = edge_values
            rows = values[start + beside : start + beside + end - begin]
            if numbers is None:
                rows[:] = on_pinion[begin:end]
            else:
                np.take(on_pinion, numbers[begin:end], axis=0, out=rows, mode="clip")
        return values

    def at_each_pair(values: AnyArray, columns: int) -> AnyArray:
        """Return values (e, c) of the edge's points as (p, e, columns), the same for each pair, 0 in
        columns beyond c.
        """
        padded_values = np.pad(values, ((0, 0), (0, columns - values.shape[1])))
        return np.broadcast_to(padded_values, (pairs, *padded_values.shape))

    gathered_points = FacingPoints(
        gap=join_points(edge.gap, gap),
        lever_arm=join_points(edge.lever_arm, points.lever_arm, number),
        pinion=join_points(edge.pinion, points.at, number),
        gear=join_points(at_each_pair(edge.gear, 2), gear),
        functions=join_points(at_each_pair(edge.hats, 4), points.hats + first, number),
        values=join_points(at_each_pair(edge.values, 4), points.values, number),
        area=join_points(np.full((pairs, beside), OF_AN_EDGE), points.area, number),
    )
    return gathered_points, starts


def flank_cover(surface: PinionSurface) -> Array:
    """Return the area that the opposite teeth must cover of each basis function of the flank.

    Parameters
    ----------
    surface : PinionSurface
        Contact surface of the pinion.

    Returns
    -------
    (n,) array
        m2.
    """
    return SMALLEST_COVER * surface.full_area


def edge_cover(columns: int) -> Array:
    """Return the smallest covered length of each edge basis function: SMALLEST_COVER of its integral,
    half at the ends.

    Parameters
    ----------
    columns : int
        Number of nodes along the edge.

    Returns
    -------
    (columns,) array
        Length as a fraction of the node spacing.
    """
    cover = np.full(columns, SMALLEST_COVER)
    cover[[0, -1]] *= 0.5
    return cover


def influence_matrix(
    pairs: list[Candidates],
    pinion: FlankCompliance,
    gear: FlankCompliance,
    is_coupled: bool = True,
) -> Array:
    """Compute the influence matrix of the loads of all pairs: approach at load i by a unit force of load
    j.

    Both gears' normal displacements add up. Loads of one pair use the compliance of the loaded tooth on
    refined nodes, loads of two pairs that of neighbours on nodes before refinement.

    Parameters
    ----------
    pairs : list[Candidates]
        Candidates of each pair.
    pinion : FlankCompliance
        Compliance of the pinion.
    gear : FlankCompliance
        Compliance of the gear.
    is_coupled : bool
        False leaves out the coupling between neighbouring teeth, for comparison.

    Returns
    -------
    (m, m) array
        Symmetric, m/N; loads pair by pair in the order of `pairs`.
    """
    ends = np.cumsum([0] + [len(pair.hats) for pair in pairs])
    matrix = np.zeros((ends[-1], ends[-1]))
    for i, first in enumerate(pairs):
        for j, second in enumerate(pairs[: i + 1]):
            block = np.zeros((len(first.hats), len(second.hats)))
            for side, body in enumerate((pinion, gear)):
                is_same_pair = i == j
                compliance = body.loaded_tooth if is_same_pair else body.block(first.tooth - second.tooth)
                if compliance is not None and (is_same_pair or is_coupled):
                    block += body.scale * product(
                        first.loads(side, is_same_pair), compliance, second.loads(side, is_same_pair)
                    )
            matrix[ends[i] : ends[i + 1], ends[j] : ends[j + 1]] = block
            matrix[ends[j] : ends[j + 1], ends[i] : ends[i + 1]] = block.T
    return matrix


def product(first: sp.csr_matrix, compliance: Array | None, second: sp.csr_matrix) -> Array:
    """Compute the displacements first @ compliance @ second.T, m/N.

    Only those columns of the compliance are read that `second` has entries for.

    Parameters
    ----------
    first : (m, nodes) sparse matrix
        Weights of nodes whose displacement is taken.
    compliance : (nodes, nodes) array, optional
        m/N; None gives 0.
    second : (n, nodes) sparse matrix
        Unit loads on nodes.

    Returns
    -------
    (m, n) array
        Displacements by unit loads, m/N.
    """
    if compliance is None:
        return np.zeros((first.shape[0], second.shape[0]))
    columns = np.unique(second.indices)
    return np.asarray((second[:, columns] @ (first @ compliance[:, columns]).T).T)
