"""Config section `lubrication`: the oil, how it is supplied, roughness, friction and what the flanks bear."""

from typing import Annotated, Any, Literal

from pydantic import Field, field_validator, model_validator

from facegear.schema.base import Section, refuse
from facegear.schema.cards import OIL_CARDS, OilCard, read_card

LARGEST_RA_UM = 4.0
"""Roughest flank that the gear tests behind the friction models had."""

RQ_PER_RA = 1.25
"""Ratio Rq / Ra of a profile whose heights are normally distributed."""

SUPPLY_FACTORS = {"jet": 1.2, "dip": 1.0, "submerged": 0.2}
"""X_S of ISO/TS 6336-20."""

GEAR_TESTS = ("schlenk", "iso_6336_20", "iso_6336_22")
"""Models with the lubricant factor X_L."""


class Roughness(Section):
    """Roughness of a flank after running in."""

    ra_um: float = Field(ge=1e-3, le=LARGEST_RA_UM, description="arithmetic mean roughness Ra")
    rq_um: float | None = Field(None, ge=1e-3, le=10, description="root mean square; null: 1.25 Ra")


class DoleschelConstants(Section):
    """Constants of a twin disc test of the oil; the formula is in docs/explanation/friction.md."""

    solid: float = Field(ge=1e-6, le=1, description="mu_F at 1000 MPa and a sum velocity of 1 m/s")
    solid_pressure: float = Field(ge=-2, le=2, description="exponent of pressure in mu_F")
    solid_speed: float = Field(ge=-2, le=2, description="exponent of the sum velocity in mu_F")
    fluid: float = Field(ge=1e-6, le=1, description="mu_EHD at 1000 MPa, 1 m/s and 1 mPa s")
    fluid_pressure: float = Field(ge=-2, le=2, description="exponent of pressure in mu_EHD")
    fluid_speed: float = Field(ge=-2, le=2, description="exponent of the sum velocity in mu_EHD")
    fluid_viscosity: float = Field(ge=-2, le=2, description="exponent of the viscosity in mu_EHD")


class FrictionSection(Section):
    """Coefficient of friction as a function of load, speed, oil and roughness."""

    model: Literal[
        "constant", "schlenk", "iso_6336_20", "iso_6336_22", "benedict_kelley", "xu", "doleschel"
    ] = Field("schlenk", description="formula of the coefficient, as docs/explanation/friction.md has it")
    coefficient: float | None = Field(None, ge=0, le=1, description="of the model constant")
    lubricant_factor: float | None = Field(
        None, ge=0.01, le=2, description="X_L of schlenk, iso_6336_20 and iso_6336_22; null: that of the oil"
    )
    constants: DoleschelConstants | None = Field(None, description="of the model doleschel")
    effect: Literal["loss_only", "excitation"] = Field(
        "loss_only", description="whether friction also disturbs the motion of the machine"
    )

    @model_validator(mode="after")
    def _complete(self) -> "FrictionSection":
        """Refuse keys that the model lacks or does not use."""
        for key, models in (
            ("coefficient", ("constant",)),
            ("constants", ("doleschel",)),
            ("lubricant_factor", GEAR_TESTS),
        ):
            value, is_required = getattr(self, key), self.model in models
            if is_required and value is None and key != "lubricant_factor":
                refuse(key, None, f"given for the model {self.model}")
            if not is_required and value is not None:
                refuse(key, value, f"left out for the model {self.model}")
        return self


class BulkSection(Section):
    """Temperature of the teeth: given, from the heat that bodies give off, or a rule of cylindrical gears."""

    source: Literal["given", "cooling", "iso_6336_20"] = Field(
        description="given: temperature_c; cooling: from the heat that the bodies give off; iso_6336_20: the "
        "rule of cylindrical gears"
    )
    temperature_c: float | None = Field(
        None, ge=-60, le=600, description="of both gears where source is given"
    )
    pinion_w_per_k: float | None = Field(
        None, ge=1e-6, le=1e6, description="heat that a pinion gives off a kelvin above the oil, for cooling"
    )
    face_gear_w_per_k: float | None = Field(
        None, ge=1e-6, le=1e6, description="heat that a face gear gives off a kelvin above the oil"
    )

    @model_validator(mode="after")
    def _complete(self) -> "BulkSection":
        """Refuse keys that the source of the bulk temperature lacks or does not use."""
        required_keys = {"given": ("temperature_c",), "cooling": ("pinion_w_per_k", "face_gear_w_per_k")}
        for source in required_keys:
            for key in required_keys[source]:
                value = getattr(self, key)
                if self.source == source and value is None:
                    refuse(key, None, f"given where source is {source}")
                if self.source != source and value is not None:
                    refuse(key, value, f"left out where source is {self.source}")
        return self


class SteelSection(Section):
    """Thermal properties of the flanks; by default those of ISO/TR 15144-1."""

    conductivity_w_per_m_k: float = Field(45.0, ge=0.01, le=1000, description="thermal conductivity")
    density_kg_per_m3: float = Field(7800.0, ge=100, le=30000, description="density")
    heat_capacity_j_per_kg_k: float = Field(440.0, ge=1, le=10000, description="specific heat capacity")


class Scuffing(Section):
    """Limits that the contact temperature is compared with."""

    temperature_c: float | None = Field(
        None, ge=1, le=1000, description="contact temperature allowed; null: of the oil, or of fzg_stage"
    )
    fzg_stage: float | None = Field(
        None, ge=1, le=14, description="failure load stage A/8.3/90; null: of the oil"
    )
    structure_factor: float = Field(
        1.0,
        ge=0.4,
        le=1.5,
        description="X_W of the steel: 1 case carburised, 0.45 austenitic, 1.25 phosphated",
    )


class LubricationSection(Section):
    """Sliding, loss, heat, film, scuffing and micropitting of the meshes."""

    oil: OilCard = Field(description="name of an oil of the package, a yaml file, or the card itself")
    supply_temperature_c: float = Field(ge=-60, le=400, description="of the oil as it reaches the mesh")
    supply: Literal["jet", "dip", "submerged"] = Field(
        "jet", description="how the oil reaches the mesh, for the rule of iso_6336_20"
    )
    pinion: Roughness = Field(description="roughness of the pinion's flanks after running in")
    face_gear: Roughness = Field(description="roughness of the face gear's flanks after running in")
    friction: FrictionSection = FrictionSection()
    bulk: BulkSection
    steel: SteelSection = SteelSection()
    scuffing: Scuffing = Scuffing()
    allowed_film_ratio: float | None = Field(
        None,
        ge=1e-3,
        le=10,
        description="specific film of ISO/TS 6336-22 that a test of the oil allows; null: not judged",
    )
    map_speeds_rpm: tuple[Annotated[float, Field(ge=1e-3, le=1e6)], ...] = Field(
        (),
        max_length=100,
        description="of the efficiency map; none: 12 from a tenth of dynamics.speed_rpm to 1.25 times it",
    )

    @field_validator("oil", mode="before")
    @classmethod
    def _read(cls, oil: Any) -> Any:
        """Read the card of an oil by its name."""
        return read_card(OilCard, oil, OIL_CARDS)

    @field_validator("map_speeds_rpm")
    @classmethod
    def _check_map_speeds(cls, speeds: tuple[float, ...]) -> tuple[float, ...]:
        """Refuse speeds of the map that do not rise."""
        if list(speeds) != sorted(set(speeds)):
            refuse("", list(speeds), "rising speeds")
        return speeds

    @model_validator(mode="after")
    def _below_the_flash_point(self) -> "LubricationSection":
        """Refuse temperatures at or above the oil's flash point."""
        requirement = f"below the oil's flash point, {self.oil.flash_point_c:g}"
        if self.supply_temperature_c >= self.oil.flash_point_c:
            refuse("supply_temperature_c", self.supply_temperature_c, requirement)
        bulk = self.bulk.temperature_c
        if bulk is not None and bulk >= self.oil.flash_point_c:
            refuse("bulk.temperature_c", bulk, requirement)
        return self
