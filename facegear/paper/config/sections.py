"""Section `identify` of a reproduction: the search for the inputs that the paper leaves out."""

from typing import Literal

from pydantic import Field, model_validator

from facegear.config.base import Section, refuse
from facegear.config.studies import Point
from facegear.config.tolerances import chunk_ranges
from facegear.paper.identify.patterns import READING_PATTERNS, half_turn_patterns

Design = Literal["random", "structures", "geometric"]
"""Random inputs with every reading of e(t), the same random inputs with each pattern of half turns, or every
fifth of the latter with the kinematics that gears have instead of the printed ones.
"""
KINEMATICS_STEP = 5
"""With 32 patterns this step meets all of them."""


class Ranges(Section):
    """Where the numbers are looked for; the phase of e(t) is searched over a whole period."""

    per_input_n_m: tuple[float, float] = (80.0, 2000.0)
    tail_share: tuple[float, float] = (0.0, 0.45)
    stiffness_variation: tuple[float, float] = Field(
        (0.5, 2.5), description="factor on that of k(t) computed"
    )
    stiffer_bearings_n_per_m: tuple[float, float] = (1e8, 1e10)

    @model_validator(mode="after")
    def _rising(self) -> "Ranges":
        for name in type(self).model_fields:
            low, high = getattr(self, name)
            if not 0 <= low < high or (name != "tail_share" and low == 0):
                refuse(name, [low, high], "two rising values above 0; a share may begin at 0")
        return self


class RandomInputs(Section):
    """Random plausible inputs: how often they hold each claim, and what patterns of e(t) do."""

    samples: int = Field(64, ge=1, le=100_000)
    structure_samples: int = Field(
        16, ge=8, le=10_000, description="with which each pattern is tried; the null needs more than figures"
    )
    chunk_samples: int = Field(16, ge=1, le=10_000, description="judged by one job")
    seed: int = Field(1, ge=0, le=2**31)


class SearchBudget(Section):
    """The search for the most likely inputs, by differential evolution in each pattern of e(t) by itself."""

    by_mean: int = Field(
        4, ge=1, le=32, description="patterns that go on, by the mean of the fitted claims of random inputs"
    )
    by_upper: int = Field(2, ge=1, le=32, description="patterns that go on, by the upper 5 % of these claims")
    again_within: float = Field(
        2.0, ge=0, description="log units from the best within which a pattern is searched once more"
    )
    repeats: int = Field(1, ge=1, le=100, description="whole searches, each from other random inputs")
    population: int = Field(16, ge=5, le=1000)
    generations: int = Field(12, ge=0, le=10_000)
    starts: int = Field(3, ge=1, le=100, description="starts from which inputs are judged, the first at rest")
    judged: int = Field(200, ge=1, le=100_000, description="most likely inputs judged with a sweep")
    parts: int = Field(4, ge=1, le=1000, description="jobs over which these are spread")
    confirmed: int = Field(10, ge=1, le=1000, description="most likely inputs judged at full accuracy")
    runs: int = Field(
        5, ge=1, le=1000, description="of each of these, from other starts; all but the first moved by 1e-12"
    )
    sets: int = Field(4, ge=1, le=26, description="stored inputs, of different patterns")
    papers: int = Field(100, ge=1, le=100_000, description="other runs and invented papers of the null")
    seed: int = Field(1, ge=0, le=2**31)

    @property
    def places(self) -> int:
        """Patterns that go on at most, the readings of the paper among them."""
        return min(self.by_mean + self.by_upper + len(READING_PATTERNS), len(half_turn_patterns()))


class Identify(Section):
    """The search for what the paper leaves out; run with `snakemake identify`."""

    ranges: Ranges = Ranges()
    random: RandomInputs = RandomInputs()
    search: SearchBudget = SearchBudget()
    runs: int = Field(2, ge=1, le=1000, description="of each set; all but the first moved by 1e-12")
    swept_runs: int = Field(2, ge=1, le=1000, description="of these, those with a speed sweep")
    designs: tuple[Point, ...] = Field(
        (), description="other plausible gear data for the first estimate of the load"
    )

    @model_validator(mode="after")
    def _distinct(self) -> "Identify":
        labels = [design.label for design in self.designs]
        if len(set(labels)) < len(labels):
            refuse("designs", labels, "designs whose labels differ")
        return self


def design_size(section: RandomInputs, design: Design) -> int:
    """Samples of a design."""
    if design == "random":
        return section.samples
    size = section.structure_samples * len(half_turn_patterns())
    return size if design == "structures" else -(-size // KINEMATICS_STEP)


def sample_numbers(design: Design, first: int, last: int) -> list[int]:
    """Numbers of the samples of a design from the first to the last place."""
    step = KINEMATICS_STEP if design == "geometric" else 1
    return [step * place for place in range(first, last + 1)]


def design_chunks(section: RandomInputs, design: Design) -> list[tuple[int, int]]:
    """Places of the first and the last sample of each chunk."""
    return chunk_ranges(design_size(section, design), section.chunk_samples)
