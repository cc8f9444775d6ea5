"""Static equilibrium of a rolling bearing, by Newton's method over its energy.

The energy of elements and loads is convex: a line search finds its minimum from any start. A weak spring to
ground holds motions that nothing resists, and vanishes from step to step.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from facegear.arrays import Array
from facegear.bearings.elements import AnyBearing, BallBearing, RollerBearing, thrown_stiffness
from facegear.bearings.response import (
    ElementLoads,
    element_loads,
    largest_gap,
    largest_pressures,
    load_zone,
    respond,
    static_safety,
)
from facegear.errors import InvalidInput, NotConverged
from facegear.rigid_body import MOTIONS

TOLERANCE = 1e-12
"""Largest force out of balance over the largest load, dimensionless, at which a search ends."""
ROUNDINGS = 64.0
"""Roundings of the largest stiffness times the lengths that it multiplies by which forces may be out of
balance, dimensionless: searches end within 8 of them."""
STEPS = 300
"""Newton steps after which a search is given up; the hardest of the tests' random bearings needs 60."""
FIRST_TIE, TIE_FALL, LAST_TIE = 1e-1, 0.1, 1e-12
"""Spring to ground over the stiffness that the load would meet in one element, dimensionless: at first, its
factor from step to step, and at last."""
LINE_STEPS = 200
"""Evaluations along one step; the bracket is at rounding after 60 halvings."""
NARROW = 1e-14
"""Width of the bracket along a step over its end, dimensionless, at which rounding decides."""
CLOSE = 1e-3
"""Part of the slope at the beginning of a step that may remain at its end, dimensionless."""
ESCAPE = 0.25
"""Motion over the diameter of an element, dimensionless, beyond which loads drive the rings apart: contacts
of steel give way by some thousandths of it."""
LIFTED = 1e-6
"""Load of an element over the hardest one, dimensionless, below which its contact angle does not count."""


@dataclass(frozen=True, eq=False)
class Curvature:
    """Energy of bearings (and of a bent shaft) at a motion, with its first and second derivatives.

    Attributes
    ----------
    energy
        J, without the work of the load.
    gradient : (n,)
        Loads that hold the motion, N and N m.
    matrix : (n, n)
        N/m, N/rad and N m/rad.
    size, rounding
        Largest force that adds to the gradient, and the error of forces by rounding, N; moments by their
        arms.
    """

    energy: float
    gradient: Array
    matrix: Array
    size: float
    rounding: float


def minimise(
    derivatives: Callable[[Array], Curvature],
    start: Array,
    load: Array,
    scale: Array,
    tie: float,
    reach: float,
) -> Array:
    """Find the motion at which a convex energy less the work of a load is least, by Newton's method.

    A spring to ground is added to the matrix of each step alone and fades, so that it does not move the
    result.

    Parameters
    ----------
    derivatives : callable
        Takes a motion (n,), m and rad, and returns the energy's derivatives there as a `Curvature`.
    start : (n,) array
        Motion at which the search begins, m and rad.
    load : (n,) array
        Constant load along each motion, N and N m.
    scale : (n,) array
        Arm of each motion, m for rotations and 1 for shifts, with which motions and loads become m and N.
    tie : float
        Stiffness that the load would meet in one element, N/m.
    reach : float
        Largest motion, in scaled m, that is searched; a load that still drives beyond it is not held.

    Returns
    -------
    (n,) array
        The motion, m and rad.

    Raises
    ------
    NotConverged
        If nothing holds the load, or forces stay out of balance.
    """
    motion, curve = start.copy(), derivatives(start)
    size = max(float(np.abs(load / scale).max()), 1e-300)
    part = FIRST_TIE
    for _ in range(STEPS):
        error = (curve.gradient - load) / scale
        matrix = curve.matrix / np.outer(scale, scale)
        force = max(size, curve.size)
        if float(np.abs(error).max()) <= TOLERANCE * force + curve.rounding:
            return motion
        spring = part * max(tie, LAST_TIE * float(np.abs(matrix).max())) * np.eye(error.size)
        step = np.linalg.solve(matrix + spring, -error) / scale
        slope = float(error @ (step * scale))
        motion, curve = _search_line(derivatives, motion, step, load, slope, reach / scale)
        part = max(TIE_FALL * part, LAST_TIE)
    worst = float(np.abs(error).max() / force)
    raise NotConverged("equilibrium of bearings", f"{worst:.1e} of the load", f"{STEPS} Newton steps")


def _search_line(
    derivatives: Callable[[Array], Curvature],
    motion: Array,
    step: Array,
    load: Array,
    start: float,
    reach: Array,
) -> tuple[Array, Curvature]:
    """Return the motion (n,) along a step at which energy less work of the load is least, and the curvature
    there.

    `start` is the derivative at the beginning of the step, J, of which CLOSE may remain; `reach` (n,) bounds
    each motion, m and rad. Steps along the line are Newton's, or halve the bracket where these leave it.
    """
    moves = step != 0.0
    with np.errstate(over="ignore"):
        fractions = np.where(step > 0.0, reach - motion, reach + motion)[moves] / np.abs(step[moves])
    limit = max(float(fractions.min(initial=np.inf)), 0.0)
    low, high, fraction, is_bracketed = 0.0, limit, min(1.0, limit), False
    for _ in range(LINE_STEPS):
        curve = derivatives(motion + fraction * step)
        slope = float((curve.gradient - load) @ step)
        if abs(slope) <= CLOSE * abs(start) or (is_bracketed and high - low <= NARROW * high):
            break
        if slope < 0.0:
            if fraction >= limit:
                raise NotConverged("equilibrium of bearings", "the given loads", "nothing holds them")
            low = fraction
        else:
            high, is_bracketed = fraction, True
        curvature = float(step @ curve.matrix @ step)
        ahead = fraction - slope / curvature if curvature > 0.0 else np.inf
        if is_bracketed:
            fraction = ahead if low < ahead < high else 0.5 * (low + high)
        else:
            fraction = min(max(ahead, 1.5 * fraction), 10.0 * fraction, limit)
    return motion + fraction * step, curve


@dataclass(frozen=True, eq=False)
class BearingState:
    """A bearing at a motion of its inner ring against the outer one.

    Attributes
    ----------
    bearing
        The bearing.
    motion : (5,)
        x, y, z (m), tilt_x, tilt_y (rad).
    force : (5,)
        Load of the shaft on the inner ring that holds it there, N and N m.
    stiffness : (5, 5)
        Derivative of `force` by `motion`, N/m, N/rad and N m/rad.
    """

    bearing: AnyBearing
    motion: Array
    force: Array
    stiffness: Array

    @cached_property
    def loads(self) -> ElementLoads:
        """Loads and contact angles of all elements at this motion, with K = 1 in all shapes."""
        return element_loads(self.bearing, self.motion[None])

    @property
    def hardest_load(self) -> float:
        """Largest load of one element on the inner ring, its slices added, N."""
        return float(self.loads.element_inner.max())

    @property
    def loaded_elements(self) -> int:
        """Number of elements that touch the inner ring, the largest one of all places of the cage."""
        is_loaded = self.loads.is_loaded[0].reshape(self.bearing.elements, self.bearing.cage_places)
        return int(is_loaded.sum(axis=0).max())

    @property
    def zone(self) -> float:
        """Angle of the circumference within which an element would be loaded, rad (`load_zone`)."""
        return load_zone(self.bearing, self.motion)

    @property
    def pressures(self) -> Array:
        """Largest Hertzian pressure of any element (slice) at inner and outer ring, (2,), Pa."""
        return largest_pressures(self.bearing, self.loads)[0]

    @property
    def static_safety(self) -> float:
        """Factor by which all loads may grow up to the pressure limit of ISO 76, the smaller one of both
        rings,
        dimensionless; infinite without load.
        """
        return float(static_safety(self.bearing, self.pressures).min())

    @property
    def contact_angles(self) -> tuple[float, float]:
        """Smallest and largest angle of the loaded contacts, rad, positive on the side of the thrust that
        loads the bearing; both are the nominal contact angle where no element is loaded.
        """
        element_load = self.loads.element_inner[0]
        counts = element_load > LIFTED * element_load.max()
        angles = np.concatenate([self.loads.inner_angle[0][counts], self.loads.outer_angle[0][counts]])
        if angles.size == 0:
            return self.bearing.contact_angle, self.bearing.contact_angle
        ahead = self.bearing.direction * angles
        return float(ahead.min()), float(ahead.max())

    @property
    def is_on_wrong_side(self) -> bool:
        """Whether a ball of an angular contact bearing presses where its ring has no shoulder."""
        is_angular = isinstance(self.bearing, BallBearing) and self.bearing.contact_angle > 0.0
        return is_angular and self.contact_angles[0] < 0.0


def state_at(bearing: AnyBearing, motion: Array) -> BearingState:
    """Return force and tangent stiffness of a bearing at a given motion of its inner ring; nothing is
    searched.

    Parameters
    ----------
    bearing : BallBearing or RollerBearing
        The bearing.
    motion : (5,) array
        x, y, z (m), tilt_x, tilt_y (rad) of the inner ring against the outer one.

    Returns
    -------
    BearingState
        The state.
    """
    response = respond(bearing, motion[None])
    return BearingState(bearing, motion, response.force[0], response.stiffness[0])


def bearing_curve(bearing: AnyBearing, motion: Array) -> Curvature:
    """Return the energy of a bearing and its derivatives at a motion of the inner ring, as `minimise` needs
    them.

    Parameters
    ----------
    bearing : BallBearing or RollerBearing
        The bearing.
    motion : (5,) array
        x, y, z (m), tilt_x, tilt_y (rad).

    Returns
    -------
    Curvature
        Energy (J), gradient (N and N m), matrix (N/m, N/rad and N m/rad), and the rounding (N) that
        lengths leave in the forces.
    """
    response, scale = respond(bearing, motion[None]), _scale(bearing.pitch_diameter)
    force, stiffness = response.force[0], response.stiffness[0]
    length = max(largest_gap(bearing), float(np.abs(motion * scale).max()))
    largest = float(np.abs(stiffness / np.outer(scale, scale)).max())
    # Centrifugal force stiffens the outer contacts, by which positions of the elements are rounded.
    largest = max(largest, thrown_stiffness(bearing))
    rounding = ROUNDINGS * np.finfo(float).eps * largest * length
    return Curvature(
        float(response.energy[0]), force, stiffness, float(np.abs(force / scale).max()), rounding
    )


def find_equilibrium(bearing: AnyBearing, load: Array, start: Array | None = None) -> BearingState:
    """Find the motion at which a bearing carries a load.

    Motions that the load does not determine, such as those of a ring that is loose in its clearance, stay
    where the search begins.

    Parameters
    ----------
    bearing : BallBearing or RollerBearing
        The bearing.
    load : (5,) array
        Forces (N) and moments (N m) on the inner ring.
    start : (5,) array, optional
        Motion at which the search begins, m and rad; 0 by default.

    Returns
    -------
    BearingState
        The bearing where its `force` is the load to TOLERANCE.

    Raises
    ------
    InvalidInput
        If a cylindrical roller bearing is to carry thrust, or an angular contact ball bearing has none that
        presses its rings together.
    NotConverged
        If nothing holds the load.
    """
    scale = _scale(bearing.pitch_diameter)
    size = float(np.abs(load / scale).max())
    if isinstance(bearing, RollerBearing) and not bearing.contact_angle and abs(load[2]) > TOLERANCE * size:
        requirement = "0 N: flanges of cylindrical roller bearings carry nothing here"
        raise InvalidInput("thrust of a cylindrical roller bearing", float(load[2]), requirement)

    def derivatives(motion: Array) -> Curvature:
        """Return the energy of the bearing and its derivatives at a motion (5,), m and rad."""
        return bearing_curve(bearing, motion)

    begin = np.zeros(MOTIONS) if start is None else start
    tie, reach = bearing.stiffness_at(max(size, 1.0)), ESCAPE * bearing.element_diameter
    state = state_at(bearing, minimise(derivatives, begin, load, scale, tie, reach))
    if state.is_on_wrong_side:
        axis = "+z" if bearing.direction > 0 else "-z"
        requirement = f"along {axis} and large enough to press all loaded balls against their shoulders"
        raise InvalidInput("thrust of an angular contact ball bearing", float(load[2]), requirement)
    return state


def _scale(pitch_diameter: float) -> Array:
    """Return the arms (5,) by which x, y, z, tilt_x and tilt_y compare: 1 thrice, and half the pitch
    diameter (m).
    """
    return np.array([1.0, 1.0, 1.0, 0.5 * pitch_diameter, 0.5 * pitch_diameter])
