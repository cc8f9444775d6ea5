"""Static equilibrium of equation (13) as printed, whose two flanks share one line of action.

Kept apart from the contact problem of geometric meshes: published results rest on its very rounding.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from facegear.transmission.machine import Machine
from facegear.transmission.matrices import bearing_diagonal, mesh_directions

MAX_ITERATIONS = 200
RESIDUAL = 1e-10
FIRST_SPRING, LAST_SPRING, ROUNDS = 1e-2, 1e-12, 41
MORE_ROUNDS = 20
FARTHEST = 2.0**60
"""How many steps ahead a line is looked along."""


def dead_zone(deflections: NDArray[np.float64], half_width: float) -> NDArray[np.float64]:
    """f(d) of equation (19), any shape."""
    return np.sign(deflections) * np.maximum(np.abs(deflections) - half_width, 0.0)


def printed_equilibrium(
    machine: Machine, cycles: float | None
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], float, float]:
    """Displacements (dof,), deflections and elastic forces (meshes,), largest imbalance over the largest
    force, and what of that is rounding.

    Minimises the elastic energy less the work of the torques (convex: the dead zone only flattens it).
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
    applied[machine.layout.spins] = machine.torques
    # Rotations are scaled by the pinion radius so that all unknowns are lengths of one order.
    scale = np.ones(bearing.size)
    scale[machine.layout.spins] = 1.0 / machine.layout.pinion_radius
    scaled = _Springs(
        directions * scale, stiffness, error, bearing * scale**2, applied * scale, machine.half_backlash
    )
    solution = _minimise(scaled)
    deflections, forces = scaled.deflections(solution), scaled.forces(solution)
    size = max(np.abs(applied * scale).max(), np.abs(forces).max())
    residual = float(np.abs(scaled.balance(solution)).max() / size) if size > 0.0 else 0.0
    # A deflection in the dead zone's neighbourhood is known to rounding only, and so is its force.
    rounding = 100.0 * np.finfo(float).eps * stiffness.max() * np.abs(deflections).max()
    return scale * solution, deflections, forces, residual, rounding / size if size > 0.0 else 0.0


@dataclass(frozen=True, eq=False)
class _Springs:
    """Meshes and bearings in scaled displacements q: directions (meshes, q), the rest per mesh or per q."""

    directions: NDArray[np.float64]
    stiffness: NDArray[np.float64]
    error: NDArray[np.float64]
    bearing: NDArray[np.float64]
    applied: NDArray[np.float64]
    half_width: float

    def deflections(self, q: NDArray[np.float64]) -> NDArray[np.float64]:
        return self.directions @ q - self.error

    def forces(self, q: NDArray[np.float64]) -> NDArray[np.float64]:
        return self.stiffness * dead_zone(self.deflections(q), self.half_width)

    def balance(self, q: NDArray[np.float64]) -> NDArray[np.float64]:
        return self.bearing * q + self.directions.T @ self.forces(q) - self.applied

    def curvature(self, q: NDArray[np.float64]) -> NDArray[np.float64]:
        active = np.where(np.abs(self.deflections(q)) > self.half_width, self.stiffness, 0.0)
        return np.diag(self.bearing) + (self.directions.T * active) @ self.directions


def _minimise(springs: _Springs) -> NDArray[np.float64]:
    """Proximal point method: each round ties the body to its last place by a spring softer than before.

    The springs make every round strictly convex, so that bodies free inside their backlash have a place too;
    the force in the springs goes to zero as the rounds settle.
    """
    size = np.abs(springs.applied).max()
    stiffest = max(springs.stiffness.max(), springs.bearing.max())
    place = np.zeros(springs.bearing.size)
    for tie in stiffest * np.geomspace(FIRST_SPRING, LAST_SPRING, ROUNDS):
        last = place
        place = _newton(springs, tie, last)
        largest = max(size, np.abs(springs.forces(place)).max())
        if tie * np.abs(place - last).max() <= 1e-3 * RESIDUAL * largest:
            return place
    return _pushed_on(springs, float(tie), last, place)


def _pushed_on(
    springs: _Springs, tie: float, last: NDArray[np.float64], place: NDArray[np.float64]
) -> NDArray[np.float64]:
    """A body that a force next to nothing has not yet moved through its backlash goes on as far as it can."""
    for _ in range(MORE_ROUNDS):
        size = max(np.abs(springs.applied).max(), np.abs(springs.forces(place)).max())
        if np.abs(springs.balance(place)).max() <= RESIDUAL * size:
            break
        step = place - last

        def slope(s: float, step: NDArray[np.float64] = step, at: NDArray[np.float64] = place) -> float:
            return float(springs.balance(at + s * step) @ step)

        last = place + step * _line_minimum(slope)
        place = _newton(springs, tie, last)
    return place


def _newton(springs: _Springs, tie: float, anchor: NDArray[np.float64]) -> NDArray[np.float64]:
    """Newton's method with an exact line search on the piecewise quadratic energy of one round."""

    def gradient(q: NDArray[np.float64]) -> NDArray[np.float64]:
        return springs.balance(q) + tie * (q - anchor)

    place, ties = anchor, tie * np.eye(len(anchor))
    for _ in range(MAX_ITERATIONS):
        step = -scipy.linalg.solve(springs.curvature(place) + ties, gradient(place), assume_a="pos")

        def slope(s: float, step: NDArray[np.float64] = step, at: NDArray[np.float64] = place) -> float:
            return float(gradient(at + s * step) @ step)

        moved = place + step * _line_minimum(slope)
        if np.abs(moved - place).max() <= 1e-15 * max(np.abs(place).max(), springs.half_width):
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
    while slope(high) < 0.0 and high < FARTHEST:
        low, high = high, 2.0 * high
    if high >= FARTHEST:
        return high
    return float(scipy.optimize.brentq(slope, low, high, xtol=1e-16, rtol=1e-15, disp=False))
