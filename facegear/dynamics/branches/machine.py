"""The branches of a machine over its speed: what the stage asks for, from a plan."""

from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.branches.continuation import Branch, Run
from facegear.dynamics.branches.explore import Found, box, explore
from facegear.dynamics.branches.family import machine_plane, speed_family
from facegear.dynamics.branches.loci import Locus, LocusRun, follow_locus
from facegear.dynamics.branches.margins import Loss, losses
from facegear.dynamics.branches.period_map import PeriodMap
from facegear.dynamics.branches.plan import BranchPlan
from facegear.dynamics.branches.points import Point, at_parameter
from facegear.dynamics.branches.special import Kind
from facegear.dynamics.branches.survey import Survey, survey
from facegear.dynamics.branches.swept import Swept
from facegear.dynamics.motion import Settings
from facegear.dynamics.steady_state.simulate import Model, simulate, static_start
from facegear.errors import NotConverged

TRIES = 12
SETTLING = Settings(tolerance=1e-6, settle=256, window=64, extensions=1)


def plan_range(plan: BranchPlan) -> Run:
    """Range of the branches."""
    return Run(plan.from_rpm, plan.to_rpm)


def machine_flow(model: Model, plan: BranchPlan) -> PeriodMap:
    """The map of a machine over its speed in rpm."""
    return PeriodMap(speed_family(model), 1, plan.tolerance)


def first_orbit(model: Model, plan: BranchPlan) -> Point:
    """A motion of period one: at the nominal speed, else at the first of TRIES speeds where a run settles on
    one. Raises NotConverged if there is none.
    """
    flow = machine_flow(model, plan)
    speeds = [plan.nominal_rpm, *np.geomspace(plan.from_rpm, plan.to_rpm, TRIES + 1)[1:]]
    for speed in speeds:
        if not plan.from_rpm <= speed <= plan.to_rpm:
            continue
        response = simulate(model, speed, SETTLING)
        if response.period != 1:
            continue
        u = float(np.log(speed))
        try:
            return at_parameter(flow, flow.weighted(response.state, u), u)
        except NotConverged:
            continue
    tried = ", ".join(f"{speed:.6g}" for speed in speeds)
    raise NotConverged("branches", f"{tried} rpm", "no run from rest settles on a motion of period one")


def random_starts(
    model: Model, plan: BranchPlan, speed_rpm: float, step: Callable[[], None] = lambda: None
) -> list[Found]:
    """Motions on which random starts around rest end at a speed."""
    flow = machine_flow(model, plan)
    rest = flow.weighted(static_start(model), float(np.log(speed_rpm)))
    half = np.full(rest.size, plan.spread / model.system.scale)
    starts = box(flow, speed_rpm, rest, half, plan.starts, plan.seed)
    return explore(flow, speed_rpm, starts, SETTLING, step)


def machine_survey(
    model: Model,
    plan: BranchPlan,
    found: Sequence[tuple[float, Sequence[Found]]],
    swept: Sequence[Swept],
    progress: Callable[[str], None] = lambda text: None,
) -> Survey:
    """All branches of a machine: of period one, those that leave it, and those of motions found elsewhere.

    found: motions of random starts at some speeds; swept: those of a sweep.
    """
    start, flow = first_orbit(model, plan), machine_flow(model, plan)
    motions = [
        (one.point, one.period, f"random starts, {speed:.6g} rpm") for speed, many in found for one in many
    ] + [(one.point, one.period, one.origin) for one in swept]
    short = [
        (flow.over(period), point, origin)
        for point, period, origin in motions
        if point is not None and period <= plan.longest_found
    ]
    return survey((flow, start), short, plan_range(plan), plan.longest_period, plan.most_branches, progress)


def margins(model: Model, plan: BranchPlan, branches: Sequence[Branch]) -> list[Loss]:
    """How far every stable motion at the nominal speed is from its end, in speed and in torque."""
    speed = plan.nominal_rpm
    across = machine_plane(model, "torque").across(speed)
    families = [
        (speed_family(model), speed, plan_range(plan)),
        (across, 1.0, Run(*plan.factors)),
    ]
    return losses(branches, families, speed)


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
    nearest = sorted(specials, key=lambda one: abs(np.exp(one[2][-1]) - plan.nominal_rpm))[: plan.nearest]
    loci: list[Locus] = []
    missed: list[str] = []
    for parameter in plan.parameters:
        plane = machine_plane(model, parameter)
        run = LocusRun((plan.from_rpm, plan.factors[0]), (plan.to_rpm, plan.factors[1]))
        passed: list[tuple[int, float]] = []
        for flow, kind, x in nearest:
            if any(flow.period == period and abs(x[-1] - u) < 1e-4 for period, u in passed):
                continue
            try:
                locus = follow_locus(plane, 1.0, kind, x, flow, run)
            except NotConverged as error:
                missed.append(f"{kind} at {np.exp(x[-1]):.6g} rpm over {parameter}: {error}")
                progress(missed[-1])
                continue
            loci.append(locus)
            progress(f"{kind} at {np.exp(x[-1]):.6g} rpm over {parameter}: {len(locus.points)} points")
            passed += [(flow.period, u) for u in _at_one(locus)]
    return loci, missed


def _at_one(locus: Locus) -> list[float]:
    """Logarithms of the speed at which a locus passes the machine as it is."""
    x = np.array([point.x[-2:] for point in locus.points])
    found = []
    for a, b in pairwise(x):
        if a[1] * b[1] <= 0.0 and a[1] != b[1]:
            found.append(float(a[0] + (b[0] - a[0]) * a[1] / (a[1] - b[1])))
    return found
