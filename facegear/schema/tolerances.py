"""Config section `tolerances`: what varies from machine to machine, how it is sampled, what is asked."""

from typing import Annotated, Literal

import numpy as np
from pydantic import Field, model_validator

from facegear.arrays import Array
from facegear.number_format import count_noun
from facegear.quantities import QUANTITIES
from facegear.schema.base import Section, refuse, require_all

MAX_SAMPLES = 2**24
"""Largest number of samples, and of blocks of the design for Sobol indices."""
MAX_CHUNKS = 500
"""Largest number of chunks, each of which is a job."""
FARTHEST_CUT, NO_CUT = 6.0, 20.0
"""Standard deviations: beyond the first 1e-9 of a normal distribution is left, beyond the second nothing."""
MAX_MAPPED = 200_000
"""Machines of a map of loads, which is one job."""
RESERVED_COLUMNS = ("sample", "error")
"""Columns of a table of samples beside causes and quantities."""
SMALLEST, LARGEST = 1e-15, 1e15
"""Bounds on deviations, in the unit of any key: no more than a guard against mistakes in an exponent."""
Deviation = Annotated[float, Field(ge=-LARGEST, le=LARGEST)]


class CauseSection(Section):
    """Something that varies from machine to machine, and the numbers of the config that it moves."""

    name: str = Field(pattern=r"^[a-z][a-z0-9_]{0,39}$", description="names its column in tables")
    shape: Literal["normal", "uniform", "rayleigh", "choice"] = Field(
        "normal", description="of its distribution"
    )
    centre: float = Field(0.0, ge=-LARGEST, le=LARGEST, description="of a normal distribution")
    spread: float | None = Field(
        None,
        ge=SMALLEST,
        le=LARGEST,
        description="standard deviation; of one component where the shape is rayleigh",
    )
    limits: tuple[Deviation, Deviation] | None = Field(
        None, description="of a uniform distribution; where a normal or rayleigh one is cut"
    )
    values: tuple[Deviation, ...] = Field((), description="of shape choice, each as likely")
    moves: dict[str, Deviation] = Field(
        min_length=1,
        description="dotted key of a number of `transmission`, `lubrication`, dynamics.speed_rpm, or of "
        "the tooth pair's assembly, reliefs, crowning and moduli -> what one unit of the cause adds to it",
    )
    source: str = Field(min_length=1, max_length=200, description="ISO grade or drawing that it is from")

    @model_validator(mode="after")
    def _check_shape(self) -> "CauseSection":
        """Refuse a cause without the numbers that its distribution needs."""
        asks = {
            "normal": ("spread",),
            "uniform": ("limits",),
            "rayleigh": ("spread",),
            "choice": ("values",),
        }
        for key in asks[self.shape]:
            if not getattr(self, key):
                refuse(key, getattr(self, key), f"given, as required by shape {self.shape}")
        if self.limits is not None and self.limits[1] <= self.limits[0]:
            refuse("limits", list(self.limits), "two numbers, the lower one first")
        self._check_cut()
        return self

    def _check_cut(self) -> None:
        """Refuse limits that cut off nothing of a distribution, or so much that the rest cannot
        be sampled.
        """
        if self.limits is None or self.shape not in ("normal", "rayleigh") or self.spread is None:
            return
        centre = self.centre if self.shape == "normal" else 0.0
        low, high = ((end - centre) / self.spread for end in self.limits)
        if low > FARTHEST_CUT or high < -FARTHEST_CUT:
            reason = "beyond which next to nothing is left to sample"
            refuse("limits", list(self.limits), f"within {FARTHEST_CUT:g} spreads of the middle, {reason}")
        if high > NO_CUT and (low < -NO_CUT or self.shape == "rayleigh"):
            requirement = (
                f"nearer than {NO_CUT:g} spreads on one side at least, or left out: nothing is cut off"
            )
            refuse("limits", list(self.limits), requirement)


class RankCorrelation(Section):
    """Two causes that come together."""

    between: tuple[str, str] = Field(description="names of the two causes")
    coefficient: float = Field(gt=-1, lt=1, description="correlation of their normal scores")


class LoadMap(Section):
    """Torques and speeds at which percentiles are asked for too, of the same samples everywhere."""

    torque_factors: tuple[Annotated[float, Field(ge=1e-6, le=10)], ...] = Field(
        (0.25, 0.5, 1.0, 1.5), min_length=1, max_length=50, description="times all torques of `transmission`"
    )
    speeds_rpm: tuple[Annotated[float, Field(ge=1, le=1e5)], ...] = Field(
        (), max_length=200, description="for model dynamic; none: dynamics.speed_rpm"
    )
    samples: int = Field(
        384,
        ge=2,
        le=100_000,
        description="at every torque and speed; from 368 on they bound the 99th percentile",
    )

    @model_validator(mode="after")
    def _check_loads(self) -> "LoadMap":
        """Refuse torques and speeds that do not rise, and maps with too many points."""
        for key in ("torque_factors", "speeds_rpm"):
            values = getattr(self, key)
            if list(values) != sorted(set(values)):
                refuse(key, list(values), "rising, each once")
        points = len(self.torque_factors) * max(len(self.speeds_rpm), 1)
        if points * self.samples > MAX_MAPPED:
            refuse(
                "samples",
                self.samples,
                f"at most {MAX_MAPPED // points}: there are {count_noun(points, 'load')}",
            )
        return self

    def loads(self, speed_rpm: float) -> list[tuple[float, float]]:
        """Return the points of the load map: every torque factor with every speed.

        Parameters
        ----------
        speed_rpm : float
            Pinion speed (rpm) to take where the section names none.

        Returns
        -------
        list[tuple[float, float]]
            Torque factor (unit 1) and speed (rpm) of every point.
        """
        speeds = self.speeds_rpm or (speed_rpm,)
        return [(factor, speed) for factor in self.torque_factors for speed in speeds]


class Tolerances(Section):
    """Samples of one machine with its tolerances, and what they say."""

    causes: tuple[CauseSection, ...] = Field(max_length=200, description="at least one")
    correlations: tuple[RankCorrelation, ...] = Field((), description="causes that come together")
    model: Literal["quasi_static", "dynamic"] = Field(
        "quasi_static", description="load sharing over the hunting cycle, or of the motion at the speed"
    )
    samples: int = Field(1024, ge=1, le=MAX_SAMPLES, description="a multiple of chunk_samples")
    index_blocks: int = Field(
        0, ge=0, le=MAX_SAMPLES, description="of the design for Sobol indices, a power of two; 0: none"
    )
    chunk_samples: int = Field(256, ge=1, le=100_000, description="samples of one job")
    seed: int = Field(0, ge=0, le=2**31, description="of the samples")
    confidence: float = Field(0.95, gt=0.5, lt=1.0, description="level of the intervals")
    tooth_contact: bool = Field(
        False,
        description="pressure, root stress and transmission error of every machine as well; causes that move "
        "the tooth pair bring them",
    )
    load_map: LoadMap | None = Field(
        None, description="percentiles over torque and speed; null: at the machine's own load alone"
    )
    hunting_cycles: int = Field(
        32,
        ge=1,
        le=100_000,
        description="mesh cycles taken from the hunting cycle, evenly spread, beside its hardest ones",
    )

    @model_validator(mode="after")
    def _possible(self) -> "Tolerances":
        """Check causes, map, samples, indices and chunks; all mistakes are reported together."""
        require_all(
            self._check_causes,
            self._check_map,
            self._check_samples,
            self._check_indices,
            self._check_chunks,
        )
        return self

    def _check_causes(self) -> None:
        """Refuse an empty list of causes, and reserved or repeated names."""
        names = [cause.name for cause in self.causes]
        if not names:
            refuse("causes", [], "at least one")
        for number, name in enumerate(names):
            if name in RESERVED_COLUMNS or name in QUANTITIES:
                refuse(
                    f"causes[{number}].name", name, "another one: it is a column of its own in the samples"
                )
            if name in names[:number]:
                refuse(f"causes[{number}].name", name, "a name of its own for each cause")
        for number, pair in enumerate(self.correlations):
            if pair.between[0] == pair.between[1] or not set(pair.between) <= set(names):
                requirement = f"two of {', '.join(names)}"
                refuse(f"correlations[{number}].between", list(pair.between), requirement)
        matrix = correlation_matrix(self)
        if matrix is not None and np.linalg.eigvalsh(matrix)[0] <= 0.0:
            coefficients = [[*pair.between, pair.coefficient] for pair in self.correlations]
            refuse("correlations", coefficients, "numbers that can hold together: the matrix is not positive")

    def _check_map(self) -> None:
        """Refuse speeds of the load map for a quasi-static model."""
        if self.load_map is not None and self.load_map.speeds_rpm and self.model == "quasi_static":
            refuse("load_map.speeds_rpm", list(self.load_map.speeds_rpm), "none where model is quasi_static")

    def _check_samples(self) -> None:
        """Refuse a number of samples that is no multiple of a chunk's."""
        if self.samples % self.chunk_samples:
            below = max(self.samples // self.chunk_samples, 1) * self.chunk_samples
            refuse("samples", self.samples, f"a multiple of chunk_samples, such as {below}")

    def _check_indices(self) -> None:
        """Refuse blocks of sensitivity indices that are no power of two, or with correlated causes."""
        if self.index_blocks & (self.index_blocks - 1):
            refuse("index_blocks", self.index_blocks, "a power of two, or 0")
        if self.index_blocks and self.correlations:
            refuse("index_blocks", self.index_blocks, "0 where causes are correlated: indices are undefined")

    def _check_chunks(self) -> None:
        """Refuse chunks so small that there would be more than MAX_CHUNKS."""
        count = len(chunks(self, "samples")) + len(chunks(self, "indices"))
        if count > MAX_CHUNKS:
            min_samples = -(-self.chunk_samples * count // MAX_CHUNKS)
            refuse(
                "chunk_samples", self.chunk_samples, f"at least {min_samples}, for at most {MAX_CHUNKS} jobs"
            )


Design = Literal["samples", "indices"]
"""Plain samples for percentiles and fractions, or Saltelli's design for Sobol indices."""


def sizes(section: Tolerances, design: Design) -> int:
    """Return the number of samples of a sampling design.

    Parameters
    ----------
    section : Tolerances
        Section `tolerances` of the config.
    design : Design
        `samples`: plain samples. `indices`: blocks of Saltelli's design, of causes + 2 samples each.

    Returns
    -------
    int
        Number of samples.
    """
    return section.samples if design == "samples" else section.index_blocks * (len(section.causes) + 2)


def chunks(section: Tolerances, design: Design) -> list[tuple[int, int]]:
    """Divide the samples of a sampling design into chunks, one job each.

    Parameters
    ----------
    section : Tolerances
        Section `tolerances` of the config.
    design : Design
        `samples` or `indices`.

    Returns
    -------
    list[tuple[int, int]]
        Numbers of the first and last sample of each chunk, from 0, both included.
    """
    return chunk_ranges(sizes(section, design), section.chunk_samples)


def chunk_ranges(size: int, step: int) -> list[tuple[int, int]]:
    """Divide samples, numbered from 0, into chunks; the last one may be shorter.

    Parameters
    ----------
    size : int
        Number of samples.
    step : int
        Largest number of samples in a chunk.

    Returns
    -------
    list[tuple[int, int]]
        Numbers of the first and last sample of each chunk, both included.
    """
    return [(first, min(first + step, size) - 1) for first in range(0, size, step)]


def correlation_matrix(section: Tolerances) -> Array | None:
    """Return the correlation of the normal scores of all causes.

    Parameters
    ----------
    section : Tolerances
        Section `tolerances` of the config.

    Returns
    -------
    (causes, causes) array or None
        Correlation coefficients, dimensionless; None where causes are independent.
    """
    if not section.correlations:
        return None
    index = {cause.name: number for number, cause in enumerate(section.causes)}
    matrix = np.eye(len(index))
    for pair in section.correlations:
        first, second = (index[name] for name in pair.between)
        matrix[first, second] = matrix[second, first] = pair.coefficient
    return matrix
