"""Frictionless unilateral contact of two condensed bodies turned against each other by a torque.

Find forces f >= 0 and the rotation r with  gap + C f - r a >= 0,  f . (gap + C f - r a) = 0,  a . f = torque,
a the lever arms: the optimality conditions of a convex quadratic programme, hence one solution for a positive
definite C. A primal-dual active set (semismooth Newton; Hintermueller et al. 2003) finishes in a few
steps; should it cycle, a single-exchange active set, which lowers the energy at each step, finishes the work.
"""

from dataclasses import dataclass

import numpy as np
import scipy.linalg as sl

from facegear.arrays import Array, Integers, Mask
from facegear.errors import NotConverged

NEWTON_STEPS = 40
TOLERANCE = 1e-11


@dataclass(frozen=True, eq=False)
class ContactSolution:
    """A contact loaded by a torque.

    Attributes
    ----------
    torque
        N m.
    force : (n,)
        N.
    rotation
        rad (the approach in m where lever arms are 1).
    slope
        d rotation / d torque with the contact area following the load, rad/(N m).
    residual
        Largest relative violation of the conditions.
    steps
        Of the active set.
    """

    torque: float
    force: Array
    rotation: float
    slope: float
    residual: float
    steps: int

    @property
    def active(self) -> Mask:
        """Points in contact (n,)."""
        return self.force > 0.0


def solve_contact(
    compliance: Array,
    gap: Array,
    lever_arm: Array,
    torque: float,
    start: Mask | None = None,
    where: str = "this position",
) -> ContactSolution:
    """Solve for compliance (n, n) in m/N, gaps (n,) in m, lever arms (n,) in m and a torque > 0 in N m.

    `start` (n,) is a guess of the points in contact. The result does not depend on it beyond rounding.
    Raises NotConverged naming `where`.
    """
    if not torque > 0.0:
        raise ValueError(f"torque = {torque}: must be positive")
    if not (lever_arm > 0.0).any():
        raise NotConverged("contact", where, "no candidate point can carry the torque")
    active = (
        _first_guess(gap, lever_arm) if start is None or not (start & (lever_arm > 0)).any() else start.copy()
    )
    seen: set[bytes] = set()
    for step in range(1, NEWTON_STEPS + 1):
        bonded = _bonded(compliance, gap, lever_arm, torque, active)
        distance = gap + compliance @ bonded.force - bonded.rotation * lever_arm
        scale = np.abs(bonded.rotation * lever_arm).max() + np.abs(gap[active]).max()
        next_active = np.where(active, bonded.force > 0.0, distance < -TOLERANCE * scale)
        if np.array_equal(next_active, active):
            return _checked(compliance, gap, lever_arm, torque, bonded, step, where)
        key = np.packbits(next_active).tobytes()
        if key in seen or not (next_active & (lever_arm > 0)).any():
            break
        seen.add(key)
        active = next_active
    return _exchange(
        compliance, gap, lever_arm, torque, _feasible(gap, lever_arm, torque, bonded.force), where
    )


def _first_guess(gap: Array, lever_arm: Array) -> Mask:
    turns = np.where(lever_arm > 0, gap / np.where(lever_arm > 0, lever_arm, 1.0), np.inf)
    return turns <= np.quantile(turns[np.isfinite(turns)], 0.25)


@dataclass(frozen=True, eq=False)
class _Bonded:
    """What happens if exactly the points `active` (k,) touch, and the factor of their compliance.

    `turning` (k,): their forces by a unit turn, N/rad.
    """

    active: Integers
    compliance: Array
    factor: tuple[Array, bool]
    turning: Array
    force: Array
    rotation: float
    slope: float


def _bonded(compliance: Array, gap: Array, lever_arm: Array, torque: float, touching: Mask) -> _Bonded:
    active = np.flatnonzero(touching)
    block = compliance[np.ix_(active, active)]
    factor = sl.cho_factor(block, lower=True, check_finite=False)
    lever_arms, offset = lever_arm[active], gap[active]
    both = sl.cho_solve(factor, np.stack([lever_arms, offset], axis=1), check_finite=False)
    stiffness = lever_arms @ both[:, 0]
    rotation = (torque + lever_arms @ both[:, 1]) / stiffness
    force = np.zeros_like(gap)
    force[active] = rotation * both[:, 0] - both[:, 1]
    return _Bonded(
        active=active,
        compliance=block,
        factor=factor,
        turning=both[:, 0],
        force=force,
        rotation=rotation,
        slope=1.0 / stiffness,
    )


def _checked(
    compliance: Array, gap: Array, lever_arm: Array, torque: float, bonded: _Bonded, steps: int, where: str
) -> ContactSolution:
    """The result after two steps of iterative refinement, its residual tested."""
    active, turning = bonded.active, bonded.turning
    force, rotation = bonded.force[active], bonded.rotation
    for _ in range(2):
        distance = gap[active] + bonded.compliance @ force - rotation * lever_arm[active]
        missing = torque - lever_arm[active] @ force
        change = -sl.cho_solve(bonded.factor, distance, check_finite=False)
        turn = (missing - lever_arm[active] @ change) / (lever_arm[active] @ turning)
        force = force + change + turn * turning
        rotation += turn
    refined = np.zeros_like(gap)
    refined[active] = force
    residual = kkt_residual(compliance, gap, lever_arm, torque, refined, rotation)
    if not residual < TOLERANCE * 10:
        raise NotConverged("contact", where, f"KKT residual {residual:.1e} after {steps} steps")
    return ContactSolution(
        torque=torque,
        force=refined,
        rotation=float(rotation),
        slope=float(bonded.slope),
        residual=residual,
        steps=steps,
    )


def kkt_residual(
    compliance: Array,
    gap: Array,
    lever_arm: Array,
    torque: float,
    force: Array,
    rotation: float,
) -> float:
    """Largest relative violation of balance, no tension, no penetration and complementarity."""
    active = force != 0.0
    distance = gap + compliance @ force - rotation * lever_arm
    scale = np.abs(rotation * lever_arm).max() + np.abs(gap[active]).max()
    return float(
        max(
            abs(lever_arm @ force - torque) / torque,
            -force.min() / force.max(),
            -distance.min() / scale,
            np.abs(distance[active]).max() / scale,
        )
    )


def _feasible(gap: Array, lever_arm: Array, torque: float, force: Array) -> Array:
    """Forces without tension that carry the torque: those given, or one where the gap closes first."""
    pressing = np.maximum(force, 0.0)
    if lever_arm @ pressing > 0.0:
        return pressing * (torque / (lever_arm @ pressing))
    turns = np.where(lever_arm > 0, gap / np.where(lever_arm > 0, lever_arm, 1.0), np.inf)
    first = int(np.argmin(turns))
    alone = np.zeros_like(gap)
    alone[first] = torque / lever_arm[first]
    return alone


def _exchange(
    compliance: Array, gap: Array, lever_arm: Array, torque: float, force: Array, where: str
) -> ContactSolution:
    """One point at a time from feasible forces, energy falling at every step, hence finite."""
    active = force > 0.0
    limit = 20 * gap.size + 100
    for step in range(limit):
        bonded = _bonded(compliance, gap, lever_arm, torque, active)
        target, rotation = bonded.force, bonded.rotation
        falling = active & (target <= 0.0)
        if falling.any():
            fraction = np.min(force[falling] / (force[falling] - target[falling]))
            force = force + fraction * (target - force)
            leaving = falling & (force <= 1e-14 * force.max())
            active &= ~leaving
            continue
        force = target
        distance = gap + compliance @ force - rotation * lever_arm
        scale = np.abs(rotation * lever_arm).max() + np.abs(gap[active]).max()
        worst = int(np.argmin(np.where(active, np.inf, distance)))
        if active.all() or distance[worst] >= -TOLERANCE * scale:
            return _checked(compliance, gap, lever_arm, torque, bonded, NEWTON_STEPS + step, where)
        active[worst] = True
    raise NotConverged("contact", where, f"{NEWTON_STEPS} Newton and {limit} exchange steps")
