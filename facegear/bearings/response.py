"""Energy, force and stiffness of a rolling bearing by the motion of its inner ring, and loads of elements."""

from dataclasses import dataclass

import numpy as np

from facegear._kernels import bearings as kernels
from facegear.arrays import AnyArray, Array, Mask
from facegear.bearings.elements import AnyBearing, BallBearing
from facegear.bearings.point_contact import PointContact
from facegear.errors import NotConverged
from facegear.rigid_body import MOTIONS

BALL_LIMIT, ROLLER_LIMIT = 4200e6, 4000e6
"""Largest pressure, Pa, that leaves an indentation of 1e-4 of an element's diameter (ISO 76)."""
ZONE_SAMPLES = 720
"""Angles at which the load zone is searched; its ends between them are halved to rounding."""
JUST_TOUCHING = 4e-15
"""Approach over the lengths that it is the difference of, dimensionless, that rounding may make."""
HALVINGS = 50
"""Halvings of the interval between two angles."""


@dataclass(frozen=True, eq=False)
class RingResponse:
    """Answer of a bearing to K motions, in x, y, z, tilt_x, tilt_y.

    Attributes
    ----------
    energy : (K,)
        J; 0 where nothing is loaded.
    force : (K, 5)
        Loads that hold the inner ring at its motion, the gradient of the energy, N and N m.
    stiffness : (K, 5, 5)
        Gradient of the force, N/m, N/rad and N m/rad.
    """

    energy: Array
    force: Array
    stiffness: Array


@dataclass(frozen=True, eq=False)
class ElementLoads:
    """Loads of the elements at K motions.

    Attributes
    ----------
    inner, outer : (K, Z m, n)
        Loads of each element on inner and outer ring in each of m places of the cage, in n slices (1 for
        balls), N.
    inner_angle, outer_angle : (K, Z m)
        Angle of the normal of both contacts from the radial direction, rad, positive where the inner ring
        presses towards +z.
    """

    inner: Array
    outer: Array
    inner_angle: Array
    outer_angle: Array

    @property
    def element_inner(self) -> Array:
        """Load of each element on the inner ring, (K, Z m), N."""
        return np.asarray(self.inner.sum(axis=-1))

    @property
    def is_loaded(self) -> Mask:
        """Elements that touch the inner ring, (K, Z m)."""
        return np.asarray(self.element_inner > 0.0)


def respond(bearing: AnyBearing, motion: AnyArray) -> RingResponse:
    """Compute energy, force and stiffness at many motions of the inner ring, all elements added.

    Parameters
    ----------
    bearing : BallBearing or RollerBearing
        The bearing.
    motion : (K, 5) array
        x, y, z (m), tilt_x, tilt_y (rad) of the inner ring against the outer one.

    Returns
    -------
    RingResponse
        Energies (K,), forces (K, 5) and tangents (K, 5, 5) in SI units.

    Raises
    ------
    NotConverged
        If an element under centrifugal force finds no position.
    """
    count = len(motion)
    energy, force = np.zeros(count), np.zeros((count, MOTIONS))
    stiffness = np.zeros((count, MOTIONS, MOTIONS))
    kernel = kernels.respond_balls if isinstance(bearing, BallBearing) else kernels.respond_rollers
    _require_positions(kernel(bearing.springs, np.asarray(motion, float), energy, force, stiffness))
    return RingResponse(energy, force, stiffness)


def element_loads(bearing: AnyBearing, motion: AnyArray) -> ElementLoads:
    """Compute the loads of all elements at many motions of the inner ring.

    Parameters
    ----------
    bearing : BallBearing or RollerBearing
        The bearing.
    motion : (K, 5) array
        x, y, z (m), tilt_x, tilt_y (rad) of the inner ring against the outer one.

    Returns
    -------
    ElementLoads
        Loads (K, Z m, n), N, and contact angles (K, Z m), rad, with m places of the cage.

    Raises
    ------
    NotConverged
        If an element under centrifugal force finds no position.
    """
    motions, cages = np.asarray(motion, float), bearing.cage_places
    count = bearing.elements * cages
    if isinstance(bearing, BallBearing):
        loads = np.zeros((len(motions), count, 4))
        _require_positions(kernels.write_ball_loads(bearing.springs, motions, loads))
        inner, outer, inner_angle, outer_angle = np.moveaxis(loads, -1, 0)
        return ElementLoads(cages * inner[..., None], cages * outer[..., None], inner_angle, outer_angle)
    slices = np.zeros((len(motions), count, bearing.slices, 2))
    _require_positions(kernels.write_roller_loads(bearing.springs, motions, slices))
    # The kernels' elements share the stiffness of one among the places of the cage.
    slices *= cages
    angle = np.full(slices.shape[:2], bearing.direction * bearing.contact_angle)
    return ElementLoads(slices[..., 0], slices[..., 1], angle, angle)


def _require_positions(missing_positions: int) -> None:
    """Raise NotConverged if a kernel could not find the position of some elements, whose number is given."""
    if missing_positions:
        elements_text = f"{missing_positions} of them"
        raise NotConverged("position of rolling elements", elements_text, "Newton's method")


def largest_pressures(bearing: AnyBearing, loads: ElementLoads) -> Array:
    """Return the largest Hertzian pressure at inner and outer ring, of point contacts or of slices.

    Parameters
    ----------
    bearing : BallBearing or RollerBearing
        The bearing.
    loads : ElementLoads
        Loads at K motions.

    Returns
    -------
    (K, 2) array
        Largest over elements and slices at inner (0) and outer ring (1), Pa.
    """
    inner, outer = loads.inner.max(axis=(1, 2)), loads.outer.max(axis=(1, 2))
    both_loads = np.stack([inner, outer], axis=-1)
    if isinstance(bearing, BallBearing):
        pairs = zip(bearing.contacts, both_loads.T, strict=True)
        return np.stack([_point_pressure(contact, load) for contact, load in pairs], axis=-1)
    line_load = both_loads * bearing.slices / bearing.effective_length
    gamma = np.array([bearing.pitch_ratio, -bearing.pitch_ratio])
    curvature = 2.0 / (bearing.element_diameter * (1.0 - gamma))
    return np.sqrt(line_load * curvature * bearing.modulus / (2.0 * np.pi))


def _point_pressure(contact: PointContact, load: Array) -> Array:
    """Return the largest pressure (Pa) of a contact ellipse at loads (K,), N."""
    ratio, (_, second) = contact.axis_ratio, contact.integrals
    volume = 6.0 * ratio**2 * second * load / (np.pi * contact.curvature * contact.modulus)
    area = np.pi * np.cbrt(volume) ** 2 / ratio
    return np.where(load > 0.0, 1.5 * load / np.where(load > 0.0, area, 1.0), 0.0)


def static_safety(bearing: AnyBearing, pressure: Array) -> Array:
    """Return the factor by which all loads of the hardest contact may grow to the pressure of ISO 76.

    Parameters
    ----------
    bearing : BallBearing or RollerBearing
        The bearing.
    pressure : (...) array
        Largest pressure, Pa. Loads grow with its cube for balls, with its square for rollers.

    Returns
    -------
    (...) array
        Factor, dimensionless; infinite without load.
    """
    limit, exponent = (BALL_LIMIT, 3.0) if isinstance(bearing, BallBearing) else (ROLLER_LIMIT, 2.0)
    is_loaded = pressure > 0.0
    return np.where(is_loaded, (limit / np.where(is_loaded, pressure, 1.0)) ** exponent, np.inf)


def largest_gap(bearing: AnyBearing) -> float:
    """Return the largest length of which contacts take a difference: rounding of forces is that of this
    length.

    Parameters
    ----------
    bearing : BallBearing or RollerBearing
        The bearing.

    Returns
    -------
    float
        m.
    """
    if isinstance(bearing, BallBearing):
        return bearing.groove_distance
    return abs(bearing.clearance) + float(bearing.drops.max())


def load_zone(bearing: AnyBearing, motion: Array) -> float:
    """Return the angle over which an element would be loaded, wherever the elements stand.

    Parameters
    ----------
    bearing : BallBearing or RollerBearing
        The bearing.
    motion : (5,) array
        Motion of the inner ring, m and rad.

    Returns
    -------
    float
        Sum of all such angles, rad, from 0 to 2 pi.
    """
    angles = 2.0 * np.pi * np.arange(ZONE_SAMPLES) / ZONE_SAMPLES
    least = JUST_TOUCHING * largest_gap(bearing)
    approach = _approach(bearing, motion, angles) - least
    beyond = np.roll(approach, -1)
    step = angles[1]
    whole = float(np.count_nonzero((approach > 0.0) & (beyond > 0.0)) * step)
    ends = np.flatnonzero((approach > 0.0) != (beyond > 0.0))
    low, high = np.zeros(ends.size), np.full(ends.size, step)
    rises = beyond[ends] > 0.0
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        is_before = (_approach(bearing, motion, angles[ends] + middle) > least) != rises
        low, high = np.where(is_before, middle, low), np.where(is_before, high, middle)
    return whole + float(np.where(rises, step - low, low).sum())


def _approach(bearing: AnyBearing, motion: Array, angles: Array) -> Array:
    """Return how far an element at each angle (n,), rad, is pressed in (n,), m, negative where it is free.

    It is the approach of both rings, or of the inner ring alone to an element that centrifugal force holds on
    the outer one; of rollers the largest over the slices.
    """
    x, y, z, tilt_x, tilt_y = motion
    cosine, sine = np.cos(angles), np.sin(angles)
    turn = tilt_x * sine - tilt_y * cosine
    if isinstance(bearing, BallBearing):
        springs = bearing.springs
        radial = springs.rest_radial + x * cosine + y * sine - springs.height * turn
        axial = springs.rest_axial + z + springs.arm * turn
        if not springs.centrifugal:
            return np.asarray(np.hypot(radial, axial) - springs.inner_length - springs.outer_length)
        top = springs.outer_length + (springs.centrifugal / springs.outer_stiffness) ** (2.0 / 3.0)
        return np.asarray(np.hypot(radial - top, axial) - springs.inner_length)
    rollers = bearing.springs
    ahead = rollers.normal_radial * (x * cosine + y * sine)
    ahead += rollers.normal_axial * (z + rollers.radius * turn) - rollers.clearance
    slices = ahead[:, None] - rollers.direction * np.outer(turn, rollers.positions)
    if rollers.centrifugal:
        return np.asarray((slices - rollers.free_position - rollers.drops).max(axis=1))
    return np.asarray((slices - 2.0 * rollers.drops).max(axis=1))
