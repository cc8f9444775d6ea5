"""Load sharing of one machine at one speed: averages and the curve over a mesh cycle."""

from dataclasses import dataclass, replace

import numpy as np

from facegear.arrays import Array, Mask
from facegear.dynamics.courses import Course, alone
from facegear.dynamics.dense_motion import DenseMotion
from facegear.dynamics.motion import Motion, Settings, State
from facegear.dynamics.steady_state.guide import Guide, guide_of
from facegear.dynamics.steady_state.response import SteadyState
from facegear.dynamics.steady_state.simulate import (
    Model,
    Started,
    build_model,
    simulating,
    started,
    static_start,
)
from facegear.load_sharing.coefficients import lost_contact, sharing_coefficient
from facegear.load_sharing.groups import LoadGroup, load_groups
from facegear.load_sharing.options import SharingOptions
from facegear.load_sharing.sampling import densely_sampled, same_orbit
from facegear.load_sharing.statistics import Average, average, defined_mean
from facegear.transmission.flanks import carried
from facegear.transmission.machine import Machine

WATCHED, TORUS_WATCHED = 2, 8
"""Times the cycles averaged for which a motion is watched, and again before it is called quasi-periodic."""
SAMPLES = 64
"""At most so many a cycle from other starts, whose means alone are wanted."""


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
    model = build_model(machine) if isinstance(machine, Machine) else machine
    settings = replace(settings, window=options.cycles, samples=options.samples)
    groups = load_groups(model.machine.layout)
    states = starting_states(model, options, max(options.starts, start + 1))
    response = watched_motion(model, speed_rpm, settings, options, states[start])
    coarse = replace(settings, samples=min(SAMPLES, options.samples))
    motions, means, known = [response.label], [], guide_of(response.system, response.orbit)
    for state in [state for number, state in enumerate(states[: options.starts]) if number != start]:
        other = watched_motion(model, speed_rpm, coarse, options, state, known)
        motions.append(other.label)
        if not same_orbit(response, other):
            means.append(_means(densely_sampled(other), groups))
    dense = densely_sampled(response)
    shared = tuple(
        _group(dense, group, options, [mean[i] for mean in means]) for i, group in enumerate(groups)
    )
    return Sharing(dense, shared, tuple(motions))


def measured_motion(
    model: Model, speed_rpm: float, settings: Settings, options: SharingOptions, guide: Guide | None = None
) -> DenseMotion:
    """The motion from static equilibrium, as load_sharing() measures it; `guide`: an orbit of a like machine.

    Raises NotConverged.
    """
    settings = replace(settings, window=options.cycles, samples=options.samples)
    start = static_start(model)
    return densely_sampled(watched_motion(model, speed_rpm, settings, options, start, guide))


def starting_states(model: Model, options: SharingOptions, count: int) -> list[State]:
    """The first `count` starting states: static equilibrium, then the same disturbed at random."""
    rest, random = static_start(model), np.random.default_rng(options.seed)
    return [rest, *(disturb(model, rest, options.spread, random) for _ in range(count - 1))]


def watched_motion(
    model: Model,
    speed_rpm: float,
    settings: Settings,
    options: SharingOptions,
    start: State | None,
    guide: Guide | None = None,
) -> SteadyState:
    """The motion from a start: what has not closed after a few times the cycles averaged is measured.

    `guide`: an orbit that the run may come to, or one of a like machine.
    """
    begin = started(model, speed_rpm, watched_for(settings, options, WATCHED), start, guide)
    return alone(followed(model, alone(begin), settings, options))


def followed(
    model: Model, motion: Started, settings: Settings, options: SharingOptions
) -> Course[SteadyState]:
    """What comes of a motion that was watched for the first time.

    A body that is pushed through its backlash for long, or an orbit that is approached slowly, looks like a
    torus for a while: what seems to be one is watched on. A class that must hold for good, as that of the
    response at the nominal speed, is watched for longer.
    """
    state = yield from motion.followed()
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
    return replace(start, displacement=start.displacement + model.reduced.basis.T @ linear.momentum(moved))


def cycle_forces(motion: DenseMotion) -> Array:
    """Elastic mesh forces by cycle, shape (meshes, cycles, samples), N."""
    return carried(motion.forces).reshape(len(motion.forces), -1, motion.per_period)


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
    motion: DenseMotion, group: LoadGroup, options: SharingOptions, others: list[float]
) -> GroupSharing:
    """`others`: the means from other starts."""
    coefficients, lost, first = group_average(motion, group, options.confidence)
    every = max(coefficients.shape[1] // options.samples, 1)
    defined = [mean for mean in (first.mean, *others) if not np.isnan(mean)] or [float("nan")]
    return GroupSharing(
        group=group,
        coefficients=coefficients[:, ::every],
        lost=lost[:, ::every],
        average=first,
        starts_low=min(defined),
        starts_high=max(defined),
    )
