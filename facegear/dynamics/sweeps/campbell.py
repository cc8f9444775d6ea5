"""Find the natural mode to which a resonance belongs."""

from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.sweeps.maxima import local_maxima
from facegear.dynamics.sweeps.sweep import Piece
from facegear.transmission.modes import Modes

PROMINENT = 1.15
"""Ratio of a maximum to the higher of the valleys beside it from which it counts."""
SMALL = 0.1
"""Maxima below this fraction of the largest do not count."""


@dataclass(frozen=True)
class Resonance:
    """The natural mode that holds most of a response's energy.

    Attributes
    ----------
    mode : int
        Number in the frequency table, from 1.
    frequency_hz : float
        Natural frequency.
    order : float
        Multiple of the mesh frequency at which it moves most.
    fraction : float
        Fraction of the energy of all modes.
    predicted_rpm : float
        Speed at which that multiple meets the mode's linear frequency.
    """

    mode: int
    frequency_hz: float
    order: float
    fraction: float
    predicted_rpm: float

    @property
    def name(self) -> str:
        """Name such as `mode 17 at 1x`."""
        return f"mode {self.mode} at {self.order:g}x"


def resonance(piece: Piece, position: int, modes: Modes, teeth: int) -> Resonance:
    """Find the resonance to which a response belongs; modes of one frequency count together.

    Parameters
    ----------
    piece : Piece
        Results of a sweep.
    position : int
        Position of the speed.
    modes : Modes
        Natural modes of the machine.
    teeth : int
        Number of teeth of the pinion.

    Returns
    -------
    Resonance
        Strongest mode.
    """
    energy = piece.modal[position] ** 2
    groups = [energy[start:stop].sum() for start, stop in modes.groups]
    start, _ = modes.groups[int(np.argmax(groups))]
    frequency = float(modes.frequencies[start])
    order = float(piece.modal_order[position])
    fraction = float(max(groups) / max(energy.sum(), 1e-300))
    return Resonance(start + 1, frequency, order, fraction, 60.0 * frequency / (order * teeth))


def peaks(piece: Piece) -> list[tuple[str, int, int, float]]:
    """Find the local maxima of the AC RMS over speed.

    A maximum counts if it stands 15 % over the minimum on either side before a larger value comes.

    Parameters
    ----------
    piece : Piece
        Results of a sweep.

    Returns
    -------
    list of tuple
        Quantity (deflection, x, y or z), mesh or body, position, AC RMS in m.
    """
    rows = []
    for mesh, curve in enumerate(piece.deflection_ac_rms.T):
        rows += [("deflection", mesh, i, float(curve[i])) for i in maxima(curve)]
    translations = piece.translation_ac_rms
    for body in range(translations.shape[1]):
        for axis, letter in enumerate("xyz"):
            curve = translations[:, body, axis]
            if curve.max() > 1e-12:
                rows += [(letter, body, i, float(curve[i])) for i in maxima(curve)]
    return rows


def maxima(curve: Array) -> list[int]:
    """Find the maxima that are PROMINENT times the higher of the valleys beside them.

    Parameters
    ----------
    curve : (P,) array
        AC RMS over speed, any unit.

    Returns
    -------
    list of int
        Positions.
    """
    positions, prominences = local_maxima(curve)
    heights = curve[positions]
    stands_out = heights > PROMINENT * (heights - prominences)
    return [int(i) for i in positions[(heights >= SMALL * curve.max()) & stands_out]]
