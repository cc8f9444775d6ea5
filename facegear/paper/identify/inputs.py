"""The inputs that the paper leaves out, as points of the unit cube."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

import numpy as np

from facegear.transmission.phases import PhaseConvention


class Meaning(StrEnum):
    """What the paper's 50 um of transmission error is."""

    AMPLITUDE = "amplitude"
    RANGE = "range"


class Waveform(StrEnum):
    """Form of e(t): a cosine, a triangle, or parabolic arcs as between equal teeth."""

    SINE = "sine"
    TRIANGLE = "triangle"
    ARCS = "arcs"


class OpenFlanks(StrEnum):
    """Whether the mesh damping acts on flanks that are apart."""

    ALWAYS = "always"
    CONTACT_ONLY = "contact_only"


NUMBERS = ("per_input_n_m", "tail_share", "error_phase_deg", "stiffness_variation")
BEARINGS = ("mid_bearing_n_per_m", "stiff_bearing_n_per_m")
CHOICES: Mapping[str, type[StrEnum]] = {
    "meaning": Meaning,
    "phase_convention": PhaseConvention,
    "waveform": Waveform,
    "open_flanks": OpenFlanks,
}
COORDINATES = (*NUMBERS, *BEARINGS, *CHOICES)
"""What each coordinate of the unit cube decides."""
LOGARITHMIC = ("per_input_n_m", *BEARINGS)
"""Numbers that are spread on a logarithmic scale."""
INPUT_COLUMNS = ("pattern", *COORDINATES, "stiffness_torque_n_m")
"""Columns of a table of inputs; the last is the load on a mesh at which k(t) has its shape."""


@dataclass(frozen=True)
class Space:
    """What plausible inputs are: ranges of the numbers (N m, share of the power, factor, N/m).

    `loads`: torques on a mesh (N m) between which k(t) is known; beyond them it keeps the shape at the end.
    `gears`: over how many meshes the torque of an input is shared.
    """

    torque: tuple[float, float]
    tail_share: tuple[float, float]
    variation: tuple[float, float]
    bearings: tuple[float, float]
    loads: tuple[float, float]
    gears: int

    def row(self, unit: Sequence[float], pattern: str) -> dict[str, Any]:
        """Inputs at a point of the unit cube, one coordinate for each of COORDINATES: INPUT_COLUMNS.

        Torque and bearings are spread on a logarithmic scale, the phase of e(t) over its whole period and
        each choice with equal chances. Of the two bearings the softer is called mid.
        """
        at = dict(zip(COORDINATES, map(float, unit), strict=True))
        at["error_phase_deg"] %= 1.0
        numbers = {name: _placed(at[name], limits, name) for name, limits in self._limits.items()}
        return {
            "pattern": pattern,
            **numbers,
            **dict(zip(BEARINGS, sorted(numbers[name] for name in BEARINGS), strict=True)),
            **{name: picked(list(kind), at[name]) for name, kind in CHOICES.items()},
            "stiffness_torque_n_m": float(np.clip(numbers["per_input_n_m"] / self.gears, *self.loads)),
        }

    def unit(self, row: Mapping[str, Any]) -> list[float]:
        """A point of the unit cube that has the inputs of a row; a choice lies in the middle of its part."""
        numbers = [_place(float(row[name]), limits, name) for name, limits in self._limits.items()]
        choices = [(list(kind).index(kind(row[name])) + 0.5) / len(kind) for name, kind in CHOICES.items()]
        return [*numbers, *choices]

    @property
    def _limits(self) -> dict[str, tuple[float, float]]:
        """Ranges of the numbers, in the order of COORDINATES."""
        numbers = (self.torque, self.tail_share, (0.0, 360.0), self.variation)
        return {**dict(zip(NUMBERS, numbers, strict=True)), **dict.fromkeys(BEARINGS, self.bearings)}


def picked(choices: Sequence[str], unit: float) -> str:
    """The choice in whose part of [0, 1] the number lies; all parts are equal."""
    return str(choices[min(int(unit * len(choices)), len(choices) - 1)])


def _placed(unit: float, limits: tuple[float, float], name: str) -> float:
    """The number at a coordinate of the unit cube."""
    low, high = np.log(limits) if name in LOGARITHMIC else limits
    value = low + unit * (high - low)
    return float(np.exp(value) if name in LOGARITHMIC else value)


def _place(value: float, limits: tuple[float, float], name: str) -> float:
    """The coordinate, within [0, 1], at which the number lies."""
    (low, high), at = (np.log(limits), np.log(value)) if name in LOGARITHMIC else (limits, value)
    return float(np.clip((at - low) / (high - low), 0.0, 1.0))


def _unit_range(*weights: tuple[int, float]) -> tuple[tuple[int, float], ...]:
    """Cosine terms (order, weight) scaled to a half range of one."""
    cycles = np.linspace(0.0, 1.0, 3601)
    half_range = 0.5 * np.ptp(sum(weight * np.cos(2.0 * np.pi * order * cycles) for order, weight in weights))
    return tuple((order, float(weight / half_range)) for order, weight in weights)


WAVEFORM_TERMS: Mapping[Waveform, tuple[tuple[int, float], ...]] = {
    Waveform.SINE: ((1, 1.0),),
    Waveform.TRIANGLE: _unit_range(*((j, j**-2.0) for j in (1, 3, 5, 7))),
    Waveform.ARCS: _unit_range(*((j, -((-1.0) ** j) * j**-2.0) for j in (1, 2, 3, 4, 5, 6))),
}
"""Cosine series (order, weight) of half range one; triangle and arcs are cut below 3 % of the first term."""
