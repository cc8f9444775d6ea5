"""Frictionless unilateral contact of two condensed bodies turned against each other by a torque.

Find forces f >= 0 and the rotation r with  gap + C f - r a >= 0,  f . (gap + C f - r a) = 0,  a . f = torque,
a the lever arms: the optimality conditions of a convex quadratic programme, hence one solution for a positive
definite C. A primal-dual active set (semismooth Newton; Hintermueller et al. 2003) finishes in a few
steps; should it cycle, a single-exchange active set, which lowers the energy at each step, finishes the work.
"""

from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array, Mask
from facegear.contact.active_set import bonded, distances, newton, refined, violation
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
    cold = start is None or not (start & (lever_arm > 0)).any()
    compliance, gap, lever_arm = (np.ascontiguousarray(part) for part in (compliance, gap, lever_arm))
    problem = compliance, gap, lever_arm, float(torque)
    steps, force, rotation, slope, residual = newton(
        *problem, _first_guess(gap, lever_arm) if cold else start, (NEWTON_STEPS, TOLERANCE)
    )
    if not steps:
        return _exchange(*problem, _feasible(gap, lever_arm, torque, force), where)
    return _checked(torque, force, rotation, slope, residual, steps, where)


def _first_guess(gap: Array, lever_arm: Array) -> Mask:
    turns = np.where(lever_arm > 0, gap / np.where(lever_arm > 0, lever_arm, 1.0), np.inf)
    return turns <= np.quantile(turns[np.isfinite(turns)], 0.25)


def _checked(
    torque: float, force: Array, rotation: float, slope: float, residual: float, steps: int, where: str
) -> ContactSolution:
    if not residual < TOLERANCE * 10:
        raise NotConverged("contact", where, f"KKT residual {residual:.1e} after {steps} steps")
    return ContactSolution(
        torque=torque, force=force, rotation=rotation, slope=slope, residual=residual, steps=steps
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
    given = (np.ascontiguousarray(part) for part in (compliance, gap, lever_arm))
    return violation(*given, float(torque), np.ascontiguousarray(force), float(rotation))


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
        touching = bonded(compliance, gap, lever_arm, torque, active)
        index, rotation, slope = touching[0], touching[5], touching[6]
        target = np.zeros_like(force)
        target[index] = touching[4]
        falling = active & (target <= 0.0)
        if falling.any():
            fraction = np.min(force[falling] / (force[falling] - target[falling]))
            force = force + fraction * (target - force)
            leaving = falling & (force <= 1e-14 * force.max())
            active &= ~leaving
            continue
        force = target
        distance = distances(compliance, gap, lever_arm, force, rotation)
        scale = np.abs(rotation * lever_arm).max() + np.abs(gap[active]).max()
        worst = int(np.argmin(np.where(active, np.inf, distance)))
        if active.all() or distance[worst] >= -TOLERANCE * scale:
            force, rotation, residual = refined(compliance, gap, lever_arm, torque, touching)
            return _checked(torque, force, rotation, slope, residual, NEWTON_STEPS + step, where)
        active[worst] = True
    raise NotConverged("contact", where, f"{NEWTON_STEPS} Newton and {limit} exchange steps")
