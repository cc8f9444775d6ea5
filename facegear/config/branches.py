"""Config section `branches`: which motions exist over the speed, where they end, how far a jump is."""

from typing import Annotated, Literal

from pydantic import Field, model_validator

from facegear.config.base import Section, refuse
from facegear.config.dynamics import MAX_SPEED_RPM
from facegear.dynamics.branches.plan import BranchPlan

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
        if self.to_rpm <= self.from_rpm:
            refuse("to_rpm", self.to_rpm, f"more than from_rpm = {self.from_rpm}")
        for speed in self.explore.speeds_rpm:
            if not self.from_rpm <= speed <= self.to_rpm:
                refuse("explore.speeds_rpm", speed, f"from {self.from_rpm:g} to {self.to_rpm:g}")
        return self


def branch_plan(section: Branches | None, nominal_rpm: float) -> BranchPlan:
    """Return the plan of the continuation of periodic motions.

    Parameters
    ----------
    section : Branches or None
        Section `branches` of the config; its defaults are used if None.
    nominal_rpm : float
        Nominal pinion speed, rpm.

    Returns
    -------
    BranchPlan
        The plan in SI units, but for speeds in rpm.
    """
    section = section or Branches()
    return BranchPlan(
        from_rpm=section.from_rpm,
        to_rpm=section.to_rpm,
        nominal_rpm=nominal_rpm,
        tolerance=section.tolerance,
        longest_period=section.longest_period,
        longest_start_period=section.longest_start_period,
        max_branches=section.max_branches,
        speeds_rpm=section.explore.speeds_rpm or (nominal_rpm,),
        starts=section.explore.starts,
        spread=1e-6 * section.explore.spread_um,
        seed=section.explore.seed,
        parameters=section.loci.parameters,
        factors=(section.loci.from_factor, section.loci.to_factor),
        nearest=section.loci.nearest,
    )
