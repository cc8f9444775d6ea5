"""Random plausible inputs: the same number gives the same inputs in any chunk."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from facegear.paper.identify.inputs import COORDINATES, Space, picked
from facegear.paper.identify.patterns import Phasing
from facegear.scenarios.distributions import Distribution, Shape
from facegear.scenarios.sampling import Cause, Population, samples

PATTERN = "pattern"


@dataclass(frozen=True)
class Plausible:
    """Random points of a space, with a pattern of e(t) picked from `phasings` with equal chances."""

    space: Space
    phasings: Mapping[str, Phasing]
    seed: int

    def rows(self, numbers: Sequence[int]) -> list[dict[str, Any]]:
        """Inputs by sample number; `pattern` names the phasing."""
        return [self._row(number, self.phasings) for number in numbers]

    def rows_by_pattern(self, numbers: Sequence[int]) -> list[dict[str, Any]]:
        """As `rows`, every pattern in turn with the same other inputs before the next ones are drawn."""
        patterns = list(self.phasings.items())
        return [
            self._row(number // len(patterns), dict([patterns[number % len(patterns)]])) for number in numbers
        ]

    def _row(self, number: int, phasings: Mapping[str, Phasing]) -> dict[str, Any]:
        *unit, last = samples(_population(self.seed), number, 1)[0].tolist()
        pattern = picked(list(phasings), last)
        return self.space.row(unit, pattern, phasings[pattern])


def _population(seed: int) -> Population:
    even = Distribution(Shape.UNIFORM, limits=(0.0, 1.0))
    return Population(tuple(Cause(name, even, (), "plausible") for name in (*COORDINATES, PATTERN)), seed)
