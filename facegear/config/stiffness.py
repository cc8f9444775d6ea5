"""Config section `mesh_stiffness`: where the lumped model's k(t) comes from."""

from typing import Literal

from pydantic import Field, model_validator

from facegear.config.base import Section, refuse
from facegear.harmonics.series import Harmonics
from facegear.stiffness.request import StiffnessRequest


class HarmonicSection(Section):
    """One order of k(t) = sum a sin(order w t) + b cos(order w t)."""

    order: int = Field(ge=1, le=512)
    a_n_per_m: float = 0.0
    b_n_per_m: float = 0.0


class MeshStiffness(Section):
    """Source of the mesh stiffness, its mean, and what is kept of its shape."""

    source: Literal["fem", "fem_scaled", "harmonics"] = Field(
        description="fem: as computed at torque_n_m; fem_scaled: that shape with the mean given here; "
        "harmonics: given below"
    )
    mean_n_per_m: float = Field(gt=0, le=1e12, description="used by the modes, and by all sources but fem")
    torque_n_m: float | None = Field(
        default=None, gt=0, le=1e7, description="load on the pinion per mesh at which k is taken"
    )
    definition: Literal["average", "local"] = Field(
        default="average", description="F / deflection, or its slope dF / d deflection at that load"
    )
    harmonics_kept: int = Field(default=8, ge=0, le=512)
    table: tuple[HarmonicSection, ...] = Field(default=(), description="for source harmonics")
    csv: str | None = Field(
        default=None,
        description="for source harmonics, from this file's folder: columns as stiffness/harmonics.csv",
    )

    @model_validator(mode="after")
    def _complete(self) -> "MeshStiffness":
        given = bool(self.table) + (self.csv is not None)
        if self.source == "harmonics" and given != 1:
            refuse("table", len(self.table), "source harmonics needs either table or csv")
        if self.source != "harmonics" and given:
            refuse("source", self.source, "harmonics, as a table or csv is given")
        if self.source != "harmonics" and self.torque_n_m is None:
            refuse("torque_n_m", None, f"source {self.source} needs the load at which k is taken")
        orders = [row.order for row in self.table]
        if orders != sorted(set(orders)):
            refuse("table", orders, "orders rising, each once")
        return self


def stiffness_request(section: MeshStiffness) -> StiffnessRequest:
    """What is asked of the stiffness stage, with the series written in the config (N/m) if there is one."""
    order = max((row.order for row in section.table), default=0)
    a, b = [0.0] * (order + 1), [section.mean_n_per_m] + [0.0] * order
    for row in section.table:
        a[row.order], b[row.order] = row.a_n_per_m, row.b_n_per_m
    return StiffnessRequest(
        source=section.source,
        mean=section.mean_n_per_m,
        torque=section.torque_n_m,
        definition=section.definition,
        kept=section.harmonics_kept,
        given=Harmonics(a, b),
    )
