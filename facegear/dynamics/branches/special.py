"""Special points of a branch: their kinds and the evidence for each.

Folds and doublings: Seydel 2010; grazing: di Bernardo et al. 2008.
"""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from facegear.arrays import ComplexArray
from facegear.dynamics.branches.points import BranchPoint


class Kind(StrEnum):
    """Kinds of special points."""

    FOLD = "fold"
    DOUBLING = "period doubling"
    TORUS = "Neimark-Sacker"
    BRANCH = "branch point"
    GRAZE = "graze"
    NEUTRAL = "neutral body"


@dataclass(frozen=True, eq=False)
class Special:
    """A special point of a branch.

    Attributes
    ----------
    kind : Kind
        Its kind.
    point : BranchPoint
        The motion at it.
    multiplier : complex
        The critical multiplier (NaN at a graze).
    proof : str
        Evidence that it is a special point.
    after : float
        Position along the branch: index of the point before plus the fraction of the way to the next.
    meshes : tuple of int
        Meshes that graze.
    edge : int
        Edge that they graze: 1 upper, -1 lower.
    """

    kind: Kind
    point: BranchPoint
    multiplier: complex
    proof: str
    after: float
    meshes: tuple[int, ...] = ()
    edge: int = 0


def evidence(
    kind: Kind, off: float, before: BranchPoint, point: BranchPoint, after: BranchPoint
) -> tuple[complex, str]:
    """Return the critical multiplier of a point between two neighbours, and the evidence for its kind.

    Parameters
    ----------
    kind : Kind
        Kind of the point.
    off : float
        Distance of a graze's extremum from the edge over the length scale, dimensionless.
    before, point, after : BranchPoint
        The point and its neighbours.

    Returns
    -------
    complex
        Floquet multiplier, dimensionless.
    str
        Evidence.
    """
    if kind is Kind.GRAZE:
        return complex(np.nan), f"an extreme lies {abs(off):.1e} length scales from the edge"
    if kind is Kind.FOLD:
        mu = _nearest(point.multipliers, 1.0)
        return mu, (
            f"the speed component of the tangent goes from {before.tangent[-1]:+.1e} to "
            f"{after.tangent[-1]:+.1e}; multiplier {mu.real:.9f}"
        )
    if kind is Kind.DOUBLING:
        mu = _nearest(point.multipliers, -1.0)
        return mu, f"a real multiplier is {mu.real:.9f}, goes through -1"
    if kind is Kind.BRANCH:
        mu = _nearest(point.multipliers, 1.0)
        parity_change = "changes" if before.parity != after.parity else "keeps"
        return (
            mu,
            f"multiplier {mu.real:.9f} at a tangent with {point.tangent[-1]:+.1e}; parity {parity_change}",
        )
    pair = point.pairs[np.argmin(np.abs(np.abs(point.pairs) - 1.0))] if point.pairs.size else complex(np.nan)
    return complex(pair), f"modulus {abs(pair):.9f}, angle {np.degrees(np.angle(pair)):.6f} deg"


def _nearest(values: ComplexArray, goal: float) -> complex:
    return complex(values[np.argmin(np.abs(values - goal))])
