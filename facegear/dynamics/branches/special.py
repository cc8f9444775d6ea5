"""Special points of a branch: what they are and what proves them.

Folds and doublings: Seydel 2010; grazing: di Bernardo et al. 2008.
"""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from facegear.arrays import ComplexArray
from facegear.dynamics.branches.points import BranchPoint


class Kind(StrEnum):
    """What happens at a special point."""

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
    kind
        What it is.
    point
        The motion there.
    multiplier
        The critical one (NaN at a graze).
    proof
        What shows that it is one.
    after
        Position along the branch.
    meshes
        Those that graze.
    edge
        Which edge they graze, +1 upper, -1 lower.
    """

    kind: Kind
    point: BranchPoint
    multiplier: complex
    proof: str
    after: float
    meshes: tuple[int, ...] = ()
    edge: int = 0


def evidence(
    kind: Kind, off: float, before: BranchPoint, here: BranchPoint, after: BranchPoint
) -> tuple[complex, str]:
    """The critical multiplier of a point between two neighbours, and what proves it.

    off: how far the extreme of a graze lies from the edge, over the length scale.
    """
    if kind is Kind.GRAZE:
        return complex(np.nan), f"an extreme lies {abs(off):.1e} length scales from the edge"
    if kind is Kind.FOLD:
        mu = _nearest(here.multipliers, 1.0)
        return mu, (
            f"the speed component of the tangent goes from {before.tangent[-1]:+.1e} to "
            f"{after.tangent[-1]:+.1e}; multiplier {mu.real:.9f}"
        )
    if kind is Kind.DOUBLING:
        mu = _nearest(here.multipliers, -1.0)
        return mu, f"a real multiplier is {mu.real:.9f}, goes through -1"
    if kind is Kind.BRANCH:
        mu = _nearest(here.multipliers, 1.0)
        flipped = "changes" if before.parity != after.parity else "keeps"
        return mu, f"multiplier {mu.real:.9f} at a tangent with {here.tangent[-1]:+.1e}; parity {flipped}"
    pair = here.pairs[np.argmin(np.abs(np.abs(here.pairs) - 1.0))] if here.pairs.size else complex(np.nan)
    return complex(pair), f"modulus {abs(pair):.9f}, angle {np.degrees(np.angle(pair)):.6f} deg"


def _nearest(values: ComplexArray, goal: float) -> complex:
    return complex(values[np.argmin(np.abs(values - goal))])
