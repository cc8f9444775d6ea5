"""Branches of periodic motions: error against tolerance, and what an orbit costs against settling."""

import time
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.machine.machine import Machine
from facegear.motion.branches.continuation import Branch, ContinuationSettings, follow, reverse_tangent
from facegear.motion.branches.explore import crossings
from facegear.motion.branches.family import Family, speed_family
from facegear.motion.branches.period_map import PeriodMap
from facegear.motion.branches.points import BranchPoint, at_parameter
from facegear.motion.branches.special import Kind
from facegear.motion.integrator.system import System
from facegear.motion.plan import Settings, State
from facegear.motion.steady_state.simulate import Model, build_model, simulate, static_start, steady_state
from validation.dynamics.oscillators import Oscillator

TOLERANCES = (1e-4, 1e-6, 1e-8, 1e-10, 1e-12)
"""Local tolerances that are compared, relative."""
REFERENCE = 1e-13
"""Tolerance of the reference run of the machine, relative."""
EXACT_POINTS = (
    (Kind.FOLD, 0.828463984388),
    (Kind.GRAZE, 0.820631087712),
    (Kind.FOLD, 0.708031618722),
    (Kind.GRAZE, 1.407088466023),
)
"""Special points of x'' + 0.1 x' + f(x) = 0.1 + 0.05 W^2 cos W t over W, in closed-form pieces, 50 digits."""
EXACT_STATE = (1.2287262208378, 0.1646816908020)
EXACT_MULTIPLIERS = (1.7871104711, 0.2421112145)
"""Displacement, velocity and Floquet multipliers of the unstable orbit at W = 0.75."""
ERRORS = ((1.0, 1.0), (0.1, 1.2))
"""Factors on the machine's error and on its nominal speed: as it is, and where it stays stable undamped."""
DAMPING = (1.0, 0.3, 0.1, 0.03, 0.01)
"""Factors on all damping."""
TOLERANCE = 1e-8
"""Tolerance of the runs whose cost is measured, relative."""
BLOCK = 32
"""Mesh periods between two checks of plain running."""
SETTLED_CHANGE = 1e-6
"""Change over a mesh period, in length scales, at which plain running counts as settled."""
REPEATS = 5
"""Number of runs whose time is averaged."""
MAX_PERIODS = 100_000
"""Largest number of mesh periods of plain running."""


@dataclass(frozen=True, eq=False)
class Case:
    """A family, the run that follows one of its branches, and the parameter value at which an orbit of it is
    compared.
    """

    name: str
    family: Family
    begin: Callable[[PeriodMap], BranchPoint]
    run: ContinuationSettings
    value: float


def oscillator_case() -> Case:
    """Return the oscillator with exact answers.

    Returns
    -------
    Case
        The case.
    """
    family = Family("W", lambda speed: (Oscillator(0.05, 0.1, 0.05, speed, 0.0, 0.0).system, speed))
    return Case(
        "oscillator",
        family,
        lambda period_map: at_parameter(period_map, np.array([1.1, 0.0]), float(np.log(0.3))),
        ContinuationSettings(0.25, 2.6),
        0.75,
    )


def machine_case(machine: Machine, speed_rpm: float) -> Case:
    """Return the branch through the motion at a speed, from 0.9 to 1.3 times that speed.

    Parameters
    ----------
    machine : Machine
        The machine.
    speed_rpm : float
        Speed of the pinion, rpm.

    Returns
    -------
    Case
        The case.
    """
    model = build_model(machine)
    state = simulate(model, speed_rpm, Settings(tolerance=1e-8)).state
    u = float(np.log(speed_rpm))
    return Case(
        "machine",
        speed_family(model),
        lambda period_map: at_parameter(period_map, period_map.to_weighted(state, u), u),
        ContinuationSettings(0.9 * speed_rpm, 1.3 * speed_rpm),
        1.05 * speed_rpm,
    )


def accuracy(machine: Machine, speed_rpm: float, step: Callable[[], None] = lambda: None) -> pd.DataFrame:
    """Measure the error against the tolerance.

    Columns case, tolerance, points, seconds, special_points, same_list (whether the kinds of the special
    points come in the same order as in the reference), fold_error, other_error, graze_error (largest relative
    error of the parameter), orbit_error (over the length scale) and multiplier_error (of the leading two) of
    the unstable orbit at one value.

    The oscillator is compared with exact answers, the machine with a run at a tolerance of 1e-13.

    Parameters
    ----------
    machine : Machine
        The machine.
    speed_rpm : float
        Speed of the pinion, rpm.
    step : Callable[[], None]
        Called after each tolerance.

    Returns
    -------
    DataFrame
        One row for each case and tolerance.
    """
    rows = []
    for case in (oscillator_case(), machine_case(machine, speed_rpm)):
        exact = None if case.name == "machine" else _exact()
        reference = exact or _read_answers(case, _follow_case(case, REFERENCE)[0])
        for tolerance in TOLERANCES:
            branch, seconds = _follow_case(case, tolerance)
            answers = _read_answers(case, branch)
            rows.append(
                {
                    "case": case.name,
                    "tolerance": tolerance,
                    "points": len(branch.points),
                    "seconds": seconds,
                    "special_points": len(branch.specials),
                    **_errors(answers, reference),
                }
            )
            step()
    return pd.DataFrame(rows)


@dataclass(frozen=True, eq=False)
class _Answers:
    kinds: list[Kind]
    values: Array
    state: Array
    multipliers: Array


def _exact() -> _Answers:
    kinds, values = [kind for kind, _ in EXACT_POINTS], [value for _, value in EXACT_POINTS]
    state, velocity = EXACT_STATE
    return _Answers(kinds, np.array(values), np.array([state, velocity / 0.75]), np.array(EXACT_MULTIPLIERS))


def _follow_case(case: Case, tolerance: float) -> tuple[Branch, float]:
    period_map = PeriodMap(case.family, 1, tolerance)
    start = case.begin(period_map)
    begin = time.process_time()
    branch = follow(period_map, start, case.run)
    return branch, time.process_time() - begin


def _read_answers(case: Case, branch: Branch) -> _Answers:
    orbits = crossings(branch, case.value)
    unstable_orbit = next((orbit for orbit in orbits if not orbit.stable), orbits[0])
    return _Answers(
        [special.kind for special in branch.specials],
        np.array([special.point.value for special in branch.specials]),
        unstable_orbit.z,
        np.abs(unstable_orbit.multipliers[:2]),
    )


def _errors(answers_found: _Answers, reference: _Answers) -> dict[str, float | bool]:
    """Relative errors of each kind in its own order along the branch, whichever end that began at."""
    errors: dict[str, float | bool] = {"same_list": _in_order(answers_found) == _in_order(reference)}
    for name, kinds in (
        ("fold_error", (Kind.FOLD,)),
        ("other_error", (Kind.DOUBLING, Kind.TORUS, Kind.BRANCH)),
        ("graze_error", (Kind.GRAZE,)),
    ):
        values, exact_values = (_values(answers, kinds) for answers in (answers_found, reference))
        is_comparable = values.size == exact_values.size > 0
        errors[name] = float(np.abs(values / exact_values - 1.0).max()) if is_comparable else np.nan
    errors["orbit_error"] = float(np.abs(answers_found.state - reference.state).max())
    errors["multiplier_error"] = float(np.abs(answers_found.multipliers - reference.multipliers).max())
    return errors


def _in_order(answers: _Answers) -> list[Kind]:
    return [answers.kinds[i] for i in np.argsort(answers.values)]


def _values(answers: _Answers, kinds: tuple[Kind, ...]) -> Array:
    return np.sort([v for v, kind in zip(answers.values, answers.kinds, strict=True) if kind in kinds])


def costs(machine: Machine, speed_rpm: float, step: Callable[[], None] = lambda: None) -> pd.DataFrame:
    """Compare the cost of an orbit by continuation with that of settling, where all damping is multiplied by
    a factor.

    Once with the machine's error and once with a tenth of it, where contact is kept; both from the orbit at a
    speed 0.5 % lower, at a local tolerance of 1e-8. Columns error_factor, damping_factor, speed_rpm,
    leading_multiplier, orbit_seconds (the orbit with its multipliers by Newton's method), point_seconds (a
    point of the branch within 2 % of the speed, refused steps and location of special points included),
    settling_periods and settling_seconds (plain running until a period moves it by 1e-6 length scales),
    settled (whether that happens within 100 000 periods), steady_state_seconds (our own search, which ends
    with Newton's method), ratio of plain settling to orbit_seconds.

    Parameters
    ----------
    machine : Machine
        The machine.
    speed_rpm : float
        Speed of the pinion, rpm.
    step : Callable[[], None]
        Called after each factor.

    Returns
    -------
    DataFrame
        One row for each error factor and damping factor.
    """
    model = build_model(machine)
    rows = []
    for error, part in ERRORS:
        smooth = replace(model, system=replace(model.system, error=error * model.system.error))
        speed = part * speed_rpm
        orbits = _orbits(smooth, speed)
        for factor in DAMPING:
            if factor in orbits:
                damped_model = replace(smooth, system=_scale_damping(smooth.system, factor))
                rows.append({"error_factor": error, **_cost(damped_model, factor, speed, orbits[factor])})
            step()
    return pd.DataFrame(rows)


def _scale_damping(system: System, factor: float) -> System:
    return replace(system, damping=factor * system.damping, mesh_damping=factor * system.mesh_damping)


def _orbits(model: Model, speed_rpm: float) -> dict[float, State]:
    """Return the orbit at a speed, carried on to less and less damping by continuation in the factor."""
    system, frequency = speed_family(model).at(speed_rpm)
    period_map = PeriodMap(
        Family("damping_factor", lambda factor: (_scale_damping(system, factor), frequency)), 1, TOLERANCE
    )
    state = steady_state(system, frequency, Settings(tolerance=TOLERANCE), static_start(model)).state
    start = at_parameter(period_map, period_map.to_weighted(state, 0.0), 0.0)
    branch = follow(
        period_map, reverse_tangent(start), ContinuationSettings(0.99 * DAMPING[-1], 1.0), both_ways=False
    )
    states = {1.0: state}
    for factor in DAMPING[1:]:
        for point in crossings(branch, factor)[:1]:
            states[factor] = period_map.state(point.z, point.u)
    return states


def _cost(model: Model, factor: float, speed_rpm: float, state: State) -> dict[str, float | bool]:
    period_map = PeriodMap(speed_family(model), 1, TOLERANCE)
    u = float(np.log(speed_rpm))
    start = at_parameter(period_map, period_map.to_weighted(state, u), u)
    begin = time.process_time()
    branch = follow(period_map, start, ContinuationSettings(0.98 * speed_rpm, 1.02 * speed_rpm))
    point_seconds = (time.process_time() - begin) / len(branch.points)
    beside = at_parameter(period_map, start.z, float(np.log(0.995 * speed_rpm))).z
    begin = time.process_time()
    for _ in range(REPEATS):
        orbit = at_parameter(period_map, beside, u)
    orbit_seconds = (time.process_time() - begin) / REPEATS
    periods, seconds, is_settled = _plain(period_map, beside, u)
    begin = time.process_time()
    system, frequency = period_map.family.at(speed_rpm)
    steady_state(system, frequency, Settings(tolerance=TOLERANCE), period_map.state(beside, u))
    search_seconds = time.process_time() - begin
    return {
        "damping_factor": factor,
        "speed_rpm": speed_rpm,
        "leading_multiplier": float(np.abs(orbit.multipliers[0])),
        "orbit_seconds": orbit_seconds,
        "point_seconds": point_seconds,
        "settling_periods": periods,
        "settling_seconds": seconds,
        "settled": is_settled,
        "steady_state_seconds": search_seconds,
        "ratio": seconds / orbit_seconds if is_settled else np.nan,
    }


def _plain(period_map: PeriodMap, z: Array, u: float) -> tuple[int, float, bool]:
    """Count periods and seconds of plain running from z until the state hardly changes over a period."""
    block, begin = period_map.over(BLOCK), time.process_time()
    for count in range(1, MAX_PERIODS // BLOCK + 1):
        z = z + block.gap(z, u)
        if np.abs(period_map.gap(z, u)).max() < SETTLED_CHANGE:
            return count * BLOCK, time.process_time() - begin, True
    return MAX_PERIODS, time.process_time() - begin, False
