"""Config section `strength`: materials, duty cycle and factors of the rating of a tooth pair."""

from collections.abc import Mapping
from functools import partial
from typing import Any, Literal

from pydantic import Field, field_validator, model_validator

from facegear.quantities import BODIES
from facegear.schema.base import Section, refuse, require_all
from facegear.schema.cards import CARDS, Card, read_card
from facegear.schema.csv_file import CsvFault, read_numbers

BIN_COLUMNS = ("torque_n_m", "speed_rpm", "hours")
"""Columns of a csv of the duty cycle."""


class DutySection(Section):
    """One bin of the duty cycle: the pinion's torque in this mesh, its speed, and how long."""

    torque_n_m: float = Field(ge=1e-6, le=1e7, description="on the pinion, in this mesh")
    speed_rpm: float = Field(ge=1e-3, le=1e6, description="of the pinion")
    hours: float = Field(ge=0, le=1e7, description="how long the load lasts")


class BodyStrength(Section):
    """Material, roughness and loading of one gear, for the rating."""

    card: Card = Field(description="name of a card of the package, a yaml file, or the card itself")
    root_roughness_um: float = Field(
        ge=0.1, le=40, description="Rz of the fillet, within the range of Y_R in ISO 6336-3"
    )
    cycles_per_turn: int | None = Field(
        default=None,
        ge=1,
        le=100,
        description="how often the same flank of a tooth is loaded in a turn; null: as on an input pinion "
        "and on the face gears of transmission, 1 without; counted where load_factors is machine",
    )
    both_ways: bool = Field(
        default=False,
        description="the other flank is loaded as well, as on an idler; counted where load_factors "
        "is machine",
    )

    @field_validator("card", mode="before")
    @classmethod
    def _read(cls, card: Any) -> Any:
        """Read the card of a material by its name."""
        return read_card(Card, card, CARDS)


class BearingStrength(Section):
    """Conditions and required life of rolling bearings."""

    required_hours: float | None = Field(
        None,
        gt=0,
        le=1e7,
        description="life that each bearing, and all together, must reach; null: not judged",
    )
    contamination_factor: float | None = Field(
        None, gt=0, le=1, description="e_C of ISO 281, from dirty to 1 (clean); null: no modified life"
    )
    viscosity_ratio: float | None = Field(
        None, ge=0.1, le=100, description="kappa of ISO 281; null: no modified life"
    )

    @model_validator(mode="after")
    def _of_modified_life(self) -> "BearingStrength":
        """Refuse one of both conditions of the modified life without the other."""
        keys = ("contamination_factor", "viscosity_ratio")
        for key, partner in (keys, keys[::-1]):
            if getattr(self, key) is None and getattr(self, partner) is not None:
                refuse(key, None, f"given beside {partner}: the modified life needs both")
        return self


class Strength(Section):
    """Safety and life of the pair, and life of rolling bearings, under a duty cycle."""

    pinion: BodyStrength | None = Field(
        None, description="material and loading of the pinion's teeth; null: teeth are not rated"
    )
    face_gear: BodyStrength | None = Field(
        None, description="material and loading of the face gear's teeth; null: teeth are not rated"
    )
    duty: tuple[DutySection, ...] = Field(default=(), max_length=10000, description="bins of the duty cycle")
    duty_csv: str | None = Field(
        default=None,
        description=f"csv of the bins with columns {', '.join(BIN_COLUMNS)}; the name counts from this file",
    )
    application_factor: float = Field(default=1.0, ge=0.1, le=10, description="K_A")
    load_factors: Literal["given", "machine"] = Field(
        default="given",
        description="K_v and K_gamma: given here, or the loads of each flank from the machine's motion",
    )
    dynamic_factor: float = Field(default=1.0, ge=0.1, le=10, description="K_v")
    mesh_load_factor: float = Field(default=1.0, ge=0.1, le=10, description="K_gamma of parallel meshes")
    min_bending_safety: float = Field(
        default=1.4, ge=1, le=10, description="S_F min: smallest safety against bending that is accepted"
    )
    min_pitting_safety: float = Field(
        default=1.0, ge=1, le=10, description="S_H min: smallest safety against pitting that is accepted"
    )

    bearings: BearingStrength | None = Field(
        None,
        description="rolling bearings of the shafts, whose duty cycle needs neither pinion nor face_gear; "
        "null: their lives are not judged",
    )

    @model_validator(mode="before")
    @classmethod
    def _bins(cls, values: Any) -> Any:
        """Read the bins of the duty cycle from a csv file where one is given."""
        if not isinstance(values, Mapping):
            return values
        if isinstance(values.get("duty"), list):
            values = {**values, "duty": tuple(values["duty"])}
        if not isinstance(name := values.get("duty_csv"), str):
            return values
        if values.get("duty"):
            refuse("duty_csv", name, "either duty_csv or duty, not both")
        try:
            duty = tuple(row.values for row in read_numbers(name, BIN_COLUMNS))
        except CsvFault as fault:
            refuse("duty_csv", name, f"a csv of numbers; {fault}")
        return {**values, "duty_csv": None, "duty": duty}

    @model_validator(mode="after")
    def _complete(self) -> "Strength":
        """Check factors, duty cycle and material cards; all mistakes are reported together."""
        cards = (partial(self._check_card, name) for name in BODIES if self.rates_teeth)
        require_all(self._check_bodies, self._check_factors, self._check_counted, self._check_duty, *cards)
        return self

    @property
    def rates_teeth(self) -> bool:
        """Whether teeth are rated; otherwise the duty cycle is that of rolling bearings alone."""
        return self.pinion is not None and self.face_gear is not None

    def _check_bodies(self) -> None:
        """Refuse one body without the other, and factors of teeth that are not rated."""
        if self.rates_teeth:
            return
        for name, partner in (BODIES, BODIES[::-1]):
            if getattr(self, name) is None and getattr(self, partner) is not None:
                refuse(name, None, f"given beside {partner}, or both left out: teeth are rated by both")
        if self.bearings is None:
            refuse("bearings", None, "given where pinion and face_gear are left out: nothing is rated")
        if self.load_factors == "machine":
            requirement = "left out where teeth are not rated (pinion, face_gear)"
            refuse("load_factors", "machine", requirement)
        for key in ("dynamic_factor", "mesh_load_factor"):
            if getattr(self, key) != 1.0:
                refuse(key, getattr(self, key), "left out where teeth are not rated (pinion, face_gear)")

    def _check_factors(self) -> None:
        """Refuse load factors that are given although they are taken from the machine."""
        for key in ("dynamic_factor", "mesh_load_factor"):
            if self.load_factors == "machine" and getattr(self, key) != 1.0:
                refuse(key, getattr(self, key), "left out where load_factors is machine")

    def _check_counted(self) -> None:
        """Refuse cycles a turn and loading both ways that are given although they are counted in the
        machine.
        """
        for name in BODIES:
            for key in ("cycles_per_turn", "both_ways"):
                value = getattr(getattr(self, name), key, None)
                if self.load_factors == "machine" and value:
                    refuse(f"{name}.{key}", value, "left out where load_factors is machine")

    def _check_duty(self) -> None:
        """Refuse a duty cycle without hours."""
        if not any(load.hours > 0 for load in self.duty):
            refuse("duty", [], "at least one bin with hours, here or in duty_csv")

    def _check_card(self, name: str) -> None:
        """Refuse a material card of a body that lacks limits which the rating needs."""
        card = getattr(self, name).card
        for part in ("pitting", "bending"):
            if getattr(card, part) is None:
                refuse(f"{name}.card", card.name, f"a card with {part}, which the rating needs")
        if card.bending.slip_layer_mm is None:
            refuse(f"{name}.card", card.name, "a card with bending.slip_layer_mm, which the rating needs")
        loads_both_ways = getattr(self, name).both_ways or self.load_factors == "machine"
        if loads_both_ways and card.bending.mean_stress is None:
            requirement = "a card with bending.mean_stress, which teeth bent both ways need"
            refuse(f"{name}.card", card.name, requirement)

    @property
    def torques(self) -> tuple[float, float]:
        """Smallest and largest torque of the duty cycle with all given factors, N m; bins without hours
        do not count.
        """
        loads = [self.factor * load.torque_n_m for load in self.duty if load.hours > 0]
        return min(loads), max(loads)

    @property
    def factor(self) -> float:
        """Product K_A K_v K_gamma of the load factors that the config gives; factors of the machine are
        left out.
        """
        return self.application_factor * self.dynamic_factor * self.mesh_load_factor
