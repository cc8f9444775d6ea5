"""Jumps in a sweep: found where the response changes abruptly, then bracketed by bisection."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.courses import Course
from facegear.dynamics.motion import State
from facegear.dynamics.steady_state.response import SteadyState
from facegear.dynamics.sweeps.sweep import Piece

MIN_CHANGE = 0.1
"""Relative change of a mesh's AC RMS between neighbouring speeds that may be a jump."""
ABRUPT = 3.0
"""A jump is this many times the change over the speeds around it."""
FLOOR = 1e-3
"""AC RMS below this fraction of the largest is not compared."""

Respond = Callable[[float, State], Course[SteadyState]]


@dataclass(frozen=True, eq=False)
class JumpSide:
    """Response on one side of a jump: AC RMS of the mesh deflections (meshes,), m, its class and state.

    period: 0 where the motion is not periodic. multiplier: the leading one, NaN where there is none.
    """

    speed: float
    ac_rms: Array
    label: str
    period: int
    multiplier: float
    state: State


@dataclass(frozen=True, eq=False)
class Jump:
    """The response leaves its branch between two speeds (in the order of running).

    Attributes
    ----------
    before, after
        What is found on both sides.
    mesh
        Where the relative change is largest.
    largest
        The sweep's position next to the jump with the larger response.
    """

    before: JumpSide
    after: JumpSide
    mesh: int
    largest: int

    @property
    def abrupt(self) -> bool:
        """Whether a jump is left in the refined bracket, and not a steep but smooth change or noise."""
        regular = self.before.period > 0 or self.after.period > 0
        return distance(self.before.ac_rms, self.after.ac_rms) > np.log1p(
            MIN_CHANGE if regular else 3.0 * MIN_CHANGE
        )


def suspects(piece: Piece) -> list[int]:
    """Positions i where the response jumps on the way from speed i to i + 1."""
    ac_rms, interval = piece.deflection_ac_rms, piece.deflection_ac_rms_interval
    floor = FLOOR * ac_rms.max()
    logs = np.log(np.maximum(ac_rms, floor))
    doubt = interval / np.maximum(ac_rms, floor)
    change = np.abs(np.diff(logs, axis=0)) - 2.0 * (doubt[1:] + doubt[:-1])
    largest = change.max(axis=1)
    around = np.full_like(change, 0.0)
    around[1:] = np.maximum(around[1:], change[:-1])
    around[:-1] = np.maximum(around[:-1], change[1:])
    abrupt = (change > ABRUPT * around) & (change > np.log1p(MIN_CHANGE))
    return [int(i) for i in np.flatnonzero(abrupt.any(axis=1) & (largest > 0.0))]


def refine(piece: Piece, position: int, respond: Respond, resolution: float) -> Course[Jump]:
    """Bisect between two speeds of a sweep, each time from the state on the branch that ends."""
    before, after = (_stored_side(piece, i) for i in (position, position + 1))
    before, after = yield from bracket(before, after, respond, resolution)
    floor = np.full_like(before.ac_rms, 1e-300)
    ratio = np.log(np.maximum(after.ac_rms, floor) / np.maximum(before.ac_rms, floor))
    mesh = int(np.argmax(np.abs(ratio)))
    return Jump(before=before, after=after, mesh=mesh, largest=position + int(ratio[mesh] > 0.0))


def _stored_side(piece: Piece, position: int) -> JumpSide:
    """What a sweep has found at one of its speeds."""
    return JumpSide(
        speed=float(piece.speeds[position]),
        ac_rms=piece.deflection_ac_rms[position],
        label=piece.labels[position],
        period=int(piece.period[position]),
        multiplier=float(piece.leading_multiplier[position]),
        state=piece.state(position),
    )


def bracket(
    before: JumpSide, after: JumpSide, respond: Respond, resolution: float
) -> Course[tuple[JumpSide, JumpSide]]:
    """Halve the interval between two speeds with different responses down to `resolution`."""
    while abs(after.speed - before.speed) > resolution:
        middle = 0.5 * (before.speed + after.speed)
        response = yield from respond(middle, before.state)
        here = side(middle, response)
        if distance(here.ac_rms, before.ac_rms) <= distance(here.ac_rms, after.ac_rms):
            before = here
        else:
            after = here
    return before, after


def side(speed: float, response: SteadyState) -> JumpSide:
    """What bisection compares, from a response."""
    ac_rms = response.moments.ac_rms
    multiplier = np.nan if response.multipliers is None else float(abs(response.multipliers[0]))
    return JumpSide(
        speed=speed,
        ac_rms=ac_rms,
        label=response.label,
        period=response.period,
        multiplier=multiplier,
        state=response.state,
    )


def distance(first: Array, second: Array) -> float:
    """Largest ratio between two sets of AC RMS, as a logarithm, with the same floor as in `suspects`."""
    floor = FLOOR * max(first.max(), second.max(), 1e-300)
    return float(np.abs(np.log(np.maximum(first, floor) / np.maximum(second, floor))).max())
