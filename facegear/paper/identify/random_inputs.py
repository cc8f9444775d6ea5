"""Random plausible inputs: the same number gives the same inputs in any chunk."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from facegear.paper.identify.inputs import Meaning, Space, Waveform
from facegear.paper.identify.patterns import Phasing
from facegear.scenarios.distributions import Distribution, Shape
from facegear.scenarios.sampling import Cause, Population, samples
from facegear.transmission.phases import PhaseConvention


@dataclass(frozen=True)
class Plausible:
    """What random inputs are drawn from: the three numbers uniformly (the torque on a logarithmic scale, the
    phase of e(t) over its whole period), each choice with equal chances.

    `loads`: torques on a mesh (N m) between which k(t) is known; beyond them it keeps the shape at the end.
    """

    space: Space
    phasings: Mapping[str, Phasing]
    loads: tuple[float, float]
    gears: int
    seed: int

    def rows(self, numbers: Sequence[int]) -> list[dict[str, Any]]:
        """Inputs by sample number, as rows of a sets file; `pattern` names the phasing."""
        return [self._row(number, self.phasings) for number in numbers]

    def rows_by_pattern(self, numbers: Sequence[int]) -> list[dict[str, Any]]:
        """As `rows`, every pattern in turn with the same other inputs before the next ones are drawn."""
        patterns = list(self.phasings.items())
        return [
            self._row(number // len(patterns), dict([patterns[number % len(patterns)]])) for number in numbers
        ]

    def _row(self, number: int, phasings: Mapping[str, Phasing]) -> dict[str, Any]:
        drawn = dict(zip(_NAMES, samples(self._population, number, 1)[0].tolist(), strict=True))
        torque = float(np.exp(drawn["log_torque"]))
        pattern = _pick(list(phasings), drawn["pattern"])
        return {
            "pattern": pattern,
            "phasing": phasings[pattern],
            "meaning": _pick(list(Meaning), drawn["meaning"]),
            "phase_convention": _pick(list(PhaseConvention), drawn["convention"]),
            "waveform": _pick(list(Waveform), drawn["waveform"]),
            "per_input_n_m": torque,
            "tail_share": drawn["tail_share"],
            "error_phase_deg": drawn["phase_deg"],
            "stiffness_torque_n_m": float(np.clip(torque / self.gears, *self.loads)),
        }

    @property
    def _population(self) -> Population:
        low, high = np.log(self.space.torque)
        limits = ((float(low), float(high)), self.space.tail_share, (0.0, 360.0), *[(0.0, 1.0)] * 4)
        causes = [
            Cause(name, Distribution(Shape.UNIFORM, limits=limit), (), "plausible")
            for name, limit in zip(_NAMES, limits, strict=True)
        ]
        return Population(tuple(causes), self.seed)


_NAMES = ("log_torque", "tail_share", "phase_deg", "pattern", "meaning", "convention", "waveform")


def _pick(choices: Sequence[str], unit: float) -> str:
    return str(choices[min(int(unit * len(choices)), len(choices) - 1)])
