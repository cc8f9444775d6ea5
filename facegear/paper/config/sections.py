"""Section `identify` of a reproduction: the search for the inputs that the paper leaves out."""

import itertools
from typing import Literal

from pydantic import Field, model_validator

from facegear.config.base import Section, refuse
from facegear.config.studies import Point
from facegear.config.tolerances import chunk_ranges
from facegear.paper.identify.budget import Budget
from facegear.paper.identify.inputs import Branch, Meaning, Space, StiffnessLoad, Waveform
from facegear.paper.identify.patterns import half_turn_patterns
from facegear.paper.identify.targets import BacklashTarget, Targets
from facegear.transmission.phases import PhaseConvention

Design = Literal["random", "structures"]
"""Random inputs with every reading of e(t), or the same random inputs with each pattern of half turns."""


class BacklashClaim(Section):
    """Load sharing that the paper gives at one backlash."""

    backlash_um: float = Field(gt=0, le=1e5)
    inputs_mean: float = Field(ge=1, le=100)
    idlers_mean: float = Field(ge=1, le=100)
    idlers_minimum: float = Field(ge=1, le=100)


class FitTargets(Section):
    """The claims that the fit uses; all others are held out."""

    backlash: tuple[BacklashClaim, ...] = Field(min_length=1)
    jumps_rpm: tuple[float, ...] = ()
    coefficient_tolerance: float = Field(0.15, gt=0, le=2)
    speed_tolerance: float = Field(0.03, gt=0, le=0.5, description="relative")


class Ranges(Section):
    """Where the numbers are looked for; the phase of e(t) is searched over a whole period."""

    per_input_n_m: tuple[float, float] = (200.0, 2000.0)
    tail_share: tuple[float, float] = (0.0, 0.4)

    @model_validator(mode="after")
    def _rising(self) -> "Ranges":
        for name in ("per_input_n_m", "tail_share"):
            low, high = getattr(self, name)
            if not 0 <= low < high or (name == "per_input_n_m" and low == 0):
                refuse(name, [low, high], "two rising values, the torque above 0")
        return self


class SearchBudget(Section):
    """Evaluations in each branch, and starts and sets of the closing judgement."""

    scan: int = Field(256, ge=8, le=100_000, description="points of the first scan, a power of two")
    population: int = Field(16, ge=5, le=1000, description="best points that are refined together")
    generations: int = Field(12, ge=0, le=10_000)
    starts: int = Field(8, ge=1, le=200, description="starts for the confidence of each optimum")
    sets: int = Field(6, ge=1, le=50, description="separate optima that are kept")
    slack: float = Field(
        1.5, ge=1, le=10, description="misfit of a kept optimum, at most this many times the best"
    )
    seed: int = Field(1, ge=0, le=2**31)


class RandomInputs(Section):
    """Random plausible inputs: how often they hold each claim, and what patterns of e(t) do."""

    ranges: Ranges = Ranges(per_input_n_m=(80.0, 2000.0), tail_share=(0.0, 0.45))
    samples: int = Field(64, ge=1, le=100_000)
    structure_samples: int = Field(4, ge=1, le=10_000, description="with which each pattern is tried")
    chunk_samples: int = Field(16, ge=1, le=10_000, description="judged by one job")
    seed: int = Field(1, ge=0, le=2**31)


class Identify(Section):
    """The search for what the paper leaves out; run with `snakemake identify`."""

    targets: FitTargets
    ranges: Ranges = Ranges()
    meanings: tuple[Literal["amplitude", "range"], ...] = Field(("amplitude", "range"), min_length=1)
    phasings: tuple[Literal["mesh", "in_step"], ...] = Field(("mesh", "in_step"), min_length=1)
    phase_conventions: tuple[Literal["geometric", "printed"], ...] = Field(
        ("geometric", "printed"), min_length=1
    )
    waveforms: tuple[Literal["sine", "triangle", "arcs"], ...] = Field(("sine",), min_length=1)
    stiffness_loads: tuple[Literal["operating", "mean"], ...] = Field(
        ("operating", "mean"), min_length=1, description="load at which k(t) has its shape"
    )
    budget: SearchBudget = SearchBudget()
    random: RandomInputs = RandomInputs()
    runs: int = Field(2, ge=1, le=1000, description="of each set; all but the first moved by 1e-12")
    designs: tuple[Point, ...] = Field(
        (), description="other plausible gear data for the first estimate of the load"
    )

    @model_validator(mode="after")
    def _distinct(self) -> "Identify":
        labels = [design.label for design in self.designs]
        if len(set(labels)) < len(labels):
            refuse("designs", labels, "each design needs its own label")
        return self


def branches(section: Identify) -> tuple[Branch, ...]:
    """All combinations of the choices that are not numbers."""
    return tuple(
        Branch(
            Meaning(meaning),
            phasing == "in_step",
            PhaseConvention(convention),
            Waveform(waveform),
            StiffnessLoad(load),
        )
        for meaning, phasing, convention, waveform, load in itertools.product(
            section.meanings,
            section.phasings,
            section.phase_conventions,
            section.waveforms,
            section.stiffness_loads,
        )
    )


def search_space(section: Ranges) -> Space:
    """Ranges of the numbers in SI."""
    return Space(torque=section.per_input_n_m, tail_share=section.tail_share)


def search_budget(section: SearchBudget) -> Budget:
    """Evaluations of one branch."""
    return Budget(section.scan, section.population, section.generations, section.seed)


def design_size(section: RandomInputs, design: Design) -> int:
    """Samples of a design."""
    return section.samples if design == "random" else section.structure_samples * len(half_turn_patterns())


def design_chunks(section: RandomInputs, design: Design) -> list[tuple[int, int]]:
    """Numbers of the first and the last sample of each chunk."""
    return chunk_ranges(design_size(section, design), section.chunk_samples)


def fit_targets(section: FitTargets, speed_rpm: float) -> Targets:
    """Targets of the fit at the nominal speed."""
    return Targets(
        speed=speed_rpm,
        backlash=tuple(
            BacklashTarget(1e-6 * one.backlash_um, one.inputs_mean, one.idlers_mean, one.idlers_minimum)
            for one in section.backlash
        ),
        jumps=section.jumps_rpm,
        coefficient_tolerance=section.coefficient_tolerance,
        speed_tolerance=section.speed_tolerance,
    )
