"""Config of a rolling bearing: a card, or all dimensions given by hand."""

from collections.abc import Mapping
from importlib.resources import files
from math import pi, sin
from pathlib import Path
from typing import Any, Literal

from pydantic import Field, model_validator

from facegear.schema.base import Section, refuse, require_all
from facegear.schema.yaml_file import read_yaml

ROLLING_CARDS = Path(str(files("facegear") / "bearings" / "cards"))
"""Folder of the cards that come with the package."""
FEWEST_SLICES = 30
"""Slices of a roller that ISO/TS 16281 asks for at least."""
BALLS, ROLLERS = ("deep_groove_ball", "angular_contact_ball"), ("cylindrical_roller", "tapered_roller")
"""Types by their elements."""
ONE_WAY = ("angular_contact_ball", "tapered_roller")
"""Types with a contact angle, which take thrust one way only."""
KEYS_OF_TYPES = {
    "groove_ratio_inner": BALLS,
    "groove_ratio_outer": BALLS,
    "shoulder_angle_deg": BALLS,
    "contact_angle_deg": ONE_WAY,
    "loaded_by": ONE_WAY,
    "effective_length_mm": ROLLERS,
    "profile": ROLLERS,
    "slices": ROLLERS,
}
"""Keys that only some types have."""


class RollingSection(Section):
    """A rolling bearing of one row that knows its load."""

    type: Literal["deep_groove_ball", "angular_contact_ball", "cylindrical_roller", "tapered_roller"] = Field(
        description="kind of bearing; flanges of roller bearings carry nothing"
    )
    name: str | None = Field(None, description="of a card's bearing")
    source: str | None = Field(None, min_length=1, description="where a card's dimensions are from")
    elements: int = Field(ge=3, le=500, description="number of balls or rollers")
    element_diameter_mm: float = Field(ge=0.1, le=500, description="of balls or rollers")
    pitch_diameter_mm: float = Field(ge=1, le=1e4, description="of the circle of their middles")
    groove_ratio_inner: float | None = Field(
        None, ge=0.505, le=0.6, description="radius of the groove over the ball's diameter; null: 0.52"
    )
    groove_ratio_outer: float | None = Field(
        None, ge=0.505, le=0.6, description="radius of the groove over the ball's diameter; null: 0.52"
    )
    contact_angle_deg: float | None = Field(None, ge=1, le=45, description="nominal contact angle")
    loaded_by: Literal["+z", "-z"] | None = Field(
        None, description="thrust of the shaft that presses the rings together"
    )
    effective_length_mm: float | None = Field(None, ge=0.1, le=1000, description="of a roller")
    profile: Literal["logarithmic", "straight"] | None = Field(
        None, description="of the rollers; null: logarithmic, as in ISO/TS 16281"
    )
    slices: int | None = Field(None, ge=FEWEST_SLICES, le=1000, description="of a roller; null: 41")
    clearance_diametral_um: float = Field(
        0.0, ge=-200, le=1000, description="in operation; negative: elements are pressed in"
    )
    cage: Literal["averaged", "first_element_deg"] | None = Field(
        None,
        description="averaged: mean over all places of the elements; first_element_deg: they stand still; "
        "null: averaged, or where first_element_deg says",
    )
    first_element_deg: float | None = Field(
        None, ge=-360, le=360, description="of the first element, from x to y; null: 0 where elements stand"
    )
    centrifugal: bool = Field(
        False,
        description="whether elements feel centrifugal force at dynamics.speed_rpm, in the duty cycle at the "
        "speed of each bin; preload is that at rest",
    )
    speed_rpm: float | None = Field(
        None, ge=0, le=1e6, description="of the shaft, filled in where centrifugal is true"
    )
    shoulder_angle_deg: float | None = Field(
        None, gt=0, lt=90, description="largest contact angle that the shoulders allow; null: not checked"
    )
    load_rating_n: float | None = Field(
        None, ge=1, le=1e9, description="C of a catalogue; null: computed as in ISO 281"
    )
    fatigue_load_limit_n: float | None = Field(
        None, ge=1e-3, le=1e8, description="C_u of a catalogue; null: no modified life"
    )

    @model_validator(mode="before")
    @classmethod
    def _read_card(cls, values: Any) -> Any:
        """Return the values with the keys of the card that they name filled in; keys that are given go
        before.

        A text alone is the name of a card: one of the package, or with an ending a yaml file.
        """
        by_key = {"card": values} if isinstance(values, str) else values
        if not isinstance(by_key, Mapping) or "card" not in by_key:
            return by_key
        name = by_key["card"]
        names = sorted(card.stem for card in ROLLING_CARDS.glob("*.yaml"))
        is_file = isinstance(name, str) and bool(Path(name).suffix)
        if not is_file and name not in names:
            refuse("card", name, f"a yaml file, or one of {', '.join(names)}")
        card = read_yaml(Path(name) if is_file else ROLLING_CARDS / f"{name}.yaml")
        return {**card, **{key: value for key, value in by_key.items() if key != "card"}}

    @model_validator(mode="after")
    def _can_be(self) -> "RollingSection":
        """Check keys, cage, pitch diameter and clearance; all mistakes are reported together."""
        require_all(self._check_keys, self._check_cage, self._check_pitch, self._check_clearance)
        return self

    def _check_keys(self) -> None:
        """Refuse keys that a bearing of this type does not have, and those that it needs and lacks."""
        for key, types in KEYS_OF_TYPES.items():
            value = getattr(self, key)
            if value is not None and self.type not in types:
                refuse(key, value, f"left out of a bearing of type {self.type}")
        of_angle = ("contact_angle_deg", "loaded_by") if self.type in ONE_WAY else ()
        of_rollers = ("effective_length_mm",) if self.type in ROLLERS else ()
        for key in (*of_angle, *of_rollers):
            if getattr(self, key) is None:
                refuse(key, None, f"given for a bearing of type {self.type}")

    def _check_cage(self) -> None:
        """Refuse a place of the first element in a cage that is averaged over all places."""
        if self.cage == "averaged" and self.first_element_deg is not None:
            refuse("first_element_deg", self.first_element_deg, "left out where cage is averaged")

    @property
    def is_averaged(self) -> bool:
        """Whether the bearing is averaged over all places of its elements."""
        return self.cage == "averaged" or (self.cage is None and self.first_element_deg is None)

    def _check_pitch(self) -> None:
        """Refuse a pitch diameter on which neighbouring elements would overlap."""
        least = self.element_diameter_mm / sin(pi / self.elements)
        if self.pitch_diameter_mm < least:
            requirement = f"at least {least:.6g} mm, or its {self.elements} elements overlap"
            refuse("pitch_diameter_mm", self.pitch_diameter_mm, requirement)

    def _check_clearance(self) -> None:
        """Refuse a clearance of 0.02 element diameters or more in size."""
        largest = 20.0 * self.element_diameter_mm
        if abs(self.clearance_diametral_um) >= largest:
            requirement = f"smaller than 0.02 element_diameter_mm, which is {largest:g} um"
            refuse("clearance_diametral_um", self.clearance_diametral_um, requirement)
