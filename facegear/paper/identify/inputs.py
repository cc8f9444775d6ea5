"""The inputs that the paper leaves out, as points of a search space."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from facegear.harmonics.series import Harmonics
from facegear.transmission.machine import Machine, balanced_torques, pinion_torques
from facegear.transmission.phases import PhaseConvention

StiffnessAt = Callable[[float], Harmonics]
"""Mesh stiffness series of the reference mesh from the torque on a pinion for one mesh, N m."""


class Meaning(StrEnum):
    """What the paper's 50 um of transmission error is."""

    AMPLITUDE = "amplitude"
    RANGE = "range"


class Waveform(StrEnum):
    """Form of e(t): a cosine, a triangle, or parabolic arcs as between equal teeth."""

    SINE = "sine"
    TRIANGLE = "triangle"
    ARCS = "arcs"


class StiffnessLoad(StrEnum):
    """Load on a mesh at which k(t) has its shape: the operating one (an equal share of an input pinion's
    torque), or the one at which the mean is the paper's.
    """

    OPERATING = "operating"
    MEAN = "mean"


@dataclass(frozen=True)
class Branch:
    """The choices that are not numbers."""

    meaning: Meaning
    in_step: bool
    convention: PhaseConvention
    waveform: Waveform
    load: StiffnessLoad

    @property
    def name(self) -> str:
        """Readable and usable as a file name."""
        phasing = "in_step" if self.in_step else "mesh"
        parts = (self.meaning, phasing, self.convention, self.waveform, self.load)
        return "-".join(str(part) for part in parts)


@dataclass(frozen=True)
class Inputs:
    """One point: torque per input pinion (N m), share leaving at the tail, phase of e(t) in mesh periods."""

    branch: Branch
    torque: float
    tail_share: float
    error_phase: float


@dataclass(frozen=True)
class Space:
    """Ranges of the three numbers; the torque is searched on a logarithmic scale."""

    torque: tuple[float, float]
    tail_share: tuple[float, float]

    def inputs(self, branch: Branch, unit: NDArray[np.float64]) -> Inputs:
        """The point at `unit`, shape (3,), each in [0, 1]; the last one is cyclic."""
        low, high = np.log(self.torque)
        torque = float(np.exp(low + unit[0] * (high - low)))
        tail = self.tail_share[0] + float(unit[1]) * (self.tail_share[1] - self.tail_share[0])
        return Inputs(branch, torque, tail, float(unit[2] % 1.0))


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


def error_series(size: float, branch: Branch, phase: float) -> Harmonics:
    """e(t) of the reference mesh; `size` (m) is the paper's number, `phase` the lead in mesh periods."""
    half_range = size if branch.meaning is Meaning.AMPLITUDE else 0.5 * size
    terms = WAVEFORM_TERMS[branch.waveform]
    a, b = np.zeros(terms[-1][0] + 1), np.zeros(terms[-1][0] + 1)
    for order, weight in terms:
        b[order] = half_range * weight
    return Harmonics(a, b).shifted(-phase)


def stiffness_torque(base: Machine, inputs: Inputs, load_for_mean: float) -> float:
    """Torque on the pinion of one mesh at which k(t) is taken, N m."""
    if inputs.branch.load is StiffnessLoad.MEAN:
        return load_for_mean
    return inputs.torque / len(base.layout.gears)


def machine_with(
    base: Machine, inputs: Inputs, error_size: float, stiffness: StiffnessAt, load_for_mean: float
) -> Machine:
    """The base machine with the undisclosed inputs put in."""
    layout = base.layout
    on_pinions = pinion_torques(layout, inputs.torque, inputs.tail_share)
    return replace(
        base,
        torques=balanced_torques(layout, on_pinions),
        stiffness=stiffness(stiffness_torque(base, inputs, load_for_mean)),
        error=error_series(error_size, inputs.branch, inputs.error_phase),
        phase_convention=inputs.branch.convention,
        error_lags=np.zeros(len(layout.meshes)) if inputs.branch.in_step else None,
    )
