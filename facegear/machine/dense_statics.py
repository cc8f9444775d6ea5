"""Static equilibrium of any linear model with contacts of any kind: one position at a time, in dense algebra.

Contacts may have an edge on either side, as the meshes of equation (13) as printed, where one deflection of
either sign passes a dead zone; stiffness may couple any coordinates. Where each pinion has a bearing of its
own and contacts push, facegear.machine.block_statics is far faster.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array, Integers
from facegear.machine.linear_model import LinearModel
from facegear.meshing.law import MeshLaw, beyond_edges

MAX_ITERATIONS = 200
"""Largest number of steps of Newton's method, and of a search along a line."""
RESIDUAL = 1e-10
"""Largest force out of balance, over the largest force, of an accepted result."""
FIRST_SPRING, LAST_SPRING, ROUNDS = 1e-2, 1e-12, 41
"""Springs of the proximal point method over the stiffest spring of the machine, first and last, and the
number of rounds between them.
"""
MORE_ROUNDS = 20
"""Largest number of rounds that move a body with next to no load through its backlash."""
FARTHEST = 2.0**60
"""Number of steps ahead to which a line is searched."""
STRAIGHT = 1e-10
"""A slope is zero to this fraction of what it is at the start."""
NO_PHASE = np.zeros(1)
"""Phase at which a law is evaluated that does not depend on the phase."""


@dataclass(frozen=True, eq=False)
class Contacts:
    """Contacts at one position: law, which does not depend on the phase; error, lower and upper edge of each
    deflection (contacts,), m. A contact that only pushes has its lower edge at minus infinity.
    """

    law: MeshLaw
    error: Array
    lower: Array
    upper: Array

    def beyond(self, deflections: Array) -> Array:
        """Return the compression of contacts by deflections: above the upper edge, or negative below the
        lower one.

        Parameters
        ----------
        deflections : (..., contacts) array
            m, with the error taken off.

        Returns
        -------
        (..., contacts) array
            m; 0 between the edges.
        """
        return beyond_edges(deflections, self.lower, self.upper)

    def forces(self, beyond: Array) -> Array:
        """Return the forces of contacts by the law.

        Parameters
        ----------
        beyond : (..., contacts) array
            Compression as `beyond` returns it, m.

        Returns
        -------
        (..., contacts) array
            N, with the sign of the compression.
        """
        return self.law.force(NO_PHASE, beyond[..., None, :])[..., 0, :]

    def slopes(self, beyond: Array) -> Array:
        """Return the derivatives of the forces by the compression (tangent stiffness).

        Parameters
        ----------
        beyond : (contacts,) array
            Compression, m.

        Returns
        -------
        (contacts,) array
            N/m.
        """
        return self.law.slope(NO_PHASE, beyond[None])[0]


def dense_equilibrium(linear: LinearModel, contacts: Contacts, lengths: Array) -> tuple[Array, Array, Array]:
    """Compute the static equilibrium of a linear model with contacts.

    The method minimises the elastic energy less the work of the loads (convex: gaps only flatten it).

    Parameters
    ----------
    linear : LinearModel
        Bodies, bearings and loads.
    contacts : Contacts
        Contacts at one position.
    lengths : (n,) array
        Length of one unit of each coordinate, m, so that all unknowns are lengths of one order.

    Returns
    -------
    tuple of three arrays
        Displacements (n,) in m and rad, deflections (contacts,) without errors in m, elastic forces
        (contacts,) in N.
    """
    scale = 1.0 / lengths
    ring_coordinates = linear.ring_coordinates
    springs = _Springs(
        linear.rows[: contacts.upper.size] * scale,
        contacts,
        linear.stiffness_without_rings * np.outer(scale, scale),
        linear.loads * scale,
        _Rings(ring_coordinates, linear.rings.stiffness, linear.rings.clearance),
    )
    solution = _minimise(springs)
    deflections = springs.deflections(solution)
    return scale * solution, deflections, contacts.forces(contacts.beyond(deflections))


@dataclass(frozen=True, eq=False)
class _Rings:
    """Bearings with clearance: unknowns that are x and y (R, 2), stiffness (R,) in N/m, clearance (R,) in
    m.
    """

    coordinates: Integers
    stiffness: Array
    clearance: Array

    def push(self, q: Array) -> Array:
        """Return the forces (..., n) of the shafts on these bearings at displacements q (..., n), N: k (1
        - c / r) (x, y) where the distance r is above the clearance c, else 0.
        """
        forces = np.zeros_like(q)
        displacements = q[..., self.coordinates]
        distance = np.maximum(np.hypot(displacements[..., 0], displacements[..., 1]), self.clearance)
        secant_stiffness = self.stiffness * (1.0 - self.clearance / distance)
        forces[..., self.coordinates] = secant_stiffness[..., None] * displacements
        return forces

    def add_tangents(self, q: Array, matrix: Array) -> None:
        """Add the derivatives of `push` at displacements q (n,) to a matrix (n, n), N/m, in place."""
        for at, stiffness, clearance in zip(self.coordinates, self.stiffness, self.clearance, strict=True):
            distance = float(np.hypot(*q[at]))
            if distance > clearance:
                along = q[at] / distance
                across = stiffness * (1.0 - clearance / distance)
                matrix[np.ix_(at, at)] += across * np.eye(2) + (stiffness - across) * np.outer(along, along)


@dataclass(frozen=True, eq=False)
class _Springs:
    """Contacts, bearings and loads of one position; all unknowns q (n,) are lengths, m.

    - jacobian (contacts, n): derivative of the deflections
    - bearing (n, n): stiffness without the bearings that have clearance, N/m
    - loads (n,): N
    - rings: bearings with clearance
    """

    jacobian: Array
    contacts: Contacts
    bearing: Array
    loads: Array
    rings: _Rings

    def deflections(self, q: Array) -> Array:
        """Return the deflection (contacts,) of every contact, jacobian q - error, m, at displacements q
        (n,).
        """
        return self.jacobian @ q - self.contacts.error

    def forces(self, q: Array) -> Array:
        """Return the force (contacts,) of every contact, N, positive above its upper edge, at
        displacements `q` (n,).
        """
        return self.contacts.forces(self.contacts.beyond(self.deflections(q)))

    def balance(self, q: Array, forces: Array) -> Array:
        """Return the forces out of balance (n,), N, which are the gradient of the energy, at q (n,) with
        given contact forces (contacts,): bearing q + jacobian^T forces + rings - loads.
        """
        balance = self.bearing @ q + self.jacobian.T @ forces - self.loads
        return balance + self.rings.push(q) if self.rings.clearance.size else balance

    def curvature(self, q: Array, slope: Array) -> Array:
        """Return the second derivatives (n, n), N/m, of the energy at displacements q, with given tangent
        stiffness (contacts,) of the contacts.
        """
        curvature = self.bearing + (self.jacobian.T * slope) @ self.jacobian
        if self.rings.clearance.size:
            self.rings.add_tangents(q, curvature)
        return curvature

    def along(self, q: Array, deflections: Array, step: Array, tie: float, anchor: Array) -> "Line":
        """Return the energy's slope along the line q + s step, as a function of s.

        deflections (contacts,): those at q, m; tie: stiffness, N/m, of springs from q to the position
        `anchor` (n,) in every unknown.
        """
        at_start = self.bearing @ q + tie * (q - anchor) - self.loads

        def bearings(s: Array) -> Array:
            """Return the slope (K,), J, of the energy in the bearings with clearance at points s (K,) of
            the line.
            """
            return np.asarray(self.rings.push(q + s[:, None] * step) @ step)

        return Line(
            constant=float(at_start @ step),
            rise=float((self.bearing @ step + tie * step) @ step),
            deflections=deflections,
            rates=self.jacobian @ step,
            contacts=self.contacts,
            bearings=bearings if self.rings.clearance.size else None,
        )


@dataclass(frozen=True, eq=False)
class Line:
    """Slope of the energy along a line q + s step: constant + rise s + sum of rates F(deflections + s
    rates), and what `bearings` with clearance add at points (K,) of the line, in J.

    deflections (contacts,): at s = 0, m; rates (contacts,): their change for a whole step, m.
    """

    constant: float
    rise: float
    deflections: Array
    rates: Array
    contacts: Contacts
    bearings: Callable[[Array], Array] | None = None

    def _forces(self, s: Array | float) -> Array:
        """Return the contact forces (..., contacts), N, at points s of the line, a number or (K, 1), in
        steps.
        """
        return self.contacts.forces(self.contacts.beyond(self.deflections + s * self.rates))

    def slopes(self, s: Array) -> Array:
        """Return the slope of the energy at points of the line.

        Parameters
        ----------
        s : (K,) array
            Points, as multiples of the step (dimensionless).

        Returns
        -------
        (K,) array
            Derivative of the energy by s, J.
        """
        forces = self._forces(s[:, None])
        slopes = np.asarray(self.constant + self.rise * s + forces @ self.rates)
        return slopes if self.bearings is None else slopes + self.bearings(s)

    def corners(self) -> Array:
        """Return where a mesh passes a level of its law ahead, in order, with the two ends of the line.

        Between two corners the slope is smooth, and straight if the law is linear.

        Returns
        -------
        (corners,) array
            In steps (dimensionless).
        """
        has_motion = self.rates != 0.0
        levels, contacts = self.contacts.law.levels[:, has_motion], self.contacts
        edges = np.concatenate([contacts.upper[has_motion] + levels, contacts.lower[has_motion] - levels])
        with np.errstate(over="ignore"):  # an edge that is met at infinity is not ahead
            at = ((edges - self.deflections[has_motion]) / self.rates[has_motion]).ravel()
        inside = np.sort(at[(at > 0.0) & (at < FARTHEST)])
        return np.concatenate([[0.0], inside, [FARTHEST]])

    def minimum(self) -> float:
        """Return the step along the line at which the energy is least: the zero of its slope, which only
        grows.

        Returns
        -------
        float
            In steps (dimensionless): the end of the line where the slope does not come to zero.
        """
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
        """Return the zero of the slope between two corners.

        low, high: points that bracket it; below < 0 < above: slopes there, J; close: slope that counts as
        zero, J. Where the slope is straight one step finds it, else the Illinois method (Dowell and
        Jarratt 1971).
        """
        side = 0
        for _ in range(MAX_ITERATIONS):
            s = float(low + (high - low) * (below / (below - above)))
            if self.contacts.law.straight and self.bearings is None:
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
        """Return a bound for the rounding error of the slope at a point s, J."""
        forces = self._forces(s)
        size = abs(self.constant) + abs(self.rise * s) + np.abs(forces * self.rates).sum()
        return 100.0 * float(np.finfo(float).eps * size)


def _minimise(springs: _Springs) -> Array:
    """Return the displacements (n,), m, of least energy, by the proximal point method (Rockafellar 1976).

    Each round ties the body to its last position by a spring softer than before. The springs make every
    round strictly convex, so that bodies free inside their backlash have a position too; the force in the
    springs goes to zero as the rounds settle.
    """
    size = np.abs(springs.loads).max()
    stiffest = max(springs.contacts.law.steepest.max(), springs.bearing.max())
    displacement = np.zeros(springs.loads.size)
    for tie in stiffest * np.geomspace(FIRST_SPRING, LAST_SPRING, ROUNDS):
        last = displacement
        displacement = _newton(springs, tie, last)
        largest = max(size, np.abs(springs.forces(displacement)).max())
        if tie * np.abs(displacement - last).max() <= 1e-3 * RESIDUAL * largest:
            return displacement
    return _pushed_on(springs, float(tie), last, displacement)


def _pushed_on(springs: _Springs, tie: float, last: Array, displacement: Array) -> Array:
    """Move bodies on whose load is so small that no round of `_minimise` took them through their
    backlash.

    Each round extrapolates the last motion (from `last` to `displacement`, (n,), m) to the least energy
    along that line, then minimises again with springs of stiffness `tie`, N/m. Ends when all forces
    balance, or after MORE_ROUNDS.
    """
    for _ in range(MORE_ROUNDS):
        deflections = springs.deflections(displacement)
        forces = springs.contacts.forces(springs.contacts.beyond(deflections))
        size = max(np.abs(springs.loads).max(), np.abs(forces).max())
        if np.abs(springs.balance(displacement, forces)).max() <= RESIDUAL * size:
            break
        step = displacement - last
        last = (
            displacement + step * springs.along(displacement, deflections, step, 0.0, displacement).minimum()
        )
        displacement = _newton(springs, tie, last)
    return displacement


def _newton(springs: _Springs, tie: float, anchor: Array) -> Array:
    """Minimise the energy plus springs `tie` (N/m) to the position `anchor` (n,), by Newton's method with
    an exact line search from the anchor.

    Returns the displacements (n,), m. If all forces are straight, a full step after which the same
    contacts are pressed ends at the exact minimum, so no line is searched there.
    """
    displacement, ties, contacts = anchor, tie * np.eye(len(anchor)), springs.contacts
    widest = np.abs(contacts.upper).max()
    quadratic = contacts.law.straight and not springs.rings.clearance.size
    for _ in range(MAX_ITERATIONS):
        deflections = springs.deflections(displacement)
        beyond = contacts.beyond(deflections)
        gradient = springs.balance(displacement, contacts.forces(beyond)) + tie * (displacement - anchor)
        curvature = springs.curvature(displacement, contacts.slopes(beyond)) + ties
        step = -np.asarray(np.linalg.solve(curvature, gradient), np.float64)
        whole = displacement + step
        if quadratic and np.array_equal(
            np.sign(contacts.beyond(springs.deflections(whole))), np.sign(beyond)
        ):
            return whole
        along = springs.along(displacement, deflections, step, tie, anchor).minimum()
        next_displacement = displacement + along * step
        size = max(np.abs(displacement).max(), widest)
        if np.abs(next_displacement - displacement).max() <= 1e-15 * size:
            return next_displacement
        displacement = next_displacement
    return displacement
