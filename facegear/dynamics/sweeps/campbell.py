"""Which natural mode a resonance belongs to."""

from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.sweeps.maxima import local_maxima
from facegear.dynamics.sweeps.sweep import Piece
from facegear.transmission.modes import Modes

PROMINENT = 1.15
SMALL = 0.1
"""Maxima below this fraction of the largest do not count."""


@dataclass(frozen=True)
class Resonance:
    """The natural mode (order in the frequency table, from 1) that holds most of a response's energy.

    order: multiple of the mesh frequency at which it moves most; fraction: of the energy of all modes;
    predicted_rpm: where that multiple meets the mode's linear frequency.
    """

    mode: int
    frequency_hz: float
    order: float
    fraction: float
    predicted_rpm: float

    @property
    def name(self) -> str:
        """`mode 17 at 1x`."""
        return f"mode {self.mode} at {self.order:g}x"


def resonance(piece: Piece, position: int, modes: Modes, teeth: int) -> Resonance:
    """The resonance that a response belongs to; modes of one frequency count together."""
    energy = piece.modal[position] ** 2
    groups = [energy[start:stop].sum() for start, stop in modes.groups]
    start, _ = modes.groups[int(np.argmax(groups))]
    frequency = float(modes.frequencies[start])
    order = float(piece.modal_order[position])
    fraction = float(max(groups) / max(energy.sum(), 1e-300))
    return Resonance(start + 1, frequency, order, fraction, 60.0 * frequency / (order * teeth))


def peaks(piece: Piece) -> list[tuple[str, int, int, float]]:
    """Local maxima over speed: (deflection or x, y, z), mesh or body, position, AC RMS in m.

    A maximum counts if it stands 15 % over the minimum on either side before a larger value comes.
    """
    rows = []
    for mesh, curve in enumerate(piece.deflection_ac_rms.T):
        rows += [("deflection", mesh, i, float(curve[i])) for i in maxima(curve)]
    moved = piece.translation_ac_rms
    for body in range(moved.shape[1]):
        for axis, letter in enumerate("xyz"):
            curve = moved[:, body, axis]
            if curve.max() > 1e-12:
                rows += [(letter, body, i, float(curve[i])) for i in maxima(curve)]
    return rows


def maxima(curve: Array) -> list[int]:
    """Positions of the maxima that are PROMINENT times the higher of the valleys beside them."""
    positions, prominences = local_maxima(curve)
    heights = curve[positions]
    stands_out = heights > PROMINENT * (heights - prominences)
    return [int(i) for i in positions[(heights >= SMALL * curve.max()) & stands_out]]
