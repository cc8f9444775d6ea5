"""Config sections `load_sharing` and `sharing_map`: averages, deviations of the idlers' paths."""

from itertools import pairwise
from typing import Annotated

from pydantic import Field, model_validator

from facegear.schema.base import Section, refuse


class SpeedRangeSection(Section):
    """Speeds over which the largest coefficients are looked for."""

    from_rpm: float = Field(200.0, ge=1, le=1e5, description="smallest pinion speed")
    to_rpm: float = Field(20000.0, ge=1, le=1e5, description="largest pinion speed")
    points: int = Field(100, ge=2, le=2000, description="evenly spaced speeds, both ends included")

    @model_validator(mode="after")
    def _check_speeds(self) -> "SpeedRangeSection":
        """Refuse an empty range of speeds."""
        if self.to_rpm <= self.from_rpm:
            refuse("to_rpm", self.to_rpm, f"above from_rpm = {self.from_rpm:g}")
        return self


class LoadSharing(Section):
    """Averages over many cycles and starts, with their uncertainty; statics and slow running beside them."""

    samples_per_cycle: int = Field(256, ge=32, le=8192, description="of each mesh cycle")
    cycles: int = Field(200, ge=20, le=20000, description="mesh cycles kept from each start")
    starts: int = Field(4, ge=1, le=200, description="one from rest, the others disturbed at random")
    start_spread_um: float = Field(20.0, ge=0, le=1e4, description="size of the random disturbance")
    seed: int = Field(0, ge=0, le=2**31, description="of the random disturbance")
    confidence: float = Field(0.95, gt=0.5, lt=1.0, description="level of the intervals")
    quasi_static_rpm: float = Field(10.0, ge=1, le=1000, description="speed of the slow run")
    speed_range: SpeedRangeSection = SpeedRangeSection()
    hunting_positions: int = Field(
        16, ge=1, le=256, description="positions of each mesh cycle of the hunting cycle, at rest and running"
    )
    followed_cycles: int | None = Field(
        None,
        ge=1,
        le=100_000,
        description="mesh cycles for which the running machine is followed while runouts turn; null: all",
    )
    required_k_gamma: float | None = Field(
        None,
        ge=1.0,
        le=100.0,
        description="largest mesh load factor K_gamma allowed, judged in the report; null: not judged",
    )


class SharingMap(Section):
    """Mesh load factors over the numbers that decide them, and what changes of the machine would buy."""

    mesh_deviation_um: float = Field(
        5.0,
        ge=0,
        le=1000,
        description="standard deviation of the error of each mesh of an idler, along the line of action",
    )
    position_deviation_um: float = Field(
        5.0, ge=0, le=1000, description="standard deviation of the tangential position of each idler"
    )
    samples: int = Field(1000, ge=100, le=100_000, description="machines drawn for each point of a curve")
    points: int = Field(9, ge=2, le=200, description="values of the number on each curve")
    seed: int = Field(0, ge=0, le=2**31, description="of the draws")
    largest_number: float | None = Field(
        None,
        gt=0,
        le=10,
        description="largest k_e sigma / W and 2 b k / W of the curves; null: a fifth beyond the machine's",
    )
    input_bearing_factors: Annotated[
        tuple[Annotated[float, Field(ge=1e-4, le=1e4)], ...], Field(min_length=1, max_length=7)
    ] = Field((0.1, 0.3, 1.0, 3.0, 10.0), description="on the bearing stiffness of the inputs, a curve each")

    @model_validator(mode="after")
    def _possible(self) -> "SharingMap":
        """Refuse a map without any deviation, or with factors that do not rise."""
        if self.mesh_deviation_um == 0.0 and self.position_deviation_um == 0.0:
            refuse("mesh_deviation_um", 0.0, "above 0, or position_deviation_um above 0")
        factors = self.input_bearing_factors
        if any(after <= before for before, after in pairwise(factors)):
            refuse("input_bearing_factors", list(factors), "rising, each once")
        return self
