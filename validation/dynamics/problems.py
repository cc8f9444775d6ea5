"""Problems of the comparison: three regimes of a machine, other laws, and the oscillator (a)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import Any

from facegear.door.outputs import machine_of
from facegear.gearbox import Gearbox
from facegear.machine.machine import Machine, mesh_frequency
from facegear.meshing.power import PowerLaw
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

LAW_SPEED = 1.6
"""Factor on the speed of the example machine for other laws: 12 000 rpm, where contact is lost."""
OIL = {
    "oil": "polyol_ester_5_cst",
    "supply_temperature_c": 100,
    "pinion": {"ra_um": 0.3},
    "face_gear": {"ra_um": 0.3},
    "bulk": {"source": "cooling", "pinion_w_per_k": 60, "face_gear_w_per_k": 200},
    "friction": {"effect": "excitation"},
}
"""Section `lubrication` of a machine whose friction excites it."""
CLEARANCE_UM = 20.0
"""Radial clearance of the pinions' bearings, um."""
POWER: Mapping[str, float] = {"size": 6e10, "exponent": 1.5, "depth": 0.1, "level": 2e-6, "largest": 4e-4}
"""Hertz's law of a sphere, so stiff that contact is lost at LAW_SPEED; SI units."""


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


def law_machines(gearbox: Gearbox) -> dict[str, Machine]:
    """Return a machine with two flanks a mesh for each law and element beside the linear law.

    Parameters
    ----------
    gearbox : Gearbox
        The example machine, or another that has teeth and a transmission.

    Returns
    -------
    dict
        Machines by the name of the law or element.
    """
    linear = {"mesh_stiffness.mesh_law": "constant_load"}
    changes: dict[str, Mapping[str, Any]] = {
        "damper in contact only": linear,
        "load-dependent law": {},
        "flanks that only push": {**linear, "transmission.damping.open_flanks": "push_only"},
        "friction": {**linear, "lubrication": OIL},
        "bearing clearance": {**linear, "transmission.pinion.clearance_um": CLEARANCE_UM},
    }
    machines = {name: machine_of(gearbox.with_values(change)) for name, change in changes.items()}
    machine = machines["damper in contact only"]
    law = PowerLaw(**POWER, contacts=2 * len(machine.layout.meshes))
    return {**machines, "power law": replace(machine, law=law)}


def law_problems(machines: Mapping[str, Machine], speed_rpm: float) -> list[Problem]:
    """List one problem for each machine.

    Parameters
    ----------
    machines : mapping
        Machines by the name of their law or element.
    speed_rpm : float
        Pinion speed, rpm; one at which contact is lost.

    Returns
    -------
    list of Problem
        Problems in the order of the machines.
    """
    return [
        _problem(name, machine, speed_rpm, PERIODS, ComparedResult.DEFLECTIONS)[0]
        for name, machine in machines.items()
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
