"""Jumps in a sweep: found where the response changes abruptly, then bracketed by bisection."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from facegear.dynamics.motion import State
from facegear.dynamics.steady_state.simulate import SteadyState
from facegear.dynamics.steady_state.statistics import moments
from facegear.dynamics.sweeps.sweep import DEFLECTION, FACTS, Piece

Array = NDArray[np.float64]
MULTIPLIER = FACTS.index("leading_multiplier")
LEAST_CHANGE = 0.1
"""Relative change of a mesh's AC RMS between neighbouring speeds that may be a jump."""
ABRUPT = 3.0
"""A jump is this many times the change over the speeds around it."""
FLOOR = 1e-3
"""AC RMS below this share of the largest is not compared."""

Respond = Callable[[float, State], SteadyState]


@dataclass(frozen=True, eq=False)
class Jump:
    """The response leaves its branch between two speeds (in the order of running).

    before, after: AC RMS of every mesh deflection, m, with their classes of motion. mesh: where the relative
    change is largest. multiplier: the leading one on the branch that ends, NaN if it is not periodic.
    largest: the sweep's position next to the jump with the larger response.
    """

    speed_before: float
    speed_after: float
    before: Array
    after: Array
    label_before: str
    label_after: str
    mesh: int
    multiplier: float
    largest: int

    @property
    def abrupt(self) -> bool:
        """Whether a jump is left in the refined bracket, and not a steep but smooth change or noise."""
        regular = self.label_before.startswith("period-") or self.label_after.startswith("period-")
        return distance(self.before, self.after) > np.log1p(LEAST_CHANGE if regular else 3.0 * LEAST_CHANGE)


@dataclass(frozen=True, eq=False)
class Side:
    """Response on one side of a jump: AC RMS of the mesh deflections (meshes,), class, multiplier, state."""

    speed: float
    ac_rms: Array
    label: str
    multiplier: float
    state: State


def suspects(piece: Piece) -> list[int]:
    """Positions i where the response jumps on the way from speed i to i + 1."""
    ac_rms = piece.deflection[:, DEFLECTION.index("ac_rms")]
    interval = piece.deflection[:, DEFLECTION.index("ac_rms_interval")]
    floor = FLOOR * ac_rms.max()
    logs = np.log(np.maximum(ac_rms, floor))
    doubt = interval / np.maximum(ac_rms, floor)
    change = np.abs(np.diff(logs, axis=0)) - 2.0 * (doubt[1:] + doubt[:-1])
    largest = change.max(axis=1)
    around = np.full_like(change, 0.0)
    around[1:] = np.maximum(around[1:], change[:-1])
    around[:-1] = np.maximum(around[:-1], change[1:])
    abrupt = (change > ABRUPT * around) & (change > np.log1p(LEAST_CHANGE))
    return [int(i) for i in np.flatnonzero(abrupt.any(axis=1) & (largest > 0.0))]


def refine(piece: Piece, position: int, respond: Respond, resolution: float) -> Jump:
    """Bisect between two speeds of a sweep, each time from the state on the branch that ends."""
    row = DEFLECTION.index("ac_rms")
    before = Side(
        float(piece.speeds[position]),
        piece.deflection[position, row],
        str(piece.labels[position]),
        float(piece.facts[position, MULTIPLIER]),
        piece.state(position),
    )
    after = Side(
        float(piece.speeds[position + 1]),
        piece.deflection[position + 1, row],
        str(piece.labels[position + 1]),
        float(piece.facts[position + 1, MULTIPLIER]),
        piece.state(position + 1),
    )
    before, after = bracket(before, after, respond, resolution)
    floor = np.full_like(before.ac_rms, 1e-300)
    ratio = np.log(np.maximum(after.ac_rms, floor) / np.maximum(before.ac_rms, floor))
    mesh = int(np.argmax(np.abs(ratio)))
    return Jump(
        before.speed,
        after.speed,
        before.ac_rms,
        after.ac_rms,
        before.label,
        after.label,
        mesh,
        before.multiplier,
        position + int(ratio[mesh] > 0.0),
    )


def bracket(before: Side, after: Side, respond: Respond, resolution: float) -> tuple[Side, Side]:
    """Halve the interval between two speeds with different responses down to `resolution`."""
    while abs(after.speed - before.speed) > resolution:
        middle = 0.5 * (before.speed + after.speed)
        here = side(middle, respond(middle, before.state))
        if distance(here.ac_rms, before.ac_rms) <= distance(here.ac_rms, after.ac_rms):
            before = here
        else:
            after = here
    return before, after


def side(speed: float, response: SteadyState) -> Side:
    """What bisection compares, from a response."""
    ac_rms = moments(response.deflections, response.per_period, response.period > 0).ac_rms
    multiplier = np.nan if response.multipliers is None else float(abs(response.multipliers[0]))
    return Side(speed, ac_rms, response.label, multiplier, response.state)


def distance(first: Array, second: Array) -> float:
    """Largest ratio between two sets of AC RMS, as a logarithm, with the same floor as in `suspects`."""
    floor = FLOOR * max(first.max(), second.max(), 1e-300)
    return float(np.abs(np.log(np.maximum(first, floor) / np.maximum(second, floor))).max())
