"""Load sharing of one machine at one speed: averages and the curve over a mesh cycle."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import islice

import numpy as np

from facegear.machine.machine import Machine
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.plan import Motion, Settings, State
from facegear.motion.requests import RunPlan, alone, side_by_side
from facegear.motion.steady_state.guide import Guide
from facegear.motion.steady_state.periodicity import KnownOrbit, known_orbit
from facegear.motion.steady_state.response import SteadyState
from facegear.motion.steady_state.simulate import (
    Model,
    StartedRun,
    build_model,
    simulating,
    start_run,
    static_start,
)
from facegear.motion.track import DenseMotion
from facegear.sharing.even_shares import GroupSharing, _group, _means
from facegear.sharing.groups import SharingOptions, split_groups
from facegear.sharing.statistics import densely_sampled, same_orbit

FIRST_WINDOW, TORUS_WINDOW = 2, 8
"""Length of the first window of a motion, and of the window before it is called quasi-periodic, in times the
cycles that are averaged.
"""
SAMPLES = 64
"""Largest number of samples in a mesh cycle of motions from other starts, of which only the means are
used.
"""
TOGETHER = 16
"""Number of machines whose motions are in memory at a time."""


@dataclass(frozen=True, eq=False)
class Sharing:
    """All groups of a machine at a speed; `motions` holds the class of motion reached from each start."""

    motion: DenseMotion
    groups: tuple[GroupSharing, ...]
    motions: tuple[str, ...]

    @property
    def response(self) -> SteadyState:
        """The steady motion from which the averages are, at its own samples."""
        return self.motion.response

    @property
    def period(self) -> float:
        """Mesh period (one tooth engagement), s."""
        return 2.0 * np.pi / self.response.frequency


def load_sharing(
    machine: Machine | Model, speed_rpm: float, settings: Settings, options: SharingOptions, start: int = 0
) -> Sharing:
    """Compute the load-sharing coefficients of a machine at a speed, and how far their means depend on
    the start.

    The averages belong to the motion from starting state number `start`. With several stable motions, or an
    irregular one, the range of the means over all starts says how much that choice matters.

    Parameters
    ----------
    machine : Machine or Model
        The machine, or its reduced model.
    speed_rpm : float
        Speed of the pinions, rpm.
    settings : Settings
        Settings of the integration; its window and samples are replaced by those of the options.
    options : SharingOptions
        Cycles, samples, number of starts and confidence.
    start : int
        Index of the starting state that counts; 0 is static equilibrium.

    Returns
    -------
    Sharing
        Motion, results of all groups that split a load, and the class of motion from each start.

    Raises
    ------
    NotConverged
        If an integration fails.
    """
    return load_sharing_of_many([(machine, speed_rpm)], settings, options, start)[0]


def load_sharing_of_many(
    cases: Sequence[tuple[Machine | Model, float]],
    settings: Settings,
    options: SharingOptions,
    start: int = 0,
) -> list[Sharing]:
    """Compute `load_sharing` of many machines, TOGETHER of them integrated side by side, which is faster.

    Parameters
    ----------
    cases : sequence of tuple
        Machine or reduced model, and its pinion speed in rpm.
    settings : Settings
        Settings of the integration; its window and samples are replaced by those of the options.
    options : SharingOptions
        Cycles, samples, number of starts and confidence.
    start : int
        Index of the starting state that counts; 0 is static equilibrium.

    Returns
    -------
    list of Sharing
        One entry for each case, in order.

    Raises
    ------
    NotConverged
        If an integration fails.
    """
    settings = replace(settings, window=options.cycles, samples=options.samples)
    runs = [
        _Run(build_model(machine) if isinstance(machine, Machine) else machine, speed, settings, options)
        for machine, speed in cases
    ]
    results: list[Sharing] = []
    for first in range(0, len(runs), TOGETHER):
        results += _side_by_side(runs[first : first + TOGETHER], start)
    return results


@dataclass(frozen=True, eq=False)
class _Run:
    """A machine at a speed in rpm that runs from several starts."""

    model: Model
    speed_rpm: float
    settings: Settings
    options: SharingOptions

    def motion(self, state: State) -> RunPlan[SteadyState]:
        """Return the plan (a generator of runs, see `facegear.motion.requests`) of the motion from
        `state`, over which the averages are taken.
        """
        return steady_motion(self.model, self.speed_rpm, self.settings, self.options, state)

    def motion_from_start(self, state: State, orbit: KnownOrbit | None) -> RunPlan[SteadyState | None]:
        """Plan the motion from another start, sampled at most SAMPLES times a cycle, of which only the
        mean is used.

        The plan's result is None where the motion comes to the given orbit, already known from the start
        that counts.
        """
        coarse = replace(self.settings, samples=min(SAMPLES, self.options.samples))
        window_settings = watched_for(coarse, self.options, FIRST_WINDOW)
        first_window = yield from start_run(
            self.model, self.speed_rpm, window_settings, state, known_orbit=orbit
        )
        return (
            None
            if first_window.is_known_orbit
            else (yield from follow_first_window(self.model, first_window, coarse, self.options))
        )

    def stored_orbit(self, response: SteadyState) -> KnownOrbit | None:
        """Return the orbit of a periodic response for recognizing it in motions from other starts; None
        if there is none.
        """
        precision = self.settings.tolerance, self.settings.order
        return known_orbit(Integrator(response.system, response.frequency, *precision), response.orbit)

    def sharing(self, response: SteadyState, start_responses: list[SteadyState | None]) -> Sharing:
        """Combine the motion that counts with the motions from the other starts into the result.

        `start_responses` has an entry for each other start, None where it came to the same orbit. Means
        of motions that are not on the same orbit widen the range over starts; those of an irregular
        motion of the same class may widen the half-width.
        """
        groups = split_groups(self.model.machine.layout)
        elsewhere = [
            response_of_start
            for response_of_start in start_responses
            if response_of_start is not None and not same_orbit(response, response_of_start)
        ]
        means = [_means(densely_sampled(response_of_start), groups) for response_of_start in elsewhere]
        again = [
            mean
            for response_of_start, mean in zip(elsewhere, means, strict=True)
            if response.motion is not Motion.PERIODIC and response_of_start.label == response.label
        ]
        dense = densely_sampled(response)
        group_results = tuple(
            _group(dense, group, self.options, [mean[i] for mean in means], [mean[i] for mean in again])
            for i, group in enumerate(groups)
        )
        return Sharing(
            dense,
            group_results,
            tuple((response_of_start or response).label for response_of_start in (None, *start_responses)),
        )


def _side_by_side(runs: Sequence[_Run], start: int) -> list[Sharing]:
    """Compute the sharing of each run: first the motions from starting state number `start`, all side by
    side, then the motions from the other starting states.
    """
    states = [starting_states(run.model, run.options, max(run.options.starts, start + 1)) for run in runs]
    responses = side_by_side(
        [run.motion(run_states[start]) for run, run_states in zip(runs, states, strict=True)]
    )
    plans, counts = [], []
    for run, run_states, response in zip(runs, states, responses, strict=True):
        orbit = run.stored_orbit(response)
        start_states = [
            state for number, state in enumerate(run_states[: run.options.starts]) if number != start
        ]
        plans += [run.motion_from_start(state, orbit) for state in start_states]
        counts.append(len(start_states))
    motions = iter(side_by_side(plans))
    return [
        run.sharing(response, list(islice(motions, count)))
        for run, response, count in zip(runs, responses, counts, strict=True)
    ]


def measured_motion(
    model: Model, speed_rpm: float, settings: Settings, options: SharingOptions, guide: Guide | None = None
) -> DenseMotion:
    """Compute the motion from static equilibrium as `load_sharing` does, without other starts and averages.

    Parameters
    ----------
    model : Model
        Reduced model of the machine.
    speed_rpm : float
        Speed of the pinions, rpm.
    settings : Settings
        Settings of the integration; its window and samples are replaced by those of the options.
    options : SharingOptions
        Mesh cycles and samples of a cycle.
    guide : Guide or None
        Orbit of a similar machine, from which the search starts; None: from static equilibrium alone.

    Returns
    -------
    DenseMotion
        Densely sampled motion, SI units.

    Raises
    ------
    NotConverged
        If the integration fails.
    """
    settings = replace(settings, window=options.cycles, samples=options.samples)
    start = static_start(model)
    return densely_sampled(alone(steady_motion(model, speed_rpm, settings, options, start, guide)))


def starting_states(model: Model, options: SharingOptions, count: int) -> list[State]:
    """Return the first starting states: static equilibrium, then static equilibrium disturbed at random.

    Parameters
    ----------
    model : Model
        Reduced model of the machine.
    options : SharingOptions
        Standard deviation (m) and seed of the disturbance: equal options give equal states.
    count : int
        Number of states, at least 1.

    Returns
    -------
    list of State
        In the reduced coordinates of the model, SI units.
    """
    rest, random = static_start(model), np.random.default_rng(options.seed)
    return [rest, *(disturb(model, rest, options.spread, random) for _ in range(count - 1))]


def steady_motion(
    model: Model,
    speed_rpm: float,
    settings: Settings,
    options: SharingOptions,
    start: State,
    guide: Guide | None = None,
) -> RunPlan[SteadyState]:
    """Plan the search for the steady motion from a start; one that does not become periodic is measured
    as it is.

    Parameters
    ----------
    model : Model
        Reduced model of the machine.
    speed_rpm : float
        Speed of the pinions, rpm.
    settings : Settings
        Settings of the integration; its longest run is limited to FIRST_WINDOW times the cycles averaged.
    options : SharingOptions
        Number of cycles that are averaged.
    start : State
        Starting state.
    guide : Guide or None
        Orbit of a similar machine, from which the search starts.

    Returns
    -------
    RunPlan[SteadyState]
        Generator of runs whose result is the response; `facegear.motion.requests.alone` runs it.
    """
    first_window = yield from start_run(
        model, speed_rpm, watched_for(settings, options, FIRST_WINDOW), start, guide
    )
    return (yield from follow_first_window(model, first_window, settings, options))


def follow_first_window(
    model: Model, motion: StartedRun, settings: Settings, options: SharingOptions
) -> RunPlan[SteadyState]:
    """Continue a motion after its first window until it is classified; a quasi-periodic one gets a longer
    window.

    A body that is pushed through its backlash for long, or an orbit that is approached slowly, looks like a
    torus for a while. A class that must hold for good, as that of the response at the nominal speed,
    therefore needs a longer window: TORUS_WINDOW times the cycles averaged.

    Parameters
    ----------
    model : Model
        Reduced model of the machine.
    motion : StartedRun
        Motion after its first window.
    settings : Settings
        Settings of the integration.
    options : SharingOptions
        Number of cycles that are averaged.

    Returns
    -------
    RunPlan[SteadyState]
        Generator of runs whose result is the response; its `periods_run` counts both windows.
    """
    state = yield from motion.follow()
    if state.motion is not Motion.QUASI_PERIODIC:
        return state
    longer = watched_for(settings, options, TORUS_WINDOW)
    again = yield from simulating(model, motion.speed_rpm, longer, state.state)
    return replace(again, periods_run=state.periods_run + again.periods_run)


def watched_for(settings: Settings, options: SharingOptions, times: int) -> Settings:
    """Return settings whose longest run is `times` the cycles averaged, and no longer than it was.

    Parameters
    ----------
    settings : Settings
        Settings of the integration.
    options : SharingOptions
        Number of mesh cycles that are averaged.
    times : int
        Factor on that number, dimensionless.

    Returns
    -------
    Settings
        The same settings with `settle` (mesh periods) reduced where it was larger.
    """
    return replace(settings, settle=min(settings.settle, times * options.cycles))


def disturb(model: Model, start: State, spread: float, random: np.random.Generator) -> State:
    """Return a starting state with normally distributed displacements of the bodies added; speeds stay.

    The displacements are projected on the modes of the reduced model.

    Parameters
    ----------
    model : Model
        Reduced model of the machine.
    start : State
        Starting state.
    spread : float
        Standard deviation of the displacements, m; rotations count at the mesh radius.
    random : np.random.Generator
        Random number generator, which this call advances.

    Returns
    -------
    State
        Reduced coordinates, SI units.
    """
    linear = model.machine.linear
    displacements = spread * random.normal(size=linear.size) / linear.lengths
    return replace(
        start, displacement=start.displacement + model.reduction.basis.T @ linear.momentum(displacements)
    )
