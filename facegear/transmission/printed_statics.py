"""Static equilibrium of equation (13) as printed, whose two flanks share one line of action.

Kept apart from the contact problem of geometric meshes, where each flank has a gap of its own: here one
deflection of either sign passes a dead zone.
"""

from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array
from facegear.mesh_law.law import MeshLaw
from facegear.transmission.flanks import line_law
from facegear.transmission.machine import Machine
from facegear.transmission.matrices import bearing_matrix, mesh_directions

MAX_ITERATIONS = 200
RESIDUAL = 1e-10
FIRST_SPRING, LAST_SPRING, ROUNDS = 1e-2, 1e-12, 41
MORE_ROUNDS = 20
FARTHEST = 2.0**60
"""How many steps ahead a line is looked along."""
STRAIGHT = 1e-10
"""A slope is zero to this fraction of what it is at the start."""
NO_PHASE = np.zeros(1)
"""The phase at which a law is asked that depends on none."""


def _beyond(deflections: Array, half_width: float) -> Array:
    """f(d) of equation (19), any shape."""
    return np.asarray(deflections - np.minimum(np.maximum(deflections, -half_width), half_width))


def _forces(law: MeshLaw, deflections: Array, half_width: float) -> Array:
    """Forces of deflections (..., meshes), with a law that depends on no phase."""
    return law.force(NO_PHASE, _beyond(deflections, half_width)[..., None, :])[..., 0, :]


def printed_equilibrium(machine: Machine, cycles: float | None) -> tuple[Array, Array, Array, Array]:
    """Displacements (dof,), deflections, elastic forces and stiffness (meshes,) where it is looked for.

    Minimises the elastic energy less the work of the torques (convex: the dead zone only flattens it).
    """
    directions = mesh_directions(machine.layout)
    law = line_law(machine)
    if cycles is None:
        law = law.mean()
        error = np.zeros(len(directions))
    else:
        law = law.at_phase(cycles)
        error = machine.error(cycles - machine.error_phases)
    bearing = bearing_matrix(machine.layout)
    applied = machine.applied
    # Rotations are scaled by the pinion radius so that all unknowns are lengths of one order.
    scale = np.ones(len(bearing))
    scale[machine.layout.spins] = 1.0 / machine.layout.pinion_radius
    scaled = _Springs(
        directions * scale,
        law,
        error,
        bearing * np.outer(scale, scale),
        applied * scale,
        machine.half_backlash,
    )
    solution = _minimise(scaled)
    return scale * solution, scaled.deflections(solution), scaled.forces(solution), law.steepest


@dataclass(frozen=True, eq=False)
class _Springs:
    """Meshes and bearings in scaled displacements: directions (meshes, q), bearing (q, q), others by one. The
    law does not depend on the phase.
    """

    directions: Array
    law: MeshLaw
    error: Array
    bearing: Array
    applied: Array
    half_width: float

    def deflections(self, q: Array) -> Array:
        return self.directions @ q - self.error

    def forces(self, q: Array) -> Array:
        return _forces(self.law, self.deflections(q), self.half_width)

    def balance(self, q: Array) -> Array:
        return self.bearing @ q + self.directions.T @ self.forces(q) - self.applied

    def curvature(self, q: Array) -> Array:
        slope = self.law.slope(NO_PHASE, _beyond(self.deflections(q), self.half_width)[None])[0]
        return self.bearing + (self.directions.T * slope) @ self.directions

    def along(self, q: Array, step: Array, tie: float, anchor: Array) -> "Line":
        """The energy's slope along a step, with a spring `tie` to the anchor."""
        at_start = self.bearing @ q + tie * (q - anchor) - self.applied
        return Line(
            constant=float(at_start @ step),
            rise=float((self.bearing @ step + tie * step) @ step),
            deflections=self.deflections(q),
            rates=self.directions @ step,
            law=self.law,
            half_width=self.half_width,
        )


@dataclass(frozen=True, eq=False)
class Line:
    """Slope of the energy along a line: constant + rise s + sum of rates F(deflections + s rates)."""

    constant: float
    rise: float
    deflections: Array
    rates: Array
    law: MeshLaw
    half_width: float

    def slopes(self, s: Array) -> Array:
        """The slope at some places (K,)."""
        forces = _forces(self.law, self.deflections + s[:, None] * self.rates, self.half_width)
        return np.asarray(self.constant + self.rise * s + forces @ self.rates)

    def corners(self) -> Array:
        """Where a mesh passes a level of its law ahead, in order, with the two ends of the line: between two
        of them the slope is smooth, and straight if the law is linear.
        """
        moving = self.rates != 0.0
        levels = self.half_width + self.law.levels[:, moving]
        edges = np.concatenate([levels, -levels])
        with np.errstate(over="ignore"):  # an edge that is met at infinity is not ahead
            at = ((edges - self.deflections[moving]) / self.rates[moving]).ravel()
        inside = np.sort(at[(at > 0.0) & (at < FARTHEST)])
        return np.concatenate([[0.0], inside, [FARTHEST]])

    def minimum(self) -> float:
        """The zero of the slope, which only grows; the end of the line where it does not come to zero."""
        at = self.corners()
        slopes = self.slopes(at)
        if slopes[0] >= 0.0:
            return 0.0
        if slopes[-1] <= 0.0:
            return FARTHEST
        after = int(np.argmax(slopes > 0.0))
        close = STRAIGHT * abs(float(slopes[0]))
        return self._zero(at[after - 1], at[after], slopes[after - 1], slopes[after], close)

    def _zero(self, low: float, high: float, below: float, above: float, close: float) -> float:
        """The zero between two corners, by one step where the slope is straight there, else by the Illinois
        method (Dowell and Jarratt 1971).
        """
        side = 0
        for _ in range(MAX_ITERATIONS):
            s = float(low + (high - low) * (below / (below - above)))
            if self.law.straight:
                break
            value = float(self.slopes(np.array([s]))[0])
            if abs(value) <= close + self._noise(s) or not low < s < high:
                break
            if value < 0.0:
                low, below, above = s, value, 0.5 * above if side < 0 else above
                side = -1
            else:
                high, above, below = s, value, 0.5 * below if side > 0 else below
                side = 1
        return s

    def _noise(self, s: float) -> float:
        """What rounding makes of the slope at a point."""
        forces = _forces(self.law, self.deflections + s * self.rates, self.half_width)
        size = abs(self.constant) + abs(self.rise * s) + np.abs(forces * self.rates).sum()
        return 100.0 * float(np.finfo(float).eps * size)


def _minimise(springs: _Springs) -> Array:
    """Proximal point method: each round ties the body to its last place by a spring softer than before.

    The springs make every round strictly convex, so that bodies free inside their backlash have a place too;
    the force in the springs goes to zero as the rounds settle.
    """
    size = np.abs(springs.applied).max()
    stiffest = max(springs.law.steepest.max(), springs.bearing.max())
    place = np.zeros(springs.applied.size)
    for tie in stiffest * np.geomspace(FIRST_SPRING, LAST_SPRING, ROUNDS):
        last = place
        place = _newton(springs, tie, last)
        largest = max(size, np.abs(springs.forces(place)).max())
        if tie * np.abs(place - last).max() <= 1e-3 * RESIDUAL * largest:
            return place
    return _pushed_on(springs, float(tie), last, place)


def _pushed_on(springs: _Springs, tie: float, last: Array, place: Array) -> Array:
    """A body that a force next to nothing has not yet moved through its backlash goes on as far as it can."""
    for _ in range(MORE_ROUNDS):
        size = max(np.abs(springs.applied).max(), np.abs(springs.forces(place)).max())
        if np.abs(springs.balance(place)).max() <= RESIDUAL * size:
            break
        step = place - last
        last = place + step * springs.along(place, step, 0.0, place).minimum()
        place = _newton(springs, tie, last)
    return place


def _newton(springs: _Springs, tie: float, anchor: Array) -> Array:
    """Newton's method with an exact line search on the piecewise quadratic energy of one round."""
    place, ties = anchor, tie * np.eye(len(anchor))
    for _ in range(MAX_ITERATIONS):
        gradient = springs.balance(place) + tie * (place - anchor)
        step = -np.asarray(np.linalg.solve(springs.curvature(place) + ties, gradient), np.float64)
        moved = place + step * springs.along(place, step, tie, anchor).minimum()
        if np.abs(moved - place).max() <= 1e-15 * max(np.abs(place).max(), springs.half_width):
            return moved
        place = moved
    return place
