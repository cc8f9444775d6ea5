"""The branches of a machine over its speed: what the stage asks for, from a plan."""

from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.branches.continuation import Branch, ContinuationSettings
from facegear.dynamics.branches.explore import SettledMotion, explore
from facegear.dynamics.branches.family import machine_plane, speed_family
from facegear.dynamics.branches.loci import Locus, LocusRun, follow_locus
from facegear.dynamics.branches.margins import StabilityLimit, stability_limits
from facegear.dynamics.branches.period_map import PeriodMap
from facegear.dynamics.branches.plan import BranchPlan
from facegear.dynamics.branches.points import BranchPoint, at_parameter
from facegear.dynamics.branches.special import Kind
from facegear.dynamics.branches.survey import Survey, survey
from facegear.dynamics.branches.swept import Swept
from facegear.dynamics.motion import Settings
from facegear.dynamics.steady_state.simulate import Model, simulate, static_start
from facegear.errors import NotConverged
from facegear.number_format import count_noun

TRIES = 12
SETTLING = Settings(tolerance=1e-6, settle=256, window=64, extensions=1)


def plan_range(plan: BranchPlan) -> ContinuationSettings:
    """Range of the branches."""
    return ContinuationSettings(plan.from_rpm, plan.to_rpm)


def machine_period_map(model: Model, plan: BranchPlan) -> PeriodMap:
    """The map of a machine over its speed in rpm."""
    return PeriodMap(speed_family(model), 1, plan.tolerance)


def first_orbit(model: Model, plan: BranchPlan) -> BranchPoint:
    """A motion of period one: at the nominal speed, else at the first of TRIES speeds where a run settles on
    one. Raises NotConverged if there is none.
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
            return at_parameter(period_map, period_map.weighted(response.state, u), u)
        except NotConverged:
            continue
    tried = ", ".join(f"{speed:.6g}" for speed in speeds)
    raise NotConverged("branches", f"{tried} rpm", "no run from rest settles on a motion of period one")


def random_starts(
    model: Model, plan: BranchPlan, speed_rpm: float, step: Callable[[], None] = lambda: None
) -> list[SettledMotion]:
    """Motions on which random starts around rest end at a speed."""
    period_map, u = machine_period_map(model, plan), float(np.log(speed_rpm))
    rest, weights = period_map.weighted(static_start(model), u), period_map.weights(period_map.integrator(u))
    moved = scattered(model, plan.spread, plan.starts, plan.seed)
    return explore(period_map, speed_rpm, rest + weights * moved.reshape(plan.starts, -1), SETTLING, step)


def scattered(model: Model, spread: float, count: int, seed: int) -> Array:
    """Random places and velocities by mesh phase in the model's coordinates, (count, 2, n).

    Displacements of the bodies, and rotations at the mesh radius, are spread evenly over -spread to spread
    (m), and what the model leaves out of them is left out: they are the same in whatever basis it has.
    """
    linear = model.machine.linear
    random = np.random.default_rng(seed).uniform(-1.0, 1.0, size=(count, 2, linear.size))
    return spread * random / linear.lengths @ linear.momentum(model.reduced.basis)


def machine_survey(
    model: Model,
    plan: BranchPlan,
    motions_by_speed: Sequence[tuple[float, Sequence[SettledMotion]]],
    swept: Sequence[Swept],
    progress: Callable[[str], None] = lambda text: None,
) -> Survey:
    """All branches of a machine: of period one, those that leave it, and those of motions found elsewhere.

    motions_by_speed: those of random starts; swept: those of a sweep.
    """
    start, period_map = first_orbit(model, plan), machine_period_map(model, plan)
    motions = [
        (motion.point, motion.period, f"random starts, {speed:.6g} rpm")
        for speed, many in motions_by_speed
        for motion in many
    ] + [(motion.point, motion.period, motion.origin) for motion in swept]
    short = [
        (period_map.over(period), point, origin)
        for point, period, origin in motions
        if point is not None and period <= plan.longest_start_period
    ]
    return survey(
        (period_map, start), short, plan_range(plan), plan.longest_period, plan.max_branches, progress
    )


def margins(model: Model, plan: BranchPlan, branches: Sequence[Branch]) -> list[StabilityLimit]:
    """How far every stable motion at the nominal speed is from its end, in speed and in torque."""
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
    """Loci of the folds and period doublings nearest to the nominal speed, for each parameter of the plan.

    Also why some could not be followed.

    specials: map, kind and x of each. Those that a locus found before passes already are left out.
    """
    nearest = sorted(specials, key=lambda candidate: abs(np.exp(candidate[2][-1]) - plan.nominal_rpm))[
        : plan.nearest
    ]
    loci: list[Locus] = []
    missed: list[str] = []
    for parameter in plan.parameters:
        plane = machine_plane(model, parameter)
        run = LocusRun((plan.from_rpm, plan.factors[0]), (plan.to_rpm, plan.factors[1]))
        passed: list[tuple[int, float]] = []
        for period_map, kind, x in nearest:
            if any(period_map.period == period and abs(x[-1] - u) < 1e-4 for period, u in passed):
                continue
            try:
                locus = follow_locus(plane, 1.0, kind, x, period_map, run)
            except NotConverged as error:
                missed.append(f"{kind} at {np.exp(x[-1]):.6g} rpm over {parameter}: {error}")
                progress(missed[-1])
                continue
            loci.append(locus)
            points = count_noun(len(locus.points), "point")
            progress(f"{kind} at {np.exp(x[-1]):.6g} rpm over {parameter}: {points}")
            passed += [(period_map.period, u) for u in _at_speed(locus)]
    return loci, missed


def _at_speed(locus: Locus) -> list[float]:
    """Logarithms of the speed at which a locus passes the machine as it is."""
    x = np.array([point.x[-2:] for point in locus.points])
    special_points_at = []
    for a, b in pairwise(x):
        if a[1] * b[1] <= 0.0 and a[1] != b[1]:
            special_points_at.append(float(a[0] + (b[0] - a[0]) * a[1] / (a[1] - b[1])))
    return special_points_at
