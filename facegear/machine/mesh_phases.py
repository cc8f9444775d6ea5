"""Phases of the meshes of a machine: by how much each lags behind the reference mesh."""

from enum import StrEnum

import numpy as np

from facegear.arrays import Array
from facegear.machine.layout import Layout, Side


class PhaseConvention(StrEnum):
    """Phase of meshes with the lower of two gears: `geometric` adds half a turn of the pinion for every
    pinion, `printed` for the first pinion only, as equation (11) has it.
    """

    GEOMETRIC = "geometric"
    AS_PRINTED = "printed"


def mesh_phases(layout: Layout, convention: PhaseConvention, clocking: Array | None = None) -> Array:
    """Return the lag of each mesh behind the reference.

    The reference is the first pinion's mesh with the upper gear, or with the only gear. The upper gear's
    teeth pass the pinions in the order of their angles, counted from the first pinion: equation (7). The
    other side of a pinion is half a turn of it away, and turned by `clocking`. Where the lower gear is alone
    its teeth come round the other way. Equation (13) as printed knows no sense of rotation.

    Parameters
    ----------
    layout : Layout
        Bodies and mesh geometry.
    convention : PhaseConvention
        For which pinions the half turn counts.
    clocking : (pinions,) array or None
        Lower rim ahead of the upper, pitches; 0 if None.

    Returns
    -------
    (meshes,) array
        Mesh periods within [0, 1).
    """
    upper_first = (
        any(gear.side is Side.UPPER for gear in layout.gears) or not layout.kinematics.follows_rotation
    )
    rim_clocking = np.zeros(len(layout.pinions)) if clocking is None else clocking
    lags = layout.pitches_from_first * (1.0 if upper_first else -1.0)
    phases = np.empty(len(layout.meshes))
    for row, (i, g) in enumerate(layout.meshes):
        lag = lags[i]
        if layout.half_turned(g):
            if convention is PhaseConvention.GEOMETRIC or i == 0:
                lag += 0.5 * layout.pinion_teeth
            lag -= rim_clocking[i]
        phases[row] = np.mod(lag, 1.0)
    return phases


def place_lags(layout: Layout, outwards: Array) -> Array:
    """Return what the places of the pinions along their axes add to the lags of drive, then back flanks.

    A helical pinion that stands outwards is one that has turned, as far as its flanks are concerned.

    Parameters
    ----------
    layout : Layout
        Bodies and mesh geometry.
    outwards : (pinions,) array
        Places of the pinions outwards along their axes, m.

    Returns
    -------
    (2 meshes,) array
        Mesh periods.
    """
    return np.array(
        [
            -layout.flank_frames[g][flank].turn_by_place * outwards[i] / layout.base_pitch
            for flank in (0, 1)
            for i, g in layout.meshes
        ]
    )
