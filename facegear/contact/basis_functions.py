"""Points of the pinion that face the gear, the basis functions of the pressure over them, and surface nodes.

The lattice of a surface's nodes gives the nodal forces of unit forces that are spread over its points.
"""

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import NamedTuple

import numpy as np
import scipy.sparse as sp

from facegear._kernels import contact as kernels
from facegear.arrays import Array, Integers, Mask
from facegear.contact.bodies.surface import LINEAR_STEPS, QUADRATIC_STEPS, interpolation
from facegear.contact.options import Refinement

Rows = tuple[Integers, Integers, Array]
"""Sparse rows: pointer, index, weight. Row i takes `index` by `weight` from pointer[i] to pointer[i + 1]."""


class FacingPoints(NamedTuple):
    """Points (q,) of one tooth that may face a tooth of the other gear, with the basis functions there.

    Attributes
    ----------
    gap, lever_arm : (q,)
        m; the gap is not finite where nothing is opposite.
    pinion, gear : (q, 2)
        Refined lattice coordinates on both teeth, nan or inf where nothing is opposite.
    functions : (q, 4)
        Numbers of the basis functions that are not zero at a point.
    values : (q, 4)
        Their values there.
    area : (q,)
        Area (m2) that a point stands for; of an edge its length in distances of the edge's nodes.
    """

    gap: Array
    lever_arm: Array
    pinion: Array
    gear: Array
    functions: Integers
    values: Array
    area: Array

    def part(self, rows: slice) -> "FacingPoints":
        """Return the points in a range of rows.

        Parameters
        ----------
        rows : slice
            Rows of the points.

        Returns
        -------
        FacingPoints
            Points of these rows.
        """
        gap, lever_arm, pinion, gear, functions, values, area = self
        return FacingPoints(
            gap[rows], lever_arm[rows], pinion[rows], gear[rows], functions[rows], values[rows], area[rows]
        )


class FacingPairs:
    """Facing points of the pairs of teeth at a position, pair by pair.

    Parameters
    ----------
    points : FacingPoints
        Points (q,) of all pairs.
    starts : Integers
        First point of each pair and the number of all points (p + 1,).
    teeth : Integers
        Number (p,) of each pair.
    """

    def __init__(self, points: FacingPoints, starts: Integers, teeth: Integers) -> None:
        """Keep points (q,) of all pairs, the first point of each pair with q last (p + 1,), and pair
        numbers (p,).
        """
        self.points, self.starts, self.teeth = points, starts, teeth

    @cached_property
    def kernel(self) -> kernels.FacingPoints:
        """The points as an object of the compiled kernels, made once."""
        points, contiguous = self.points, np.ascontiguousarray
        return kernels.FacingPoints(
            contiguous(points.gap),
            contiguous(points.lever_arm),
            contiguous(points.pinion),
            contiguous(points.gear),
            contiguous(points.functions),
            contiguous(points.values),
            contiguous(points.area),
            self.starts,
            contiguous(self.teeth, np.int64),
        )


class Cover:
    """All basis functions of a pair of teeth: of the gear's tip edge, the pinion's lattice and its tip edge.

    Parameters
    ----------
    min_area : Array
        Area (n,) m2 of each function that a tooth opposite must cover.
    first : int
        Number of the function of the lattice's first node.
    shape : tuple of int
        Rows and columns of the pinion's refined lattice.
    flank_ends : tuple of float
        Refined rows of pinion and gear beyond which their fillets begin.
    """

    def __init__(
        self, min_area: Array, first: int, shape: tuple[int, int], flank_ends: tuple[float, float]
    ) -> None:
        """Keep the smallest covered area of each basis function and their numbering; arguments as in the
        class.
        """
        self.min_area, self.first, self.shape, self.flank_ends = min_area, first, shape, flank_ends

    @cached_property
    def kernel(self) -> kernels.Cover:
        """The basis functions as an object of the compiled kernels, made once."""
        return kernels.Cover(np.ascontiguousarray(self.min_area), self.first, self.shape, self.flank_ends)


class BasisFunctions(NamedTuple):
    """Basis functions (m,) of the pairs of teeth of a position that may touch, pair by pair.

    Attributes
    ----------
    pair : (m,)
        Row of the function's pair in `FacingPairs.teeth`.
    node : (m,)
        Node of the pinion's lattice, of a function along an edge the nearest.
    gap, lever_arm : (m,)
        Means over the function, m.
    fillet : (m,)
        Whether most of the function lies on a fillet of either gear.
    average
        Weights of the points in a mean over each function.
    """

    pair: Integers
    node: Integers
    gap: Array
    lever_arm: Array
    fillet: Mask
    average: Rows


def functions_within(facing_pairs: FacingPairs, cover: Cover, limit: float) -> BasisFunctions:
    """Find the basis functions whose gap a rotation of the pinion would close, by means over their
    points.

    Gap and lever arm are means weighted by function value and area. Functions of which less than
    `min_area` is opposite a tooth are left out.

    Parameters
    ----------
    facing_pairs : FacingPairs
        Points of a position that may touch.
    cover : Cover
        All basis functions of a pair.
    limit : float
        Rotation, rad.

    Returns
    -------
    BasisFunctions
        Functions with gap < limit * lever arm.
    """
    return BasisFunctions(**kernels.find_functions(facing_pairs.kernel, cover.kernel, limit))


def chosen_rows(rows: Rows, keep: Mask) -> Rows:
    """Return some rows of a sparse matrix stored by rows.

    Parameters
    ----------
    rows : Rows
        All rows (m,).
    keep : Mask
        Whether a row is kept (m,).

    Returns
    -------
    Rows
        The kept rows (k,), whose weights have the unit of those given.
    """
    pointer, index, weight = rows
    counts = np.diff(pointer)
    entries = np.repeat(keep, counts)
    return np.concatenate([[0], np.cumsum(counts[keep])]), index[entries], weight[entries]


ROUNDING = 1e-6
"""Rounding errors of coordinates on a lattice are smaller, in distances of its nodes."""


@dataclass(frozen=True)
class Lattice:
    """Nodes of a contact surface: their numbers before refinement both ways, and how they are refined.

    `linear` where the body is of elements linear between nodes; `flank_rows`: how many of the rows before
    refinement belong to the flank, None for all; the others lie in the fillet.
    """

    coarse: tuple[int, int]
    refinement: Refinement
    linear: bool = False
    flank_rows: int | None = None

    @property
    def shape(self) -> tuple[int, int]:
        """Numbers of nodes across the profile and along the width, refined."""
        nu, nv = self.coarse
        return (nu - 1) * self.refinement.profile + 1, (nv - 1) * self.refinement.width + 1

    @property
    def factors(self) -> Integers:
        """Number of refined cells in a coarse one, along profile and face."""
        return np.array([self.refinement.profile, self.refinement.width])

    @property
    def flank_end(self) -> float:
        """Refined row number beyond which points lie in the fillet: the flank's last row plus ROUNDING."""
        rows = self.coarse[0] if self.flank_rows is None else self.flank_rows
        return (rows - 1) * self.refinement.profile + ROUNDING

    @property
    def steps(self) -> Integers:
        """Rows and columns (a, 2) from the corner of an element's face to its nodes."""
        return LINEAR_STEPS if self.linear else QUADRATIC_STEPS

    def in_fillet(self, at: Array) -> Mask:
        """Return which points lie beyond the flank.

        Parameters
        ----------
        at : Array
            Refined lattice coordinates (q, 2), dimensionless.

        Returns
        -------
        Mask
            Whether a point lies in the fillet (q,).
        """
        return np.asarray(at[:, 0] > self.flank_end)

    def interpolation_rows(self) -> Rows:
        """Return the interpolation of displacements from the c nodes before refinement to the n refined
        ones.

        Returns
        -------
        Rows
            Weights (n, c), dimensionless, of the displacements before refinement; shared by all callers.
        """
        return _interpolation_rows(self)

    def loads(self, rows: Rows, at: Array, is_refined: bool = True) -> sp.csr_matrix:
        """Distribute unit forces to nodes by the displacement's shape functions (consistent nodal loads).

        Parameters
        ----------
        rows : Rows
            By which parts (m, q) each unit force acts at points, dimensionless.
        at : Array
            Refined lattice coordinates (q, 2) of the points, dimensionless.
        is_refined : bool
            Whether the nodes are the refined ones, not those before refinement.

        Returns
        -------
        csr_matrix
            Force (m, n) on each node by each unit force, N/N.
        """
        pointer, index, weight = rows
        points, column = np.unique(index, return_inverse=True)
        spread = sp.csr_matrix((weight, column, pointer), shape=(pointer.size - 1, points.size))
        if is_refined:
            return spread @ interpolation(at[points], self.shape, self.linear)
        return spread @ interpolation(at[points] / self.factors, self.coarse, self.linear)


@lru_cache(maxsize=8)
def _interpolation_rows(lattice: Lattice) -> Rows:
    """Return the interpolation from nodes before refinement to refined nodes as (pointer, index, weight).

    Row i gives refined node i; the arrays are cached and only read.
    """
    nodes = np.argwhere(np.ones(lattice.shape)) / lattice.factors
    matrix = interpolation(nodes, lattice.coarse, lattice.linear)
    matrix.eliminate_zeros()
    return matrix.indptr.astype(np.int64), matrix.indices.astype(np.int64), matrix.data
