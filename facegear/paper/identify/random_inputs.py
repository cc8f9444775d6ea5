"""Random plausible inputs: the same number gives the same inputs in any chunk."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from facegear.paper.identify.inputs import COORDINATES, Space, picked
from facegear.scenarios.distributions import Distribution, Shape
from facegear.scenarios.sampling import Cause, Population, samples

PATTERN = "pattern"


@dataclass(frozen=True)
class Plausible:
    """Random points of a space, with one of the `patterns` of e(t) picked with equal chances."""

    space: Space
    patterns: tuple[str, ...]
    seed: int

    def rows(self, numbers: Sequence[int]) -> list[dict[str, Any]]:
        """Inputs by sample number."""
        return [self._row(number, self.patterns) for number in numbers]

    def rows_by_pattern(self, numbers: Sequence[int]) -> list[dict[str, Any]]:
        """As `rows`, every pattern in turn with the same other inputs before the next ones are drawn."""
        count = len(self.patterns)
        return [self._row(number // count, [self.patterns[number % count]]) for number in numbers]

    def unit(self, number: int) -> list[float]:
        """Point of the unit cube of a sample, one coordinate for each of COORDINATES."""
        return self._drawn(number)[:-1]

    def _drawn(self, number: int) -> list[float]:
        drawn: list[float] = samples(_population(self.seed), number, 1)[0].tolist()
        return drawn

    def _row(self, number: int, patterns: Sequence[str]) -> dict[str, Any]:
        *unit, last = self._drawn(number)
        return self.space.row(unit, picked(patterns, last))


def _population(seed: int) -> Population:
    even = Distribution(Shape.UNIFORM, limits=(0.0, 1.0))
    return Population(tuple(Cause(name, even, (), "plausible") for name in (*COORDINATES, PATTERN)), seed)
