"""Config section `sharing_map`: deviations of the idlers' paths, and how finely their map is drawn."""

from itertools import pairwise
from typing import Annotated

from pydantic import Field, model_validator

from facegear.config.base import Section, refuse
from facegear.load_sharing.options import MapOptions


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
        if self.mesh_deviation_um == 0.0 and self.position_deviation_um == 0.0:
            refuse("mesh_deviation_um", 0.0, "above 0, or position_deviation_um above 0")
        factors = self.input_bearing_factors
        if any(after <= before for before, after in pairwise(factors)):
            refuse("input_bearing_factors", list(factors), "rising, each once")
        return self


def map_options(section: SharingMap) -> MapOptions:
    """Return the section's values in SI units.

    Parameters
    ----------
    section : SharingMap
        As given.

    Returns
    -------
    MapOptions
        Lengths in m.
    """
    return MapOptions(
        mesh_error=1e-6 * section.mesh_deviation_um,
        position=1e-6 * section.position_deviation_um,
        samples=section.samples,
        points=section.points,
        seed=section.seed,
        bearing_factors=section.input_bearing_factors,
    )
