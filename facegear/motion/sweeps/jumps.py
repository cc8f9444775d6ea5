"""Find jumps in a sweep where the response changes abruptly, and bracket them by following the motion.

The periodic motion before a suspected jump is followed as an orbit, speed by speed, until it ends or loses
its stability. That speed is a property of the motion, so it depends neither on the speeds of the sweep nor on
how far a run is from the edge of its basin. Motions that are not periodic are bracketed by bisection.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from facegear.arrays import Array, Integers
from facegear.motion.plan import JumpKind, Motion, State
from facegear.motion.requests import RunPlan
from facegear.motion.steady_state.mirror_images import symmetry_broken
from facegear.motion.steady_state.response import SteadyState
from facegear.motion.sweeps.held_orbit import (
    FLOOR,
    MIN_CHANGE,
    SAME_ORBIT,
    HeldOrbit,
    OrbitFollower,
    distance,
    image_distance,
)
from facegear.motion.sweeps.sweep import Piece

ABRUPT = 3.0
"""Factor by which a jump exceeds the changes over the neighbouring speeds."""
NEAR_LOSS = 4.0
"""Distance, in resolutions, from the last orbit held within which a change found by runs is its end."""
MAX_CHANGES = 4
"""Maximum number of smooth changes of the motion, such as period doublings, that are followed on the way to a
jump.

Changes after them are bracketed by bisection.
"""
KICKS = (0.01, 0.05, 0.2)
"""Disturbances of an orbit that has just lost its stability, in length scales; the first after which a run
settles counts. Without any it takes some 10,000 periods to leave an orbit with a multiplier of 1.0005."""
RUNS = 2
"""Number of runs, each from the end of the one before, in which a motion may settle."""

Respond = Callable[[float, State], RunPlan[SteadyState]]
"""Makes a run plan of the response at a speed (rpm) from a state."""


@dataclass(frozen=True, eq=False)
class JumpSide:
    """Response on one side of a jump.

    Attributes
    ----------
    speed : float
        Pinion speed, rpm.
    ac_rms : (meshes,) array
        AC RMS of the mesh deflections, m.
    label : str
        Class of motion.
    period : int
        Mesh periods; 0 where the motion is not periodic.
    multiplier : float
        Magnitude of the leading multiplier, NaN where there is none.
    symmetry_broken : bool
        Whether the motion has mirror images that are other motions.
    state : State
        State at the end.
    """

    speed: float
    ac_rms: Array
    label: str
    period: int
    multiplier: float
    symmetry_broken: bool
    state: State


@dataclass(frozen=True, eq=False)
class Jump:
    """The response leaves its branch between two speeds (in the order of running).

    Attributes
    ----------
    before, after : JumpSide
        Responses on both sides.
    mesh : int
        Mesh in which the relative change is largest.
    largest : int
        Index in the sweep of the one of the two speeds beside the jump whose response is larger in that
        mesh.
    error : float
        Distance that the speed of the change may have from the bracket, rpm: its width where the motion
        before it was followed as an orbit, else the sweep's step, since a run leaves irregular motion by
        chance.
    is_followed : bool
        Whether the motion before it was followed as an orbit until it was lost.
    """

    before: JumpSide
    after: JumpSide
    mesh: int
    largest: int
    error: float
    is_followed: bool

    @property
    def kind(self) -> JumpKind:
        """Kind of the change: IRREGULAR if a side is not periodic, else JUMP if the motion was followed,
        else STEP.
        """
        if self.before.period == 0 or self.after.period == 0:
            return JumpKind.IRREGULAR
        return JumpKind.JUMP if self.is_followed else JumpKind.STEP


def suspects(piece: Piece) -> dict[int, bool]:
    """Find the positions i at which the response may jump on the way from speed i to i + 1.

    A change is abrupt if it is larger than the changes around it. Between periodic motions every change that
    is large enough for a jump counts, since following the orbit tells a jump from a steep curve.

    Parameters
    ----------
    piece : Piece
        Results of a sweep in one direction.

    Returns
    -------
    dict
        Whether the change is larger than those around it, by position i; False where it is only steep
        between periodic motions.
    """
    ac_rms, interval = piece.deflection_ac_rms, piece.deflection_ac_rms_interval
    floor = FLOOR * ac_rms.max()
    logs = np.log(np.maximum(ac_rms, floor))
    doubt = interval / np.maximum(ac_rms, floor)
    change = np.abs(np.diff(logs, axis=0)) - 2.0 * (doubt[1:] + doubt[:-1])
    around = np.full_like(change, 0.0)
    around[1:] = np.maximum(around[1:], change[:-1])
    around[:-1] = np.maximum(around[:-1], change[1:])
    large = change > np.log1p(MIN_CHANGE)
    abrupt = (large & (change > ABRUPT * around)).any(axis=1)
    steep = large.any(axis=1) & piece.periodic[1:] & piece.periodic[:-1]
    return {int(i): bool(abrupt[i]) for i in np.flatnonzero(abrupt | steep)}


def refine(
    piece: Piece,
    position: int,
    respond: Respond,
    follower: OrbitFollower,
    resolution: float,
    images: Integers,
    thorough: bool,
) -> RunPlan[Jump | None]:
    """Find where the motion at a position of a sweep is lost before the next position.

    Parameters
    ----------
    piece : Piece
        Results of a sweep in one direction.
    position : int
        Number of the speed before the change.
    respond : Respond
        Makes a run plan of the response at a speed (rpm) from a state.
    follower : OrbitFollower
        Follows orbits over the speed.
    resolution : float
        Width of the bracket, rpm.
    images : (images, meshes) array
        Permutations of the meshes by symmetry. Mirror images are one motion.
    thorough : bool
        Whether to bisect where no orbit can be followed, and to wait for a motion that settles slowly.

    Returns
    -------
    RunPlan of Jump or None
        Generator for requests.alone() or side_by_side(), which returns the jump; None if the motion is
        not lost.
    """
    before, end = (_stored_side(piece, i) for i in (position, position + 1))
    step = abs(end.speed - before.speed)
    last_orbit: JumpSide | None = None
    for _ in range(MAX_CHANGES):
        orbit = follower.orbit(before.speed, before.state, before.period)
        if orbit is None and not thorough:
            return None
        if orbit is None:
            before, after = yield from bracket(before, end, respond, resolution, images)
            if last_orbit is not None and abs(after.speed - last_orbit.speed) <= NEAR_LOSS * resolution:
                width = abs(after.speed - last_orbit.speed)
                return _jump(piece, position, last_orbit, after, images, width, True)
            return _jump(piece, position, before, after, images, step, False)
        last, beyond = follower.until_lost(orbit, end.speed, resolution)
        if beyond is None:
            if image_distance(last.ac_rms, end.ac_rms, images) <= SAME_ORBIT and last.period == end.period:
                return None
            return _jump(piece, position, before, end, images, step, False)
        # Beside a fold a run from the orbit may already leave it: the orbit itself is the motion before.
        last_orbit = before = _held_side(last, before)
        after = yield from _beyond(last, beyond, follower, respond, KICKS if thorough else KICKS[:1])
        if abrupt(before, after, images):
            width = abs(after.speed - before.speed)
            return _jump(piece, position, before, after, images, width, True)
        before = after
    if not thorough:
        return None
    before, after = yield from bracket(before, end, respond, resolution, images)
    return _jump(piece, position, before, after, images, step, False)


def _held_side(orbit: HeldOrbit, former: JumpSide) -> JumpSide:
    """Return an orbit as a side of a jump; its `symmetry_broken` is that of the motion `former` from
    which it was followed.
    """
    return replace(
        former,
        speed=orbit.speed,
        ac_rms=orbit.ac_rms,
        label=f"period-{orbit.period}",
        period=orbit.period,
        multiplier=orbit.multiplier,
        state=orbit.state,
    )


def _beyond(
    last: HeldOrbit, speed: float, follower: OrbitFollower, respond: Respond, kicks: Sequence[float]
) -> RunPlan[JumpSide]:
    """Run plan that finds the motion after an orbit at a speed (rpm) at which the orbit is lost, as a
    side of a jump.

    The runs start aside of the orbit by `kicks`, in length scales, one after the other until a run
    settles. A motion may be left, and the next approached, so slowly that none does: then a run goes on
    once, and larger kicks are tried. A class that other starts have taken back stays undecided.
    """
    for kick in kicks:
        state = follower.aside(last, speed, kick)
        for _ in range(RUNS):
            response = yield from respond(speed, state)
            if response.motion is not Motion.NOT_SETTLED or response.looks is not None:
                return side(speed, response)
            state = response.state
    return side(speed, response)


def _jump(
    piece: Piece,
    position: int,
    before: JumpSide,
    after: JumpSide,
    images: Integers,
    error: float,
    is_followed: bool,
) -> Jump | None:
    """Return the jump between two sides at a position of a piece, or None if the change is smooth or
    noise.

    `error` and `is_followed` are those of Jump. The AC RMS after it is that of the preferred mirror
    image.
    """
    if not abrupt(before, after, images):
        return None
    after = replace(after, ac_rms=after.ac_rms[_preferred(before.ac_rms, after.ac_rms, images)])
    floor = np.full_like(before.ac_rms, 1e-300)
    ratio = np.log(np.maximum(after.ac_rms, floor) / np.maximum(before.ac_rms, floor))
    # Twins differ by what their AC RMS err by, which is absolute in a logarithm.
    mesh = int(np.flatnonzero(np.abs(ratio) >= np.abs(ratio).max() - SAME_ORBIT)[0])
    return Jump(before, after, mesh, position + int(ratio[mesh] > 0.0), error, is_followed)


def _preferred(before: Array, after: Array, images: Integers) -> Integers:
    """Return the mirror image of the motion after a jump that is reported, as a permutation of the meshes
    (meshes,).

    `before` and `after` are AC RMS (meshes,), m, of both motions. Of the images that the symmetries of
    the motion before the jump allow, it is the one with the largest AC RMS in the first mesh in which
    they differ.
    """
    candidates = [image for image in images if distance(before, before[image]) <= SAME_ORBIT]
    digits = np.round(-np.log10(SAME_ORBIT)).astype(int)
    scale = max(float(after.max()), 1e-300)
    return max(candidates, key=lambda image: tuple(np.round(after[image] / scale, digits)))


def _stored_side(piece: Piece, position: int) -> JumpSide:
    """Return the response that a sweep has found at the speed at a position, as a side of a jump."""
    return JumpSide(
        speed=float(piece.speeds[position]),
        ac_rms=piece.deflection_ac_rms[position],
        label=piece.labels[position],
        period=int(piece.period[position]),
        multiplier=float(piece.leading_multiplier[position]),
        symmetry_broken=bool(piece.symmetry_broken[position]),
        state=piece.state(position),
    )


def bracket(
    before: JumpSide, after: JumpSide, respond: Respond, resolution: float, images: Integers
) -> RunPlan[tuple[JumpSide, JumpSide]]:
    """Halve the interval between two speeds with different responses.

    Parameters
    ----------
    before, after : JumpSide
        Responses at both speeds.
    respond : Respond
        Makes a run plan of the response at a speed.
    resolution : float
        Width of the interval at the end, rpm.
    images : (images, meshes) array
        Permutations of the meshes by symmetry.

    Returns
    -------
    RunPlan of tuple
        Generator for requests.alone() or side_by_side(), which returns the responses at both ends of the
        last interval; each new run starts from the state on the `before` side, and belongs to the side
        that its AC RMS (meshes,) in m are nearer to.
    """
    while abs(after.speed - before.speed) > resolution:
        middle = 0.5 * (before.speed + after.speed)
        response = yield from respond(middle, before.state)
        middle_side = side(middle, response)
        to_before, to_after = (
            image_distance(middle_side.ac_rms, side.ac_rms, images) for side in (before, after)
        )
        if to_before <= to_after:
            before = middle_side
        else:
            after = middle_side
    return before, after


def abrupt(before: JumpSide, after: JumpSide, images: Integers) -> bool:
    """Whether two motions differ by more than a smooth change or noise.

    Parameters
    ----------
    before, after : JumpSide
        Responses.
    images : (images, meshes) array
        Permutations of the meshes by symmetry.

    Returns
    -------
    bool
        True if the AC RMS of a mesh differs by more than the fraction MIN_CHANGE, or three times that if
        neither is periodic. Mirror images count as one.
    """
    regular = before.period > 0 or after.period > 0
    apart = image_distance(before.ac_rms, after.ac_rms, images)
    return apart > np.log1p(MIN_CHANGE if regular else 3.0 * MIN_CHANGE)


def side(speed: float, response: SteadyState) -> JumpSide:
    """Reduce a response to the numbers that bisection compares.

    Parameters
    ----------
    speed : float
        Pinion speed, rpm.
    response : SteadyState
        Response.

    Returns
    -------
    JumpSide
        Side of a jump.
    """
    ac_rms = response.moments.ac_rms
    multiplier = np.nan if response.multipliers is None else float(abs(response.multipliers[0]))
    return JumpSide(
        speed=speed,
        ac_rms=ac_rms,
        label=response.label,
        period=response.period,
        multiplier=multiplier,
        symmetry_broken=symmetry_broken(response),
        state=response.state,
    )
