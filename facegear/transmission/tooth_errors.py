"""Errors of single teeth, which add to the transmission error of every flank, mesh cycle by mesh cycle."""

from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array, Arrays
from facegear.transmission.layout import Layout


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
        """Whether teeth of the pinions and of the gears differ."""
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
    return np.interp(tooth_positions, np.arange(curve.size) * (teeth / curve.size), curve, period=teeth)


def from_arrays(arrays: Arrays) -> ToothErrors:
    """Read tooth errors from the arrays of the stage tooth_errors.

    Parameters
    ----------
    arrays : Arrays
        Arrays `curves` of that stage, by name.

    Returns
    -------
    ToothErrors
        Curves in m.
    """
    pinion, gear = ((arrays[f"{body}_drive_m"], arrays[f"{body}_back_m"]) for body in ("pinion", "face_gear"))
    return ToothErrors(pinion, gear)
