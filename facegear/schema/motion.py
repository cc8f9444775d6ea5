"""Config sections `dynamics`, `branches`, `load_sharing` and `sharing_map`: the machine in motion.

Speeds, accuracy, sweeps, continuation of motions; averages of the shares, deviations of the idlers' paths.
"""

from itertools import pairwise
from typing import Annotated, Literal

from pydantic import Field, model_validator

from facegear.schema.base import Section, refuse

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
        """Refuse an empty range of speeds and repeated directions."""
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


Parameter = Literal["torque", "backlash", "mesh_damping", "bearing_stiffness"]


class Explore(Section):
    """Random starts at chosen speeds."""

    speeds_rpm: tuple[Annotated[float, Field(ge=1e-3, le=MAX_SPEED_RPM)], ...] = Field(
        (), max_length=200, description="empty: the nominal speed alone"
    )
    starts: int = Field(100, ge=1, le=1_000_000, description="at each speed")
    spread_um: float = Field(
        100.0,
        ge=1e-6,
        le=1e5,
        description="half width of the box around rest: displacements, and rotations at the mesh radius",
    )
    seed: int = Field(0, ge=0, le=2**31, description="of the random starts")


class Loci(Section):
    """Curves of folds and period doublings in the plane of speed and one more parameter."""

    parameters: tuple[Parameter, ...] = Field(("torque",), max_length=4, description="multiplied by a factor")
    from_factor: float = Field(0.5, ge=1e-3, lt=1, description="smallest factor on the parameter")
    to_factor: float = Field(2.0, gt=1, le=1000, description="largest factor on the parameter")
    nearest: int = Field(4, ge=0, le=1000, description="special points nearest to the nominal speed")


class Branches(Section):
    """Continuation of periodic motions, stable or not."""

    from_rpm: float = Field(200, ge=1e-3, le=MAX_SPEED_RPM, description="smallest pinion speed")
    to_rpm: float = Field(20_000, ge=1e-3, le=MAX_SPEED_RPM, description="largest pinion speed")
    tolerance: float = Field(
        1e-7,
        ge=1e-14,
        le=1e-5,
        description="about the error of orbits in length scales and of special points over the speed",
    )
    longest_period: int = Field(
        2, ge=1, le=64, description="longest period followed through doublings, in mesh periods"
    )
    longest_start_period: int = Field(
        8, ge=1, le=64, description="longest period followed of motions of the sweep and of random starts"
    )
    max_branches: int = Field(48, ge=1, le=10_000, description="how many branches are followed")
    explore: Explore = Explore()
    loci: Loci = Loci()

    @model_validator(mode="after")
    def _check_speeds(self) -> "Branches":
        """Refuse an empty range of speeds and explored speeds outside it."""
        if self.to_rpm <= self.from_rpm:
            refuse("to_rpm", self.to_rpm, f"more than from_rpm = {self.from_rpm}")
        for speed in self.explore.speeds_rpm:
            if not self.from_rpm <= speed <= self.to_rpm:
                refuse("explore.speeds_rpm", speed, f"from {self.from_rpm:g} to {self.to_rpm:g}")
        return self


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
