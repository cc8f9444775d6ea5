"""Unloaded contact of flanks without modifications, in closed form for every assembly.

A pinion of the same base pitch runs conjugate with the gear wherever it stands: all contact is on one normal,
with one slope psi, and the transmission error is constant. Contact of teeth without a helix stays at one
place y along the pinion's axis. `family_contact` solves for that normal; here are the numbers of a pair that
poses of machines store.
"""

from dataclasses import astuple, dataclass, replace
from functools import cached_property, lru_cache
from math import acos, cos, pi, sin
from typing import Self

import numpy as np
from numpy.typing import ArrayLike

from facegear.arrays import Array
from facegear.teeth.bounded_contact import contact_path
from facegear.teeth.design import AssemblyErrors, PairDesign
from facegear.teeth.family_contact import ContactLine, contact_line, find_line, place_line
from facegear.teeth.flank_shapes import GearModifications
from facegear.teeth.generated_flank import GearFlank
from facegear.teeth.pitch_line import pitch_line_y
from facegear.teeth.tooth_family import Helicoid, RelativeMotion

STEPS = 60
"""Newton steps after which a search counts as failed."""
GEAR_ENDS = ("gear inner end", "gear outer end")
"""Edges of a path at which another contact than that of the flanks follows."""


@dataclass(frozen=True)
class PairNumbers:
    """Numbers of a pair's drive flanks that the closed form and the ends of the faces need; m and rad.

    pressure_angle: in the transverse section. mean_radius: place y of the middle of the pinion's face, at
    which half base and half space angle count. first_end, last_end: ends of the common face, places y along
    the pinion's axis, counted on a pinion that stands outwards by its assembly. base_helix_sine: signed sine
    of the base helix angle.
    """

    pressure_angle: float
    pinion_teeth: float
    pinion_base_radius: float
    pinion_half_base_angle: float
    shaper_base_radius: float
    shaper_half_space_angle: float
    shaper_lift: float
    gear_base_radius: float
    mean_radius: float
    first_end: float
    last_end: float
    base_helix_sine: float = 0.0
    shaft_angle: float = pi / 2
    offset: float = 0.0

    @classmethod
    def of_design(cls, design: PairDesign) -> Self:
        """Return the numbers of a design.

        Parameters
        ----------
        design : PairDesign
            Pair of gears.

        Returns
        -------
        PairNumbers
            Numbers in m and rad.
        """
        half, face, outwards = design.pinion.width / 2, design.face_gear, design.assembly.pinion_axial
        inner, outer = (
            pitch_line_y(design.family, [face.inner_radius, face.outer_radius]) - outwards
        ).tolist()
        return cls(
            pressure_angle=design.transverse_pressure_angle,
            pinion_teeth=float(design.pinion.teeth),
            pinion_base_radius=design.pinion_base_radius,
            pinion_half_base_angle=design.pinion_half_base_angle,
            shaper_base_radius=design.shaper_base_radius,
            shaper_half_space_angle=design.shaper_half_space_angle,
            shaper_lift=design.shaper_lift,
            gear_base_radius=design.gear_base_radius,
            mean_radius=design.middle,
            first_end=max(inner, design.middle - half),
            last_end=min(outer, design.middle + half),
            base_helix_sine=design.family.pinion_flanks[0].sine,
            shaft_angle=design.shaft_angle,
            offset=design.offset,
        )

    @classmethod
    def of_array(cls, values: Array) -> Self:
        """Rebuild the numbers from `array`.

        Parameters
        ----------
        values : (14,) array
            Numbers in m and rad, in the order of the fields.

        Returns
        -------
        PairNumbers
            The numbers.
        """
        return cls(*(float(value) for value in values))

    @property
    def array(self) -> Array:
        """All numbers as one array (14,) in the order of the fields, m and rad; `of_array` reads it."""
        return np.array(astuple(self))

    @property
    def normal_arm(self) -> float:
        """Torque on the pinion over the force along the drive flank's normal, m."""
        return self._pinion.base_radius * self._pinion.cosine

    @cached_property
    def _pinion(self) -> Helicoid:
        """Drive flank of the pinion as an involute helicoid."""
        phase = self.pinion_half_base_angle - pi / self.pinion_teeth
        return self._helicoid(self.pinion_base_radius, phase, self.pinion_teeth)

    @cached_property
    def axes(self) -> RelativeMotion:
        """Nominal motion of the pinion against the gear, in the mesh frame."""
        return self._against_gear(self.pinion_base_radius)

    @cached_property
    def _gear(self) -> GearFlank:
        """Drive flank of the gear as its shaper generates it."""
        teeth = self.pinion_teeth * self.shaper_base_radius / self.pinion_base_radius
        shaper = self._helicoid(self.shaper_base_radius, -self.shaper_half_space_angle, teeth)
        return GearFlank(shaper, self._against_gear(self.shaper_base_radius), self.shaper_lift)

    def _against_gear(self, base_radius: float) -> RelativeMotion:
        """Return the motion against the gear of a pinion or shaper with a base radius (m)."""
        return RelativeMotion(base_radius / self.gear_base_radius, self.shaft_angle, self.offset)

    def _helicoid(self, base_radius: float, phase: float, teeth: float) -> Helicoid:
        """Return the drive flank with a base radius (m), a phase (rad, see `Helicoid`) and so many teeth."""
        return Helicoid(
            side=1,
            pitch_radius=base_radius / cos(self.pressure_angle),
            base_radius=base_radius,
            pressure_angle=self.pressure_angle,
            sine=self.base_helix_sine,
            half_base_angle=phase + pi / teeth,
            phase=phase,
            middle=self.mean_radius,
        )

    def contact_line(self, errors: AssemblyErrors) -> ContactLine | None:
        """Compute the line on which all contact of the drive flanks runs in an assembly, edges left out.

        Parameters
        ----------
        errors : AssemblyErrors
            Errors of the assembly.

        Returns
        -------
        ContactLine, optional
            The line; None as for `contact_at`.
        """
        if self.shaper_lift <= 0.0:
            return None
        line = find_line(self._gear, self._pinion, self.axes, errors)
        return line if line is not None and line.psi > 0.0 else None

    def place_line(self, errors: AssemblyErrors, psi: float, turn: float) -> ContactLine:
        """Return the line of contact in an assembly by its slope and turn, with no search.

        Parameters
        ----------
        errors : AssemblyErrors
            Errors of the assembly.
        psi : float
            Slope of the line, rad.
        turn : float
            Turn of the line about the gear's axis against that of the gear, rad.

        Returns
        -------
        ContactLine
            The line.
        """
        return place_line(self._gear, self._pinion, self.axes, errors, psi, turn)

    def path_at(self, psi: float, errors: AssemblyErrors) -> float:
        """Return `ConjugateContact.path` of the gear's normal with a slope, where no error turns it.

        Parameters
        ----------
        psi : float
            Slope of the normal, rad.
        errors : AssemblyErrors
            Errors of the assembly.

        Returns
        -------
        float
            Place along the pinion's axis, m.
        """
        return _contact_of(self.place_line(errors, psi, 0.0)).path


@dataclass(frozen=True)
class ConjugateContact:
    """Contact of the drive flanks, extended beyond their edges; it is the same at every pinion angle.

    Attributes
    ----------
    psi
        Slope of the common normal against the plane of the gear (rad), the pressure angle there.
    turn
        Of that normal about the gear's axis (rad).
    transmission_error
        (phi2 - phi1 N1 / N2) times `PairDesign.gear_normal_arm`, along the line of action, m, as in
        `UnloadedContact`.
    y
        Place along the pinion's axis, counted on the pinion, where the normal touches its base cylinder (m);
        without a helix that of the contact.
    normal_roll
        Turn (rad) of the normal of pair 0 about the pinion's axis at phi1 = 0 since the involute began at y =
        middle; without a helix the roll angle of its contact.
    path
        Place along the pinion's axis, counted on the pinion, where the normal passes the pitch point of its
        involute (m), about the middle of the path; without a helix `y`.
    """

    def pinion_place(self, helicoid: Helicoid, turn: ArrayLike) -> tuple[Array, Array]:
        """Compute where the contact is on the pinion after a turn.

        Parameters
        ----------
        helicoid : Helicoid
            Drive flank of the pinion.
        turn : (...) array_like
            Turn of the pinion's tooth from pair 0 at phi1 = 0, rad.

        Returns
        -------
        tuple of (...) arrays
            Roll angle, rad, and y, m.
        """
        angle = helicoid.cosine * (self.normal_roll + np.asarray(turn, float))
        angle = angle - helicoid.sine * (self.y - helicoid.middle) / helicoid.base_radius
        return helicoid.cosine * angle, self.y + helicoid.sine * helicoid.base_radius * angle

    psi: float
    turn: float
    transmission_error: float
    y: float
    normal_roll: float
    path: float


def conjugate_contact(design: PairDesign) -> ConjugateContact | None:
    """Compute `contact_at` for a design with its own assembly errors.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    ConjugateContact, optional
        Contact in m and rad, or None.
    """
    return contact_at(PairNumbers.of_design(design), design.assembly)


def contact_at(pair: PairNumbers, errors: AssemblyErrors) -> ConjugateContact | None:
    """Compute the unloaded contact of unmodified drive flanks, continued without end, in an assembly.

    Parameters
    ----------
    pair : PairNumbers
        Numbers of the pair.
    errors : AssemblyErrors
        Errors of the assembly.

    Returns
    -------
    ConjugateContact, optional
        Contact in m and rad; None where no normal of the flanks touches, and where teeth touch along lines
        that an assembly error turns into an edge (as many teeth of the shaper as of the pinion).
    """
    line = pair.contact_line(errors)
    return None if line is None else _contact_of(line)


def pitch_roll(helicoid: Helicoid) -> float:
    """Return the transverse length of roll of an involute at its pitch radius.

    Parameters
    ----------
    helicoid : Helicoid
        Flank of a pinion.

    Returns
    -------
    float
        m.
    """
    return helicoid.pitch_radius * sin(helicoid.pressure_angle)


def _contact_of(line: ContactLine) -> ConjugateContact:
    """Return the numbers of a contact line in the signs of `ConjugateContact` (its turn is the line's
    reversed).
    """
    helicoid, y = line.helicoid, line.pinion_place
    path = y + helicoid.lead * pitch_roll(helicoid)
    roll = line.pinion_slope + helicoid.phase
    return ConjugateContact(line.psi, -line.turn, line.transmission_error, y, roll, path)


@lru_cache(maxsize=256)
def exact_contact(design: PairDesign) -> ConjugateContact | None:
    """Return `conjugate_contact` if it is the real contact of the teeth, else None.

    It holds where a whole pitch of the contact path lies on both flanks, within both faces.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    ConjugateContact, optional
        Contact in m and rad; None where a flank is modified or ends before.
    """
    if not without_modifications(design):
        return None
    line = contact_line(design.family, 1, design.assembly)
    if line is None or design.shaper_lift <= 0.0 or line.psi <= 0.0:
        return None
    path = contact_path(design.family, line)
    if path.contact_ratio < 1.0 or path.first_edge in GEAR_ENDS or path.last_edge in GEAR_ENDS:
        return None
    return _contact_of(line)


def offset_for(pair: PairNumbers, path: float, errors: AssemblyErrors) -> float | None:
    """Compute the offset with which `ConjugateContact.path` is at a position along the pinion, by Newton's
    method.

    Parameters
    ----------
    pair : PairNumbers
        Numbers of the pair.
    path : float
        Position of the contact along the pinion, m.
    errors : AssemblyErrors
        Errors of the assembly, of which the offset is not used.

    Returns
    -------
    float, optional
        Offset, m; None where there is none.
    """
    lift, step = pair.shaper_lift, 1e-7
    offset = 0.0
    if pair.base_helix_sine == 0.0 and path > pair.gear_base_radius:
        psi = acos(pair.gear_base_radius / path)
        offset = ((lift - errors.gear_axial) * cos(psi) - lift * cos(pair.pressure_angle)) / sin(psi)
    for _ in range(STEPS):
        near = [contact_at(pair, replace(errors, offset=at)) for at in (offset, offset + step)]
        if near[0] is None or near[1] is None:
            return None
        path_error = near[0].path - path
        if abs(path_error) < 1e-12:
            return offset
        offset -= path_error * step / (near[1].path - near[0].path)
    return None


def without_modifications(design: PairDesign) -> bool:
    """Whether pinion and gear flanks that touch in drive are as generated.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    bool
        True without reliefs, crownings, gear modifications and deviations.
    """
    pinion_part = design.pinion
    reliefs = (pinion_part.tip_relief, pinion_part.root_relief, pinion_part.lead_crowning)
    on_pinion = any(relief.amount != 0.0 for relief in reliefs)
    return not (on_pinion or design.face_gear.modifications != GearModifications() or design.deviates)


@dataclass(frozen=True, eq=False)
class ConjugateSlopes:
    """Derivatives by offset, axial shift (m/m) and the error of the shaft angle (m/rad), (3,) each.

    transmission_error, path: of `ConjugateContact.transmission_error` and `ConjugateContact.path`.
    """

    transmission_error: Array
    path: Array


def conjugate_slopes(pair: PairNumbers, errors: AssemblyErrors, contact: ConjugateContact) -> ConjugateSlopes:
    """Compute the derivatives of the contact of a pair by its assembly errors, in closed form.

    Parameters
    ----------
    pair : PairNumbers
        Numbers of the pair.
    errors : AssemblyErrors
        Errors of the assembly.
    contact : ConjugateContact
        Contact with these errors.

    Returns
    -------
    ConjugateSlopes
        Derivatives, m/m and m/rad.
    """
    error, path = pair.place_line(errors, contact.psi, -contact.turn).error_slopes()
    return ConjugateSlopes(error[:3], path[:3])
