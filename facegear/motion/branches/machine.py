"""Branches of a machine over its speed: the computations of the branches stage, from its plan."""

from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np

from facegear.arrays import Array
from facegear.errors import NotConverged
from facegear.motion.branches.continuation import Branch, ContinuationSettings
from facegear.motion.branches.explore import SettledMotion, explore
from facegear.motion.branches.family import machine_plane, speed_family
from facegear.motion.branches.loci import Locus, LocusRun, follow_locus
from facegear.motion.branches.margins import StabilityLimit, stability_limits
from facegear.motion.branches.motion_arrays import SweptMotion
from facegear.motion.branches.period_map import PeriodMap
from facegear.motion.branches.points import BranchPoint, at_parameter
from facegear.motion.branches.special import Kind
from facegear.motion.branches.survey import Survey, survey
from facegear.motion.plan import BranchPlan, Settings
from facegear.motion.steady_state.simulate import Model, simulate, static_start
from facegear.number_format import count_noun

SAME_POINT = 1e-4
"""Difference of the logarithm of the speed below which two special points start one locus."""
TRIES = 12
"""Number of speeds, spaced geometrically over the range, that are tried after the nominal one."""
SETTLING = Settings(tolerance=1e-6, settle=256, window=64, extensions=1)
"""Settings of runs that need only come near to a motion; Newton's method refines the orbit afterwards."""


def plan_range(plan: BranchPlan) -> ContinuationSettings:
    """Return the speed range of a plan as settings of the continuation.

    Parameters
    ----------
    plan : BranchPlan
        What to compute; speeds in rpm.

    Returns
    -------
    ContinuationSettings
        Range in rpm, default steps.
    """
    return ContinuationSettings(plan.from_rpm, plan.to_rpm)


def machine_period_map(model: Model, plan: BranchPlan) -> PeriodMap:
    """Return the period map of a machine over its speed in rpm.

    Parameters
    ----------
    model : Model
        Reduced machine.
    plan : BranchPlan
        What to compute; speeds in rpm.

    Returns
    -------
    PeriodMap
        Map over one mesh period at the plan's tolerance.
    """
    return PeriodMap(speed_family(model), 1, plan.tolerance)


def first_orbit(model: Model, plan: BranchPlan) -> BranchPoint:
    """Find a motion of period one: at the nominal speed, else at the first of TRIES speeds where a run
    from rest settles on it. The speeds are spaced geometrically over the plan's range.

    Parameters
    ----------
    model : Model
        Reduced machine.
    plan : BranchPlan
        What to compute; speeds in rpm.

    Returns
    -------
    BranchPoint
        Orbit of period one.

    Raises
    ------
    NotConverged
        If no run settles on such a motion.
    """
    period_map = machine_period_map(model, plan)
    speeds = [plan.nominal_rpm, *np.geomspace(plan.from_rpm, plan.to_rpm, TRIES + 1)[1:]]
    for speed in speeds:
        if not plan.from_rpm <= speed <= plan.to_rpm:
            continue
        response = simulate(model, speed, SETTLING)
        if response.period != 1:
            continue
        u = float(np.log(speed))
        try:
            return at_parameter(period_map, period_map.to_weighted(response.state, u), u)
        except NotConverged:
            continue
    speed_list = ", ".join(f"{speed:.6g}" for speed in speeds)
    raise NotConverged("branches", f"{speed_list} rpm", "no run from rest settles on a motion of period one")


def random_starts(
    model: Model, plan: BranchPlan, speed_rpm: float, step: Callable[[], None] = lambda: None
) -> list[SettledMotion]:
    """Run random starts around the static equilibrium at a speed, see scattered(), and return the motions
    on which they end.

    Parameters
    ----------
    model : Model
        Reduced machine.
    plan : BranchPlan
        What to compute; speeds in rpm.
    speed_rpm : float
        Pinion speed, rpm.
    step : callable
        Called without arguments after each start.

    Returns
    -------
    list of SettledMotion
        Motions, the most frequent first.
    """
    period_map, u = machine_period_map(model, plan), float(np.log(speed_rpm))
    rest, weights = (
        period_map.to_weighted(static_start(model), u),
        period_map.weights(period_map.integrator(u)),
    )
    offsets = scattered(model, plan.spread, plan.starts, plan.seed)
    return explore(period_map, speed_rpm, rest + weights * offsets.reshape(plan.starts, -1), SETTLING, step)


def scattered(model: Model, spread: float, count: int, seed: int) -> Array:
    """Draw random offsets of positions and velocities by mesh phase in the model's coordinates.

    Displacements of the bodies, and rotations at the mesh radius, are uniform between -spread and spread. The
    part that the reduction neglects is left out. So the starts do not depend on the basis of the reduction.

    Parameters
    ----------
    model : Model
        Reduced machine.
    spread : float
        Half width of the distribution, m.
    count : int
        Number of starts.
    seed : int
        Seed of the random numbers, any number.

    Returns
    -------
    (count, 2, n) array
        Displacements and their derivatives by phase in reduced coordinates, m.
    """
    linear = model.machine.linear
    random = np.random.default_rng(seed).uniform(-1.0, 1.0, size=(count, 2, linear.size))
    return spread * random / linear.lengths @ linear.momentum(model.reduction.basis)


def machine_survey(
    model: Model,
    plan: BranchPlan,
    motions_by_speed: Sequence[tuple[float, Sequence[SettledMotion]]],
    sweep_motions: Sequence[SweptMotion],
    progress: Callable[[str], None] = lambda text: None,
) -> Survey:
    """Compute all branches of a machine.

    They are those of period one, those that leave them, and those of motions that were found elsewhere.
    Motions that are not periodic, or longer than the plan's longest_start_period, are left out.

    Parameters
    ----------
    model : Model
        Reduced machine.
    plan : BranchPlan
        What to compute; speeds in rpm.
    motions_by_speed : sequence of tuple
        Speed in rpm, and the motions on which random starts end there.
    sweep_motions : sequence of SweptMotion
        Periodic motions of a sweep.
    progress : callable
        Called with one line of text about each step.

    Returns
    -------
    Survey
        Branches, and motions that were not followed.
    """
    start, period_map = first_orbit(model, plan), machine_period_map(model, plan)
    motions = [
        (motion.point, motion.period, f"random starts, {speed:.6g} rpm")
        for speed, motions_at_speed in motions_by_speed
        for motion in motions_at_speed
    ] + [(motion.point, motion.period, motion.origin) for motion in sweep_motions]
    short = [
        (period_map.over(period), point, origin)
        for point, period, origin in motions
        if point is not None and period <= plan.longest_start_period
    ]
    return survey(
        (period_map, start), short, plan_range(plan), plan.longest_period, plan.max_branches, progress
    )


def margins(model: Model, plan: BranchPlan, branches: Sequence[Branch]) -> list[StabilityLimit]:
    """Find how far every stable motion at the nominal speed is from its end, in speed and in torque.

    Parameters
    ----------
    model : Model
        Reduced machine.
    plan : BranchPlan
        What to compute; speeds in rpm.
    branches : sequence of Branch
        Branches followed.

    Returns
    -------
    list of StabilityLimit
        Limits upwards and downwards in speed (rpm) and in the factor on all torques.
    """
    speed = plan.nominal_rpm
    across = machine_plane(model, "torque").across(speed)
    families = [
        (speed_family(model), speed, plan_range(plan)),
        (across, 1.0, ContinuationSettings(*plan.factors)),
    ]
    return stability_limits(branches, families, speed)


def machine_loci(
    model: Model,
    plan: BranchPlan,
    specials: Sequence[tuple[PeriodMap, Kind, Array]],
    progress: Callable[[str], None] = lambda text: None,
) -> tuple[list[Locus], list[str]]:
    """Follow the loci of the folds and period doublings nearest to the nominal speed, in each parameter of
    the plan.

    Special points through which an earlier locus passes are left out.

    Parameters
    ----------
    model : Model
        Reduced machine.
    plan : BranchPlan
        What to compute; speeds in rpm.
    specials : sequence of tuple
        Period map, kind and x (2 n + 1,) of each special point.
    progress : callable
        Called with one line of text about each step.

    Returns
    -------
    list of Locus
        Loci found.
    list of str
        One line for each locus that could not be followed, with the reason.
    """
    nearest = sorted(specials, key=lambda candidate: abs(np.exp(candidate[2][-1]) - plan.nominal_rpm))[
        : plan.nearest
    ]
    loci: list[Locus] = []
    failures: list[str] = []
    for parameter in plan.parameters:
        plane = machine_plane(model, parameter)
        run = LocusRun((plan.from_rpm, plan.factors[0]), (plan.to_rpm, plan.factors[1]))
        points_on_loci: list[tuple[int, float]] = []
        for period_map, kind, x in nearest:
            if any(
                period_map.period == period and abs(x[-1] - u) < SAME_POINT for period, u in points_on_loci
            ):
                continue
            try:
                locus = follow_locus(plane, 1.0, kind, x, period_map, run)
            except NotConverged as error:
                failures.append(f"{kind} at {np.exp(x[-1]):.6g} rpm over {parameter}: {error}")
                progress(failures[-1])
                continue
            loci.append(locus)
            points = count_noun(len(locus.points), "point")
            progress(f"{kind} at {np.exp(x[-1]):.6g} rpm over {parameter}: {points}")
            points_on_loci += [(period_map.period, u) for u in _at_speed(locus)]
    return loci, failures


def _at_speed(locus: Locus) -> list[float]:
    """Return the logarithms of the speeds at which a locus passes the factor 1, where the machine is the
    given one.

    They are interpolated linearly between its points.
    """
    x = np.array([point.x[-2:] for point in locus.points])
    special_points_at = []
    for a, b in pairwise(x):
        if a[1] * b[1] <= 0.0 and a[1] != b[1]:
            special_points_at.append(float(a[0] + (b[0] - a[0]) * a[1] / (a[1] - b[1])))
    return special_points_at
