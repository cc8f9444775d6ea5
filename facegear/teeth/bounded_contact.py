"""Unloaded contact within the edges of both flanks: the path of any family, and modified pinions by search.

The contact line of unmodified flanks is cut with the edges. With a modified pinion, a point of its flank asks
for the gear angle at which it lies on the gear's flank; pinion and gear touch where that angle is largest.
The search starts on the contact line of the unmodified flanks.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import copysign, hypot, sin, sqrt

import numpy as np
from numpy.typing import ArrayLike

from facegear.arrays import Array, Integers, Mask
from facegear.errors import NotConverged
from facegear.teeth.design import AssemblyErrors
from facegear.teeth.family_contact import NOMINAL, ContactLine, contact_line
from facegear.teeth.generated_fillet import flank_end
from facegear.teeth.helicoid import pinion_start, tip_distance
from facegear.teeth.tooth_family import ToothFamily

Removal = Callable[[Array, Array], Array]
"""Depth (m) taken off along the nominal normal, by transverse length of roll (m) and place y (m)."""

PAIRS = np.arange(-2, 3)
"""Tooth pairs that are looked at."""
STENCIL = np.array(
    [[1, 0], [-1, 0], [2, 0], [-2, 0], [0, 1], [0, -1], [0, 2], [0, -2], [1, 1], [-1, -1], [0, 0]], float
)
"""Steps across and along the flank from which slope (to the fourth order) and curvature are taken."""
ACROSS, ALONG = 0.003, 0.12
"""Lengths of these steps in normal modules: both change the gap by some 1e-6 modules, far above rounding."""
STEPS = 40
"""Newton steps after which a search counts as failed."""
CLOSE = 1e-5
"""Part of a step of the stencil that ends the search; an error of the place counts only squared."""


@dataclass(frozen=True)
class ContactPath:
    """Part of a contact line inside both flanks and both faces.

    first, last: ends s along the normal (m), from the gear's tip to its root. first_edge, last_edge: which
    edge ends it there, such as "gear tip" or "pinion outer end". pitch: base pitch along the normal, m.
    """

    line: ContactLine
    pitch: float
    first: float
    last: float
    first_edge: str
    last_edge: str

    @property
    def contact_ratio(self) -> float:
        """Length over the base pitch; negative where no part of the line lies on both flanks."""
        return (self.last - self.first) / self.pitch

    @property
    def middle(self) -> float:
        """Mean of both ends s, m."""
        return (self.first + self.last) / 2


def contact_path(family: ToothFamily, line: ContactLine) -> ContactPath:
    """Cut a contact line with the tips, roots and ends of both flanks.

    Parameters
    ----------
    family : ToothFamily
        Pair of gears.
    line : ContactLine
        The line of a pose.

    Returns
    -------
    ContactPath
        Its part on both flanks; `first` exceeds `last` where there is none.
    """
    helicoid, side, lead = line.helicoid, line.helicoid.side, line.pinion_lead
    foot_y, taper = line.pinion_place, family.taper
    tip_radius = family.pinion_flank_radius + (foot_y - family.middle) * taper
    start = float(pinion_start(family, side, foot_y))
    growth = helicoid.cosine - taper * helicoid.sine / sin(helicoid.pressure_angle)
    lower = [
        (_tip_crossing(family, line), "gear tip"),
        (0.0, "start of the gear's involute"),
        (max(start / growth, 0.0) - lead, "pinion root"),
    ]
    upper = [
        (float(flank_end(family, side, line.psi)), "gear root"),
        (float(tip_distance(helicoid, tip_radius, taper)) - lead, "pinion tip"),
    ]
    if helicoid.sine != 0.0:
        half = copysign(family.width / 2, helicoid.sine)
        names = ("pinion inner end", "pinion outer end")[:: 1 if half > 0 else -1]
        ends = ((family.middle + at - foot_y) / helicoid.sine - lead for at in (-half, half))
        lower.append((next(ends), names[0]))
        upper.append((next(ends), names[1]))
    elif abs(foot_y - family.middle) > family.width / 2:
        upper.append((-np.inf, "pinion inner end" if foot_y < family.middle else "pinion outer end"))
    first, last = max(lower), min(upper)
    outside = _radius_crossings(line, family.outer_radius)
    if outside is None:
        last = min(last, (-np.inf, "gear outer end"))
    else:
        first, last = max(first, (outside[0], "gear outer end")), min(last, (outside[1], "gear outer end"))
    inside = _radius_crossings(line, family.inner_radius)
    if inside is not None:
        # the line dives below the inner cylinder: keep the longer of the parts on either side
        before, after = min(last[0], inside[0]) - first[0], last[0] - max(first[0], inside[1])
        if before >= after:
            last = min(last, (inside[0], "gear inner end"))
        else:
            first = max(first, (inside[1], "gear inner end"))
    pitch = 2 * np.pi * line.base_pitch / family.pinion_teeth
    return ContactPath(line, pitch, first[0], last[0], first[1], last[1])


def _tip_crossing(family: ToothFamily, line: ContactLine) -> float:
    """Return s (m) at which the line passes the gear's tip surface, by Newton's method."""
    tip, foot, normal = family.gear_tip, line.foot, line.normal
    s = float(tip.height(family.inner_radius) - foot[2]) / normal[2]
    for _ in range(STEPS):
        x, y = foot[0] + s * normal[0], foot[1] + s * normal[1]
        radius = hypot(x, y)
        residual = foot[2] + s * normal[2] - float(tip.height(radius))
        step = residual / (normal[2] - tip.slope * (x * normal[0] + y * normal[1]) / radius)
        s -= step
        if abs(step) < 1e-16:
            break
    return s


def _radius_crossings(line: ContactLine, radius: float) -> tuple[float, float] | None:
    """Return both s (m), in rising order, at which the line passes a cylinder of a radius (m) about the
    gear's axis, None where it does not.
    """
    foot, normal = line.foot, line.normal
    square = normal[0] ** 2 + normal[1] ** 2
    half = (foot[0] * normal[0] + foot[1] * normal[1]) / square
    inside = half**2 - (foot[0] ** 2 + foot[1] ** 2 - radius**2) / square
    if inside <= 0.0:
        return None
    return -half - sqrt(inside), -half + sqrt(inside)


@dataclass(frozen=True, eq=False)
class ModifiedContact:
    """Unloaded contact at p pinion angles (p,).

    transmission_error: along the normal (m), positive ahead; nan where no pair touches within its flanks.
    pair: number of the pair that touches. roll, y: where it does on the pinion, m.
    """

    transmission_error: Array
    pair: Integers
    roll: Array
    y: Array


def modified_contact(
    family: ToothFamily,
    side: int,
    pinion_angle: ArrayLike,
    removal: Removal,
    errors: AssemblyErrors = NOMINAL,
) -> ModifiedContact:
    """Compute the unloaded contact of a pinion with modified flanks by search; contact at edges is left out.

    Parameters
    ----------
    family : ToothFamily
        Pair of gears.
    side : int
        Sign of the flank: +1 drive, -1 coast.
    pinion_angle : (p,) array_like
        Pinion angle, rad.
    removal : Removal
        Takes roll and y (m) and returns the depth taken off the pinion, m.
    errors : AssemblyErrors
        Errors of assembly; none by default.

    Returns
    -------
    ModifiedContact
        Transmission error, touching pair and its place on the pinion at each angle.

    Raises
    ------
    NotConverged
        Where the unmodified flanks have no contact line, or the search does not end.
    """
    line = contact_line(family, side, errors)
    if line is None:
        raise NotConverged("unloaded contact", "this assembly", "a line of contact of the unmodified flanks")
    angle = np.atleast_1d(np.asarray(pinion_angle, float))
    turned_on = angle[:, None] + PAIRS * (2 * np.pi / family.pinion_teeth)
    search = _Search(family, line, removal)
    error, roll, y, is_inside = (part.reshape(turned_on.shape) for part in search.touch(turned_on.ravel()))
    lever = line.base_pitch / family.motion.ratio
    ahead = np.where(is_inside, side * error, -np.inf)
    rows, best = np.arange(angle.size), np.argmax(ahead, axis=1)
    has_contact = np.isfinite(ahead[rows, best])
    return ModifiedContact(
        transmission_error=np.where(has_contact, error[rows, best] * lever, np.nan),
        pair=PAIRS[best],
        roll=roll[rows, best],
        y=y[rows, best],
    )


@dataclass(frozen=True, eq=False)
class _Search:
    """Search of the contact of pairs one by one, from the contact line of the unmodified flanks."""

    family: ToothFamily
    line: ContactLine
    removal: Removal

    def touch(self, angle: Array) -> tuple[Array, Array, Array, Mask]:
        """Return the gear's error (rad), roll and y (m), and whether contact is on both flanks, at angles
        (n,).

        The place on the pinion is where the gear angle of `error` is stationary, by Newton's method on
        STENCIL.
        """
        line, helicoid = self.line, self.line.helicoid
        rolled_angle = line.pinion_slope + helicoid.side * angle + helicoid.phase
        from_base = helicoid.cosine * helicoid.base_radius * rolled_angle
        from_base = from_base - helicoid.sine * (line.pinion_place - helicoid.middle)
        roll, y = helicoid.cosine * from_base, line.pinion_place + helicoid.sine * from_base
        path, reach = contact_path(self.family, line), self.family.rack.normal_module
        ends = path.first + line.pinion_lead - reach, path.last + line.pinion_lead + reach
        is_near = (from_base > ends[0]) & (from_base < ends[1])
        across_step, along_step = ACROSS * reach, ALONG * reach
        psi = np.full(angle.shape, line.psi)
        is_done = ~is_near
        for _ in range(STEPS):
            rows = np.flatnonzero(~is_done)
            if not rows.size:
                break
            at_roll = roll[rows, None] + STENCIL[:, 0] * across_step
            at_y = y[rows, None] + STENCIL[:, 1] * along_step
            value, slopes, _ = self.error(angle[rows, None], at_roll, at_y, psi[rows, None])
            step = _newton_step(value)
            largest = np.abs(step).max(axis=1)
            step *= np.minimum(1.0, 20.0 / np.maximum(largest, 1e-300))[:, None]
            roll[rows] += step[:, 0] * across_step
            y[rows] += step[:, 1] * along_step
            psi[rows] = slopes[:, -1]
            is_lost = ~np.isfinite(step).all(axis=1)
            is_done[rows] = (largest < CLOSE) | is_lost
            roll[rows[is_lost]], psi[rows[is_lost]] = np.nan, line.psi
        if not is_done.all():
            raise NotConverged("unloaded contact", "a modified pinion", f"{STEPS} Newton steps")
        error, slope, is_inside = self.error(angle, roll, y, psi)
        return error, roll, y, is_inside & is_near & np.isfinite(error) & np.isfinite(slope)

    def error(self, angle: Array, roll: Array, y: Array, near: Array) -> tuple[Array, Array, Mask]:
        """Return by how much the gear angle at which points of the pinion lie on the gear's flank exceeds the
        conjugate one (rad), the slope psi on the gear there, and whether the points lie on both flanks.

        `angle` (rad), `roll` and `y` (m) of the points are broadcast together; `near` is a start for psi
        (rad).
        """
        line, family, helicoid = self.line, self.family, self.line.helicoid
        side, base = helicoid.side, helicoid.base_radius
        motion, middle = line.posed_frame
        along = y - helicoid.middle
        psi = (roll + helicoid.lead * along) / base - side * angle - helicoid.phase
        c, s = np.cos(psi), np.sin(psi)
        across, depth = helicoid.cosine, self.removal(roll, y)
        local = np.stack(
            [
                side * (roll * c - base * s - depth * across * c),
                along - depth * helicoid.sine,
                -(base * c + roll * s) + depth * across * s,
            ],
            axis=-1,
        )
        point = local @ motion.basis + np.array(middle)
        radius, height = np.hypot(point[..., 0], point[..., 1]), point[..., 2]
        slope, length = line.gear.search(radius, height, near)
        opposite = line.gear.point(slope, length)
        turn = np.arctan2(point[..., 0], point[..., 1]) - np.arctan2(opposite[..., 0], opposite[..., 1])
        tip_radius = family.pinion_flank_radius + along * family.taper
        is_inside = (
            (roll >= np.maximum(pinion_start(family, side, y), 0.0))
            & (base**2 + roll**2 <= tip_radius**2)
            & (np.abs(along) <= family.width / 2)
            & (radius >= family.inner_radius)
            & (radius <= family.outer_radius)
            & (height <= family.gear_tip.height(radius))
            & (length >= 0.0)
            & (length <= flank_end(family, side, slope))
        )
        return turn - angle * family.motion.ratio, slope, is_inside


def _newton_step(value: Array) -> Array:
    """Return the step (n, 2) across and along, in steps of the stencil, to where values (n, 11) on
    STENCIL are stationary.
    """
    right, left, right_2, left_2, up, down, up_2, down_2, corner, opposite, centre = value.T
    x_slope = (8 * (right - left) - (right_2 - left_2)) / 12
    y_slope = (8 * (up - down) - (up_2 - down_2)) / 12
    xx, yy = right + left - 2 * centre, up + down - 2 * centre
    xy = (corner + opposite - right - left - up - down + 2 * centre) / 2
    scale = xx * yy - xy**2
    with np.errstate(divide="ignore", invalid="ignore"):
        x = (xy * y_slope - yy * x_slope) / scale
        y = (xy * x_slope - xx * y_slope) / scale
    return np.stack([x, y], axis=-1)
