"""Frictionless unilateral contact of two condensed bodies turned against each other by a torque.

Find forces f >= 0 and the rotation r with  gap + C f - r a >= 0,  f . (gap + C f - r a) = 0,  a . f = torque,
a the lever arms: the optimality conditions of a convex quadratic programme, hence one solution for a positive
definite C. A primal-dual active set (semismooth Newton; Hintermueller et al. 2003) finishes in a few
steps; should it cycle, a single-exchange active set, which lowers the energy at each step, finishes the work.
"""

from dataclasses import dataclass

import numpy as np

from facegear._kernels import contact as kernels
from facegear.arrays import Array, Mask
from facegear.errors import NotConverged

NEWTON_STEPS = 40
"""Steps after which Newton's method gives way to the exchange of single points; it takes some three."""
TOLERANCE = 1e-11
"""Penetration that counts as rounding, over the displacement by the rotation and the widest gap closed."""


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
    place_text: str = "this position",
) -> ContactSolution:
    """Solve for the contact under a torque.

    The result does not depend on the guess `start` beyond rounding.

    Parameters
    ----------
    compliance : (n, n) array
        m/N.
    gap : (n,) array
        m.
    lever_arm : (n,) array
        m.
    torque : float
        N m, above 0.
    start : (n,) array of bool, optional
        Guess of the points in contact.
    place_text : str
        Names the position in errors.

    Returns
    -------
    ContactSolution
        Forces and rotation, in SI units.

    Raises
    ------
    NotConverged
        Names `place_text`.
    ValueError
        Where the torque is not positive.
    """
    if not torque > 0.0:
        raise ValueError(f"torque = {torque}: must be positive")
    if not (lever_arm > 0.0).any():
        raise NotConverged("contact", place_text, "no candidate point can carry the torque")
    matrix, gaps, arms = (np.ascontiguousarray(array, float) for array in (compliance, gap, lever_arm))
    begin = np.zeros(gap.size, bool) if start is None else np.ascontiguousarray(start)
    answer = kernels.solve_active_set(matrix, gaps, arms, torque, begin, NEWTON_STEPS, TOLERANCE)
    check_solved(answer["steps"], answer["residual"], gap.size, place_text)
    del answer["force_change"]
    return ContactSolution(torque=torque, **answer)


def check_solved(steps: int, residual: float, points: int, place_text: str) -> None:
    """Raise NotConverged if no solution was found.

    Parameters
    ----------
    steps : int
        Steps of the solver, 0 without a solution.
    residual : float
        Largest relative violation of the conditions, dimensionless.
    points : int
        Number of points that may touch.
    place_text : str
        Names the position in the error.

    Raises
    ------
    NotConverged
        Names `place_text`.
    """
    if not steps:
        attempts = f"{NEWTON_STEPS} Newton and {kernels.exchange_steps(points)} exchange steps"
        raise NotConverged("contact", place_text, attempts)
    if not residual < TOLERANCE * 10:
        raise NotConverged("contact", place_text, f"KKT residual {residual:.1e} after {steps} steps")


def kkt_residual(
    compliance: Array,
    gap: Array,
    lever_arm: Array,
    torque: float,
    force: Array,
    rotation: float,
) -> float:
    """Compute the largest relative violation of balance, no tension, no penetration and complementarity.

    Parameters
    ----------
    compliance : (n, n) array
        m/N.
    gap : (n,) array
        m.
    lever_arm : (n,) array
        m.
    torque : float
        N m.
    force : (n,) array
        N.
    rotation : float
        rad.

    Returns
    -------
    float
        Violation, dimensionless.
    """
    distance = gap + compliance @ force - rotation * lever_arm
    is_pressed = force != 0.0
    scale = np.abs(rotation * lever_arm).max() + np.abs(gap[is_pressed]).max(initial=0.0)
    return float(
        max(
            abs(lever_arm @ force - torque) / torque,
            -force.min() / force.max(),
            -distance.min() / scale,
            np.abs(distance[is_pressed]).max(initial=0.0) / scale,
        )
    )
