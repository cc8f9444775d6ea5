"""Problems of the comparison: three regimes of a machine, other laws, and the oscillator (a)."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import StrEnum

from facegear.machine.machine import Machine, OpenFlanks, mesh_frequency
from facegear.motion.integrator.kernel_system import TAU
from facegear.motion.integrator.system import System
from facegear.motion.plan import Motion, Settings, State
from facegear.motion.steady_state.simulate import build_model, simulate, static_start
from validation.dynamics.oscillators import Oscillator

SAMPLES = 16
"""Samples of a mesh period."""
FACTORS = (1.0, 2.0, 1.5, 1.75, 2.5)
"""Factors on the speed at which irregular motion is searched, in this order."""
PERIODS, IRREGULAR_PERIODS = 24, 400
"""Mesh periods of regular and of irregular motion."""


class ComparedResult(StrEnum):
    """Result that is compared with the reference: deflections at every sample, their RMS, or the tangents'
    matrix.
    """

    DEFLECTIONS = "deflections"
    RMS = "rms"
    TANGENTS = "tangents"


@dataclass(frozen=True, eq=False)
class Problem:
    """Start, length in mesh periods, and the result that is compared."""

    name: str
    system: System
    frequency: float
    start: State
    periods: int
    compared_result: ComparedResult


def machine_problems(machine: Machine, speed_rpm: float) -> list[Problem]:
    """List three regimes of a machine.

    Contact kept (no backlash), contact lost on a stable orbit at 0.6 of the speed, and irregular motion at
    the first of FACTORS times the speed where there is any.

    Parameters
    ----------
    machine : Machine
        The machine.
    speed_rpm : float
        Speed of the pinion, rpm.

    Returns
    -------
    list[Problem]
        Two or three problems.
    """
    regular = replace(machine, half_backlash=0.0 * machine.half_backlash)
    problems = [
        _problem("contact kept", regular, speed_rpm, PERIODS, ComparedResult.DEFLECTIONS)[0],
        _problem("contact lost", machine, 0.6 * speed_rpm, PERIODS, ComparedResult.DEFLECTIONS)[0],
    ]
    for factor in FACTORS:
        name = f"irregular, {factor * speed_rpm:.0f} rpm"
        problem, motion = _problem(name, machine, factor * speed_rpm, IRREGULAR_PERIODS, ComparedResult.RMS)
        if motion is Motion.CHAOTIC:
            problems.append(problem)
            break
    return problems


def law_problems(machine: Machine, load_dependent: Machine, speed_rpm: float) -> list[Problem]:
    """List the problems of other laws: a damper in contact only, and a stiffness that depends on the load.

    Parameters
    ----------
    machine : Machine
        With a linear law; its damper is made to act in contact alone.
    load_dependent : Machine
        With a load-dependent law.
    speed_rpm : float
        Pinion speed, rpm; the former runs at 0.6 of it, where contact is lost.

    Returns
    -------
    list of Problem
        One for each law.
    """
    damping = replace(machine.damping, open_flanks=OpenFlanks.CONTACT_ONLY)
    in_contact = replace(machine, damping=damping)
    return [
        _problem("damper in contact only", in_contact, 0.6 * speed_rpm, PERIODS, ComparedResult.DEFLECTIONS)[
            0
        ],
        _problem("load-dependent law", load_dependent, speed_rpm, PERIODS, ComparedResult.DEFLECTIONS)[0],
    ]


def _problem(
    name: str, machine: Machine, speed_rpm: float, periods: int, compared_result: ComparedResult
) -> tuple[Problem, Motion]:
    model = build_model(machine)
    response = simulate(model, speed_rpm, Settings(settle=128, extensions=0), static_start(model))
    frequency = TAU * mesh_frequency(machine.layout, speed_rpm)
    return Problem(name, model.system, frequency, response.state, periods, compared_result), response.motion


def tangent_problems(problems: Sequence[Problem]) -> list[Problem]:
    """Return the map over one mesh period for each problem whose deflections are compared.

    Parameters
    ----------
    problems : Sequence[Problem]
        Problems of the comparison.

    Returns
    -------
    list[Problem]
        Problems of tangents.
    """
    return [
        replace(problem, name=f"{problem.name}, tangents", periods=1, compared_result=ComparedResult.TANGENTS)
        for problem in problems
        if problem.compared_result is ComparedResult.DEFLECTIONS
    ]


def oscillator_problem() -> Problem:
    """Return oracle (a) at W = 0.75 from a point off its upper orbit.

    Returns
    -------
    Problem
        The problem.
    """
    oscillator = Oscillator(0.05, 0.1, 0.05, speed=0.75, displacement=0.8, velocity=0.2)
    return Problem(
        "oracle (a)", oscillator.system, oscillator.speed, oscillator.start, 20, ComparedResult.DEFLECTIONS
    )
