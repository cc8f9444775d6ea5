"""Config section `dynamics`: nominal speed, accuracy, how long to wait and measure, speed sweep."""

from dataclasses import replace
from typing import Literal

from pydantic import Field, model_validator

from facegear.config.base import Section, refuse
from facegear.dynamics.motion import Settings
from facegear.dynamics.sweeps.plan import SweepPlan

MAX_SPEED_RPM = 200_000
"""Largest pinion speed that a config may give, rpm."""
SECOND_LOOKS = 3
"""Other starts from which a class of motion that is in doubt must come out again."""
CARRIED_STATE_OFFSET = 1e-2
"""Distance of these other starts from a state that is carried from speed to speed, over the length scale."""


class Accuracy(Section):
    """Numerical settings of a steady state; lengths in mesh periods."""

    tolerance: float = Field(
        1e-6, ge=1e-13, le=1e-2, description="local error of a step over the length scale"
    )
    dwell_periods: int = Field(32, ge=16, le=1_000_000, description="run before anything is judged")
    settle_periods: int = Field(
        8192, ge=16, le=10_000_000, description="watched before a motion counts as not periodic"
    )
    window_periods: int = Field(
        256, ge=16, le=1_000_000, description="measured where the motion is not periodic"
    )
    longest_period: int = Field(64, ge=1, le=1024, description="longest period looked for")
    periodic_residual: float = Field(
        1e-7, ge=1e-13, le=1e-2, description="change over a period, over the scale"
    )
    samples_per_period: int = Field(
        64, ge=16, le=4096, description="at least; more are taken where the motion needs them"
    )
    refine: bool = Field(True, description="periodic orbits to rounding, with Floquet multipliers")
    extensions: int = Field(
        2, ge=0, le=10, description="doublings of patience for a motion that is undecided"
    )


SWEEP_ACCURACY = Accuracy(
    tolerance=3e-5,
    dwell_periods=32,
    settle_periods=256,
    window_periods=160,
    longest_period=64,
    periodic_residual=1e-5,
    extensions=1,
    samples_per_period=32,
)
"""Accuracy of each speed where many speeds are run in a row."""
SWEPT_TEXT = (
    f"left out as a whole: tolerance {SWEEP_ACCURACY.tolerance:g}, "
    f"settle_periods {SWEEP_ACCURACY.settle_periods}, window_periods {SWEEP_ACCURACY.window_periods}, "
    f"periodic_residual {SWEEP_ACCURACY.periodic_residual:g}, "
    f"extensions {SWEEP_ACCURACY.extensions}, samples_per_period {SWEEP_ACCURACY.samples_per_period}; "
    "else each key's own default"
)
"""Description of the keys with the default SWEEP_ACCURACY."""


class Sweep(Section):
    """Speeds run up and down with the state carried over."""

    from_rpm: float = Field(200, ge=1, le=MAX_SPEED_RPM, description="smallest pinion speed")
    to_rpm: float = Field(20_000, ge=1, le=MAX_SPEED_RPM, description="largest pinion speed")
    points: int = Field(400, ge=2, le=100_000, description="evenly spaced speeds, both ends included")
    directions: tuple[Literal["up", "down"], ...] = Field(
        ("up", "down"), min_length=1, max_length=2, description="ways in which the speeds are run"
    )
    chunks: int = Field(
        1, ge=1, le=1000, description="independent pieces of each direction; more for more than two cores"
    )
    overlap_points: int = Field(8, ge=0, le=1000, description="speeds a chunk runs before its own first one")
    jump_resolution_rpm: float = Field(
        1.0, ge=1e-6, le=1000, description="width to which the speed of a jump is bracketed"
    )
    accuracy: Accuracy = Field(SWEEP_ACCURACY, description=SWEPT_TEXT)

    @model_validator(mode="after")
    def _check_speeds(self) -> "Sweep":
        if self.to_rpm <= self.from_rpm:
            refuse("to_rpm", self.to_rpm, f"more than from_rpm = {self.from_rpm}")
        if len(set(self.directions)) < len(self.directions):
            refuse("directions", list(self.directions), "up, down, or both once")
        if self.chunks > self.points:
            refuse("chunks", self.chunks, f"at most one for each of the {self.points} points")
        return self


class Dynamics(Section):
    """Time response of the lumped model."""

    speed_rpm: float = Field(7500, ge=1, le=MAX_SPEED_RPM, description="nominal pinion speed")
    accuracy: Accuracy = Field(Accuracy(), description="of the response at the nominal speed")
    sweep: Sweep = Sweep()


def settings(section: Accuracy) -> Settings:
    """Return the settings of the steady-state search.

    Parameters
    ----------
    section : Accuracy
        Section `accuracy` of the config.

    Returns
    -------
    Settings
        The settings; lengths in mesh periods.
    """
    return Settings(
        tolerance=section.tolerance,
        dwell=section.dwell_periods,
        settle=max(section.settle_periods, section.dwell_periods),
        longest_period=section.longest_period,
        periodic_residual=section.periodic_residual,
        window=section.window_periods,
        samples=section.samples_per_period,
        refine=section.refine,
        extensions=section.extensions,
    )


def sweep_plan(section: Sweep) -> SweepPlan:
    """Return speeds, directions, chunks and settings of the speed sweep.

    Parameters
    ----------
    section : Sweep
        Section `dynamics.sweep` of the config.

    Returns
    -------
    SweepPlan
        The plan; speeds in rpm.
    """
    return SweepPlan(
        first_rpm=section.from_rpm,
        last_rpm=section.to_rpm,
        points=section.points,
        directions=section.directions,
        chunks=section.chunks,
        overlap=section.overlap_points,
        jump_resolution_rpm=section.jump_resolution_rpm,
        settings=replace(settings(section.accuracy), second_looks=SECOND_LOOKS, aside=CARRIED_STATE_OFFSET),
    )
