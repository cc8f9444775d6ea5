"""Static equilibrium with backlash: who carries load when the machine stands still under torque."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.linalg
import scipy.optimize
from numpy.typing import NDArray

from facegear.errors import NotConverged
from facegear.transmission.layout import DOF_PER_BODY
from facegear.transmission.machine import Machine
from facegear.transmission.matrices import bearing_diagonal, mesh_directions

MAX_ITERATIONS = 200
RESIDUAL = 1e-10
FIRST_SPRING, LAST_SPRING, ROUNDS = 1e-2, 1e-12, 41


@dataclass(frozen=True, eq=False)
class Equilibrium:
    """Displacements (4 bodies,), mesh deflections (meshes,) in m and rad, elastic mesh forces (meshes,) in N.

    `residual` is the largest force imbalance over the largest applied or mesh force.
    """

    displacements: NDArray[np.float64]
    deflections: NDArray[np.float64]
    forces: NDArray[np.float64]
    residual: float


def dead_zone(deflections: NDArray[np.float64], half_width: float) -> NDArray[np.float64]:
    """f(d) of equation (19), any shape."""
    return np.sign(deflections) * np.maximum(np.abs(deflections) - half_width, 0.0)


def static_equilibrium(machine: Machine, cycles: float | None = None) -> Equilibrium:
    """Minimise the elastic energy less the work of the torques (convex: the dead zone only flattens it).

    `cycles` is the position in the mesh cycle that gives k and e; None takes mean stiffness and no error.
    A body that is free inside its backlash is left at one of its possible positions.
    Raises NotConverged.
    """
    directions = mesh_directions(machine.layout)
    if cycles is None:
        stiffness = np.full(len(directions), machine.stiffness.mean)
        error = np.zeros(len(directions))
    else:
        stiffness = machine.stiffness(cycles - machine.phases)
        error = machine.error(cycles - machine.error_phases)
    bearing = bearing_diagonal(machine.layout)
    applied = np.zeros(bearing.size)
    applied[3::DOF_PER_BODY] = machine.torques
    # Rotations are scaled by the pinion radius so that all unknowns are lengths of one order.
    scale = np.ones(bearing.size)
    scale[3::DOF_PER_BODY] = 1.0 / machine.layout.pinion_radius
    solution = _minimise(
        directions * scale, stiffness, error, bearing * scale**2, applied * scale, machine.half_backlash
    )
    deflections = directions @ (scale * solution) - error
    forces = stiffness * dead_zone(deflections, machine.half_backlash)
    balance = bearing * scale * solution + directions.T @ forces - applied
    size = max(np.abs(applied * scale).max(), np.abs(forces).max())
    residual = float(np.abs(balance * scale).max() / size) if size > 0.0 else 0.0
    # A deflection in the dead zone's neighbourhood is known to rounding only, and so is its force.
    rounding = 100.0 * np.finfo(float).eps * stiffness.max() * np.abs(deflections).max()
    if residual * size > RESIDUAL * size + rounding:
        where = "mean stiffness" if cycles is None else f"mesh position {cycles:.4f}"
        raise NotConverged("static equilibrium", where, f"force imbalance {residual:.2e} over {RESIDUAL:.0e}")
    return Equilibrium(scale * solution, deflections, forces, residual)


def _minimise(
    directions: NDArray[np.float64],
    stiffness: NDArray[np.float64],
    error: NDArray[np.float64],
    bearing: NDArray[np.float64],
    applied: NDArray[np.float64],
    half_width: float,
) -> NDArray[np.float64]:
    """Proximal point method: each round ties the body to its last place by a spring softer than before.

    The springs make every round strictly convex, so that bodies free inside their backlash have a place too;
    the force in the springs goes to zero as the rounds settle.
    """
    size = np.abs(applied).max()
    stiffest = max(stiffness.max(), bearing.max())
    place = np.zeros(bearing.size)
    for spring in stiffest * np.geomspace(FIRST_SPRING, LAST_SPRING, ROUNDS):
        last = place
        place = _newton(directions, stiffness, error, bearing, applied, half_width, spring, last)
        forces = stiffness * dead_zone(directions @ place - error, half_width)
        if spring * np.abs(place - last).max() <= 1e-3 * RESIDUAL * max(size, np.abs(forces).max()):
            break
    return place


def _newton(
    directions: NDArray[np.float64],
    stiffness: NDArray[np.float64],
    error: NDArray[np.float64],
    bearing: NDArray[np.float64],
    applied: NDArray[np.float64],
    half_width: float,
    spring: float,
    anchor: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Newton's method with an exact line search on the piecewise quadratic energy of one round."""

    def gradient(q: NDArray[np.float64]) -> NDArray[np.float64]:
        forces = stiffness * dead_zone(directions @ q - error, half_width)
        return bearing * q + directions.T @ forces - applied + spring * (q - anchor)

    place = anchor
    for _ in range(MAX_ITERATIONS):
        active = np.where(np.abs(directions @ place - error) > half_width, stiffness, 0.0)
        curvature = np.diag(bearing + spring) + (directions.T * active) @ directions
        step = -scipy.linalg.solve(curvature, gradient(place), assume_a="pos")
        moved = place + step * _line_minimum(
            lambda s, step=step, at=place: float(gradient(at + s * step) @ step)
        )
        if np.abs(moved - place).max() <= 1e-15 * max(np.abs(place).max(), half_width):
            return moved
        place = moved
    return place


def _line_minimum(slope: Callable[[float], float]) -> float:
    """Zero of a slope that only grows along the line, bracketed by doubling."""
    at_low = slope(0.0)
    if at_low >= 0.0:
        return 0.0
    if abs(slope(1.0)) <= 1e-12 * abs(at_low):
        return 1.0
    low, high = 0.0, 1.0
    while slope(high) < 0.0:
        low, high = high, 2.0 * high
    return float(scipy.optimize.brentq(slope, low, high, xtol=1e-16, rtol=1e-15))
