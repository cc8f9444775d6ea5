"""Load sharing of one machine at one speed: averages and the curve over a mesh cycle."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import islice

import numpy as np

from facegear.arrays import Array, Mask
from facegear.dynamics.dense_motion import DenseMotion
from facegear.dynamics.integrator.integrator import Integrator
from facegear.dynamics.motion import Motion, Settings, State
from facegear.dynamics.run_plans import RunPlan, alone, side_by_side
from facegear.dynamics.steady_state.guide import Guide
from facegear.dynamics.steady_state.known_orbit import KnownOrbit, known_orbit
from facegear.dynamics.steady_state.response import SteadyState
from facegear.dynamics.steady_state.simulate import (
    Model,
    StartedRun,
    build_model,
    simulating,
    start_run,
    static_start,
)
from facegear.load_sharing.coefficients import lost_contact, sharing_coefficient
from facegear.load_sharing.groups import LoadGroup, split_groups
from facegear.load_sharing.options import SharingOptions
from facegear.load_sharing.sampling import densely_sampled, same_orbit
from facegear.load_sharing.statistics import Average, average, defined_mean, held_over_starts
from facegear.transmission.machine import Machine

WATCHED, TORUS_WATCHED = 2, 8
"""Times the cycles averaged for which a motion is watched, and again before it is called quasi-periodic."""
SAMPLES = 64
"""At most so many a cycle from other starts, whose means alone are wanted."""
TOGETHER = 16
"""Machines whose motions are kept at a time."""


@dataclass(frozen=True, eq=False)
class GroupSharing:
    """One group: coefficient and lost contact (cycles, samples), average, range of the means over starts."""

    group: LoadGroup
    coefficients: Array
    lost: Mask
    average: Average
    starts_low: float
    starts_high: float


@dataclass(frozen=True, eq=False)
class Sharing:
    """All groups of a machine at a speed; `motions` holds the class of motion reached from each start."""

    motion: DenseMotion
    groups: tuple[GroupSharing, ...]
    motions: tuple[str, ...]

    @property
    def response(self) -> SteadyState:
        """The motion at its own samples."""
        return self.motion.response

    @property
    def period(self) -> float:
        """Mesh period in s."""
        return 2.0 * np.pi / self.response.frequency


def load_sharing(
    machine: Machine | Model, speed_rpm: float, settings: Settings, options: SharingOptions, start: int = 0
) -> Sharing:
    """Coefficients from one of the starting states, and how far the means move from the others.

    The averages belong to number `start`, static equilibrium by default; with several stable motions, or an
    irregular one, the range over the starts says how much that choice matters. Raises NotConverged if an
    integration fails.
    """
    return load_sharing_of_many([(machine, speed_rpm)], settings, options, start)[0]


def load_sharing_of_many(
    cases: Sequence[tuple[Machine | Model, float]],
    settings: Settings,
    options: SharingOptions,
    start: int = 0,
) -> list[Sharing]:
    """load_sharing() of machines, each at its speed in rpm; TOGETHER of them run side by side."""
    settings = replace(settings, window=options.cycles, samples=options.samples)
    runs = [
        _Run(build_model(machine) if isinstance(machine, Machine) else machine, speed, settings, options)
        for machine, speed in cases
    ]
    shared: list[Sharing] = []
    for first in range(0, len(runs), TOGETHER):
        shared += _side_by_side(runs[first : first + TOGETHER], start)
    return shared


@dataclass(frozen=True, eq=False)
class _Run:
    """A machine at a speed in rpm that runs from several starts."""

    model: Model
    speed_rpm: float
    settings: Settings
    options: SharingOptions

    def motion(self, state: State) -> RunPlan[SteadyState]:
        """The motion that counts."""
        return watching(self.model, self.speed_rpm, self.settings, self.options, state)

    def other(self, state: State, known: KnownOrbit | None) -> RunPlan[SteadyState | None]:
        """That from another start, coarsely sampled; None where it comes to the known orbit."""
        coarse = replace(self.settings, samples=min(SAMPLES, self.options.samples))
        watched = watched_for(coarse, self.options, WATCHED)
        begun = yield from start_run(self.model, self.speed_rpm, watched, state, known_orbit=known)
        return (
            None if begun.is_known_orbit else (yield from followed(self.model, begun, coarse, self.options))
        )

    def known(self, response: SteadyState) -> KnownOrbit | None:
        """The orbit of a response that other starts may come to."""
        precision = self.settings.tolerance, self.settings.order
        return known_orbit(Integrator(response.system, response.frequency, *precision), response.orbit)

    def sharing(self, response: SteadyState, others: list[SteadyState | None]) -> Sharing:
        """What the motion that counts and those from the other starts say."""
        groups = split_groups(self.model.machine.layout)
        elsewhere = [other for other in others if other is not None and not same_orbit(response, other)]
        means = [_means(densely_sampled(other), groups) for other in elsewhere]
        again = [
            mean
            for other, mean in zip(elsewhere, means, strict=True)
            if response.motion is not Motion.PERIODIC and other.label == response.label
        ]
        dense = densely_sampled(response)
        shared = tuple(
            _group(dense, group, self.options, [mean[i] for mean in means], [mean[i] for mean in again])
            for i, group in enumerate(groups)
        )
        return Sharing(dense, shared, tuple((other or response).label for other in (None, *others)))


def _side_by_side(runs: Sequence[_Run], start: int) -> list[Sharing]:
    """The motions from number `start` of the starting states, then those from the others."""
    states = [starting_states(run.model, run.options, max(run.options.starts, start + 1)) for run in runs]
    responses = side_by_side([run.motion(own[start]) for run, own in zip(runs, states, strict=True)])
    courses, counts = [], []
    for run, own, response in zip(runs, states, responses, strict=True):
        known = run.known(response)
        others = [state for number, state in enumerate(own[: run.options.starts]) if number != start]
        courses += [run.other(state, known) for state in others]
        counts.append(len(others))
    motions = iter(side_by_side(courses))
    return [
        run.sharing(response, list(islice(motions, count)))
        for run, response, count in zip(runs, responses, counts, strict=True)
    ]


def measured_motion(
    model: Model, speed_rpm: float, settings: Settings, options: SharingOptions, guide: Guide | None = None
) -> DenseMotion:
    """The motion from static equilibrium, as load_sharing() measures it; `guide`: an orbit of a like machine.

    Raises NotConverged.
    """
    settings = replace(settings, window=options.cycles, samples=options.samples)
    start = static_start(model)
    return densely_sampled(alone(watching(model, speed_rpm, settings, options, start, guide)))


def starting_states(model: Model, options: SharingOptions, count: int) -> list[State]:
    """The first `count` starting states: static equilibrium, then the same disturbed at random."""
    rest, random = static_start(model), np.random.default_rng(options.seed)
    return [rest, *(disturb(model, rest, options.spread, random) for _ in range(count - 1))]


def watching(
    model: Model,
    speed_rpm: float,
    settings: Settings,
    options: SharingOptions,
    start: State,
    guide: Guide | None = None,
) -> RunPlan[SteadyState]:
    """The motion from a start: what has not closed after a few times the cycles averaged is measured.

    `guide`: an orbit of a like machine.
    """
    begun = yield from start_run(model, speed_rpm, watched_for(settings, options, WATCHED), start, guide)
    return (yield from followed(model, begun, settings, options))


def followed(
    model: Model, motion: StartedRun, settings: Settings, options: SharingOptions
) -> RunPlan[SteadyState]:
    """What comes of a motion that was watched for the first time.

    A body that is pushed through its backlash for long, or an orbit that is approached slowly, looks like a
    torus for a while: what seems to be one is watched on. A class that must hold for good, as that of the
    response at the nominal speed, is watched for longer.
    """
    state = yield from motion.follow()
    if state.motion is not Motion.QUASI_PERIODIC:
        return state
    longer = watched_for(settings, options, TORUS_WATCHED)
    again = yield from simulating(model, motion.speed_rpm, longer, state.state)
    return replace(again, periods_run=state.periods_run + again.periods_run)


def watched_for(settings: Settings, options: SharingOptions, times: int) -> Settings:
    """Settings with patience for so many times the cycles averaged, and no more than they had."""
    return replace(settings, settle=min(settings.settle, times * options.cycles))


def disturb(model: Model, start: State, spread: float, random: np.random.Generator) -> State:
    """A start moved by normal displacements of size `spread` (m; rotations at the mesh radius)."""
    linear = model.machine.linear
    moved = spread * random.normal(size=linear.size) / linear.lengths
    return replace(start, displacement=start.displacement + model.reduction.basis.T @ linear.momentum(moved))


def cycle_forces(motion: DenseMotion) -> Array:
    """Elastic mesh forces by cycle, shape (meshes, cycles, samples), N."""
    return motion.loads.reshape(len(motion.loads), -1, motion.per_period)


def group_average(motion: DenseMotion, group: LoadGroup, confidence: float) -> tuple[Array, Mask, Average]:
    """Coefficient and lost contact of a group, each (cycles, samples), and their average."""
    forces = np.moveaxis(cycle_forces(motion)[list(group.meshes)], 0, -1)
    coefficients, lost = sharing_coefficient(forces), lost_contact(forces)
    periodic = motion.response.motion is Motion.PERIODIC
    return coefficients, lost, average(coefficients, lost, confidence, periodic)


def _means(motion: DenseMotion, groups: tuple[LoadGroup, ...]) -> list[float]:
    """Mean coefficient of each group, NaN where nothing is ever loaded."""
    forces = np.moveaxis(cycle_forces(motion), 0, -1)
    return [defined_mean(sharing_coefficient(forces[..., group.meshes])) for group in groups]


def _group(
    motion: DenseMotion, group: LoadGroup, options: SharingOptions, others: list[float], again: list[float]
) -> GroupSharing:
    """`others`: the means from other starts, of which `again` are those of the same irregular motion."""
    coefficients, lost, first = group_average(motion, group, options.confidence)
    every = max(coefficients.shape[1] // options.samples, 1)
    defined = [mean for mean in (first.mean, *others) if not np.isnan(mean)] or [float("nan")]
    return GroupSharing(
        group=group,
        coefficients=coefficients[:, ::every],
        lost=lost[:, ::every],
        average=held_over_starts(first, again, options.confidence),
        starts_low=min(defined),
        starts_high=max(defined),
    )
