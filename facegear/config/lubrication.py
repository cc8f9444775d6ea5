"""Config section `lubrication`: the oil, how it is supplied, roughness, friction and what the flanks bear."""

from collections.abc import Callable
from typing import Annotated, Any, Literal

from pydantic import Field, field_validator, model_validator

from facegear.config.base import Section, refuse
from facegear.config.cards import read_card
from facegear.config.oil_card import OIL_CARDS, OilCard, oil_of
from facegear.lubrication import friction
from facegear.lubrication.request import BorrowedBulk, Cooling, FlankMaterial, GivenBulk, Limits, Lubrication

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
    """How the coefficient of friction follows from load, speed, oil and roughness."""

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
        return read_card(OilCard, oil, OIL_CARDS)

    @field_validator("map_speeds_rpm")
    @classmethod
    def _check_map_speeds(cls, speeds: tuple[float, ...]) -> tuple[float, ...]:
        if list(speeds) != sorted(set(speeds)):
            refuse("", list(speeds), "rising speeds")
        return speeds

    @model_validator(mode="after")
    def _below_the_flash_point(self) -> "LubricationSection":
        requirement = f"below the oil's flash point, {self.oil.flash_point_c:g}"
        if self.supply_temperature_c >= self.oil.flash_point_c:
            refuse("supply_temperature_c", self.supply_temperature_c, requirement)
        bulk = self.bulk.temperature_c
        if bulk is not None and bulk >= self.oil.flash_point_c:
            refuse("bulk.temperature_c", bulk, requirement)
        return self


def lubrication_request(section: LubricationSection, modulus: float, pitch_radius: float) -> Lubrication:
    """Return how the flanks are lubricated, in SI units.

    Parameters
    ----------
    section : LubricationSection
        Section `lubrication` of the config.
    modulus : float
        Contact modulus E* of the pair, Pa.
    pitch_radius : float
        Pitch radius of the pinion, m.

    Returns
    -------
    Lubrication
        Oil, roughness (m), friction and bulk temperature (C).
    """
    oil, steel = oil_of(section.oil), section.steel
    rough = section.pinion, section.face_gear
    thermal_properties = FlankMaterial(
        steel.conductivity_w_per_m_k, steel.density_kg_per_m3, steel.heat_capacity_j_per_kg_k
    )
    ra = [1e-6 * surface.ra_um for surface in rough]
    rq = [1e-6 * (surface.rq_um or RQ_PER_RA * surface.ra_um) for surface in rough]
    return Lubrication(
        oil=oil,
        oil_temperature=section.supply_temperature_c,
        friction=_model(section.friction, oil.lubricant_factor),
        ra=(ra[0], ra[1]),
        rq=(rq[0], rq[1]),
        bulk=_bulk(section),
        flanks=(thermal_properties, thermal_properties),
        reduced_modulus=2 * modulus,
        pitch_radius=pitch_radius,
    )


def limits_of(section: LubricationSection) -> Limits:
    """Return the limits that temperatures and films are compared with.

    Parameters
    ----------
    section : LubricationSection
        Section `lubrication` of the config.

    Returns
    -------
    Limits
        The limits; None where neither section nor oil gives one.
    """
    scuffing = section.scuffing
    return Limits(
        contact_temperature=scuffing.temperature_c or section.oil.scuffing_temperature_c,
        contact_temperature_source=_source_of_contact_temperature(section),
        fzg_stage=scuffing.fzg_stage or section.oil.fzg_stage,
        structure_factor=scuffing.structure_factor,
        lubricant_factor=section.friction.lubricant_factor or section.oil.lubricant_factor,
        film_ratio=section.allowed_film_ratio,
    )


def _source_of_contact_temperature(section: LubricationSection) -> str:
    """Where the allowed contact temperature is from, in words."""
    if section.scuffing.temperature_c:
        return "lubrication.scuffing.temperature_c"
    if section.oil.scuffing_temperature_c:
        return section.oil.scuffing_temperature_source or f"oil card: {section.oil.source}"
    stage = section.scuffing.fzg_stage or section.oil.fzg_stage
    return "not given" if stage is None else f"FZG load stage {stage:g}"


def map_speeds(section: LubricationSection, nominal_rpm: float) -> tuple[float, ...]:
    """Return the pinion speeds of the efficiency map.

    Parameters
    ----------
    section : LubricationSection
        Section `lubrication` of the config.
    nominal_rpm : float
        Nominal pinion speed, rpm.

    Returns
    -------
    tuple[float, ...]
        Speeds, rpm; without any in the section 12 from a tenth of the nominal speed to 1.25 times it.
    """
    return section.map_speeds_rpm or tuple(nominal_rpm * (0.1 + 1.15 * step / 11) for step in range(12))


def _bulk(section: LubricationSection) -> GivenBulk | Cooling | BorrowedBulk:
    bulk = section.bulk
    if bulk.temperature_c is not None:
        return GivenBulk(bulk.temperature_c)
    if bulk.pinion_w_per_k is not None and bulk.face_gear_w_per_k is not None:
        return Cooling(bulk.pinion_w_per_k, bulk.face_gear_w_per_k)
    return BorrowedBulk(SUPPLY_FACTORS[section.supply])


MODELS: dict[str, Callable[[float], friction.FrictionModel]] = {
    "schlenk": friction.Schlenk,
    "iso_6336_20": friction.Iso633620,
    "iso_6336_22": friction.Iso633622,
}
"""Models with the lubricant factor X_L by their names, those of GEAR_TESTS."""


def _model(section: FrictionSection, oil_factor: float) -> friction.FrictionModel:
    if section.coefficient is not None:
        return friction.Constant(section.coefficient)
    if section.constants is not None:
        return friction.Doleschel(**section.constants.model_dump())
    if section.model in MODELS:
        return MODELS[section.model](section.lubricant_factor or oil_factor)
    return friction.Xu() if section.model == "xu" else friction.BenedictKelley()
