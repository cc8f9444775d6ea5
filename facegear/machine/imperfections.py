"""Errors of single teeth, which add to the transmission error of every flank, mesh cycle by mesh cycle."""

from dataclasses import dataclass, field, replace

import numpy as np

from facegear.arrays import Array, Arrays
from facegear.harmonics import Harmonics
from facegear.machine.layout import Layout


@dataclass(frozen=True, eq=False)
class ToothErrors:
    """Curves (teeth x positions,) m over one turn of a gear, of `drive` and `back` flanks.

    Positive where teeth come early. A curve counts mesh cycles of its gear from where its first tooth stands
    at the place 0 of the mesh cycle; that of a back flank is the drive flank's of the pair in a mirror.
    """

    pinion: tuple[Array, Array]
    gear: tuple[Array, Array]

    @property
    def turning(self) -> tuple[bool, bool]:
        """Whether any tooth errors are not zero: of the pinions, and of the face gears."""
        pinion, gear = (any(curve.any() for curve in curves) for curves in (self.pinion, self.gear))
        return pinion, gear

    def early(self, layout: Layout, on_pinion: Array, on_gear: Array) -> tuple[Array, Array]:
        """Return by how much drive and back flanks come early.

        A tooth of the pinion that has come s mesh cycles far is at 2 - s of its way in the mirror, in which
        the back flank drives, and one of the gear at 1 - s.

        Parameters
        ----------
        layout : Layout
            Tooth numbers.
        on_pinion : (K,) array
            Positions in teeth of the pinion.
        on_gear : (K,) array
            Positions in teeth of the face gear.

        Returns
        -------
        pair of (K,) arrays
            Drive and back flank, m.
        """
        teeth = layout.pinion_teeth, layout.gear_teeth
        drive = _at(self.pinion[0], teeth[0], on_pinion) + _at(self.gear[0], teeth[1], on_gear)
        back = _at(self.pinion[1], teeth[0], 2.0 - on_pinion) + _at(self.gear[1], teeth[1], 1.0 - on_gear)
        return drive, back


def _at(curve: Array, teeth: int, tooth_positions: Array) -> Array:
    """Return a curve over one turn of a gear (samples,), m, linear between samples, at positions (K,)
    counted in teeth; the samples lie evenly over `teeth` teeth, periodically.
    """
    return np.interp(tooth_positions, np.arange(curve.size) * (teeth / curve.size), curve, period=teeth)


def from_arrays(arrays: Arrays) -> ToothErrors:
    """Read tooth errors from the arrays of the stage tooth_errors.

    Parameters
    ----------
    arrays : Arrays
        Curves over one turn, (teeth times positions,) in m, named pinion_drive_m, pinion_back_m,
        face_gear_drive_m and face_gear_back_m.

    Returns
    -------
    ToothErrors
        Curves in m.
    """
    pinion, gear = ((arrays[f"{body}_drive_m"], arrays[f"{body}_back_m"]) for body in ("pinion", "face_gear"))
    return ToothErrors(pinion, gear)


@dataclass(frozen=True)
class Runout:
    """Eccentricity of a body's teeth: amplitude (m), and where its high point is at the start (rad).

    A pinion's angle counts from the upper gear, a face gear's from the first pinion, both as the body turns
    (of the gears: the upper one towards growing distribution angles, the lower one the other way).
    """

    amplitude: float = 0.0
    phase: float = 0.0


@dataclass(frozen=True, eq=False)
class Imperfections:
    """Errors of single meshes and bodies; lengths in m.

    Attributes
    ----------
    error : (meshes,)
        Constant, along the line of action, positive where the drive flank comes late.
    stiffness : (meshes,)
        Factor on k(t).
    teeth
        Errors of single teeth, the same on all pinions and on both gears.
    series
        e(t) of a mesh by its index, in place of the common one.
    position : (pinions, 2)
        x, y of the pinion's bearings.
    bearing_clearance : (pinions,)
        Radial.
    clocking : (pinions,)
        Lower rim ahead of the upper, in pitches.
    pinion_runout, gear_runout
        One a body.
    pinion_pitch, gear_pitch
        By the body's index, cumulative pitch deviation (teeth,) along the pitch circle, positive where a
        tooth stands ahead as the body turns.
    outwards : (pinions,)
        Place of the pinion's bearings outwards along its axis; 0 if None.
    """

    error: Array
    stiffness: Array
    position: Array
    bearing_clearance: Array
    clocking: Array
    pinion_runout: tuple[Runout, ...]
    gear_runout: tuple[Runout, ...]
    teeth: ToothErrors | None = None
    series: dict[int, Harmonics] = field(default_factory=dict)
    pinion_pitch: dict[int, Array] = field(default_factory=dict)
    gear_pitch: dict[int, Array] = field(default_factory=dict)
    outwards: Array = None  # type: ignore[assignment]

    def __post_init__(self) -> None:
        if self.outwards is None:
            object.__setattr__(self, "outwards", np.zeros(len(self.position)))

    @property
    def positions(self) -> Array:
        """x, y and z of the pinions' bearings, (pinions, 3)."""
        return np.column_stack([self.position, self.outwards])

    @property
    def any_slow(self) -> bool:
        """Whether an error changes from one mesh cycle to the next: runout, pitch deviations or errors of
        single teeth.
        """
        turning = (*self.pinion_runout, *self.gear_runout)
        teeth = self.teeth is not None and any(self.teeth.turning)
        pitch = bool(self.pinion_pitch or self.gear_pitch)
        return teeth or pitch or any(curve.amplitude != 0.0 for curve in turning)

    @property
    def without_slow_errors(self) -> "Imperfections":
        """Imperfections without runouts, pitch deviations and errors of single teeth, as periodic motions
        need them.
        """
        pinions, gears = len(self.pinion_runout), len(self.gear_runout)
        return replace(
            self,
            pinion_runout=(Runout(),) * pinions,
            gear_runout=(Runout(),) * gears,
            pinion_pitch={},
            gear_pitch={},
            teeth=None,
        )


def perfect(layout: Layout) -> Imperfections:
    """Return imperfections without any error.

    Parameters
    ----------
    layout : Layout
        Bodies and mesh geometry.

    Returns
    -------
    Imperfections
        Zeros, and factors of 1 on the stiffness.
    """
    meshes, pinions, gears = len(layout.meshes), len(layout.pinions), len(layout.gears)
    return Imperfections(
        error=np.zeros(meshes),
        stiffness=np.ones(meshes),
        position=np.zeros((pinions, 2)),
        bearing_clearance=np.zeros(pinions),
        clocking=np.zeros(pinions),
        pinion_runout=(Runout(),) * pinions,
        gear_runout=(Runout(),) * gears,
    )
