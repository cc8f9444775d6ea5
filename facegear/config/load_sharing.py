"""Config section `load_sharing`: how long and from how many starts the coefficients are averaged."""

from pydantic import Field, model_validator

from facegear.config.base import Section, refuse
from facegear.load_sharing.options import SharingOptions, SpeedRange


class SpeedRangeSection(Section):
    """Speeds over which the largest coefficients are looked for."""

    from_rpm: float = Field(200.0, ge=1, le=1e5, description="smallest pinion speed")
    to_rpm: float = Field(20000.0, ge=1, le=1e5, description="largest pinion speed")
    points: int = Field(100, ge=2, le=2000, description="evenly spaced speeds, both ends included")

    @model_validator(mode="after")
    def _check_speeds(self) -> "SpeedRangeSection":
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


def sharing_options(section: LoadSharing) -> SharingOptions:
    """Return the options of the load-sharing stage in SI units.

    Parameters
    ----------
    section : LoadSharing
        Section `load_sharing` of the config.

    Returns
    -------
    SharingOptions
        The options; speeds in rpm.
    """
    speeds = section.speed_range
    return SharingOptions(
        samples=section.samples_per_cycle,
        cycles=section.cycles,
        starts=section.starts,
        spread=1e-6 * section.start_spread_um,
        seed=section.seed,
        confidence=section.confidence,
        slow_rpm=section.quasi_static_rpm,
        speeds=SpeedRange(speeds.from_rpm, speeds.to_rpm, speeds.points),
    )
