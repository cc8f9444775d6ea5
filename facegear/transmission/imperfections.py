"""Imperfections by which one mesh or one body of a real gearbox differs from the others."""

from dataclasses import dataclass, field, replace

import numpy as np

from facegear.arrays import Array
from facegear.harmonics.series import Harmonics
from facegear.transmission.layout import Layout
from facegear.transmission.tooth_errors import ToothErrors


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
        What single teeth add, alike on all pinions and on both gears.
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

    @property
    def any_slow(self) -> bool:
        """Whether an error changes from one mesh cycle to the next."""
        turning = (*self.pinion_runout, *self.gear_runout)
        teeth = self.teeth is not None and any(self.teeth.turning)
        pitch = bool(self.pinion_pitch or self.gear_pitch)
        return teeth or pitch or any(curve.amplitude != 0.0 for curve in turning)

    @property
    def without_slow_errors(self) -> "Imperfections":
        """Imperfections without what changes from one mesh cycle to the next, as steady motions see them."""
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
