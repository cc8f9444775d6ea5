"""The request of the friction chain in SI units: oil, models, limits, and the stored contact of a pair."""

from collections.abc import Callable

import pandas as pd

from facegear.arrays import Arrays, Integers
from facegear.build.tooth_pair import ToothPair, materials, pair_design
from facegear.contact.hertz import contact_modulus
from facegear.contact.pattern import pressure_of_flanks
from facegear.lubrication import friction
from facegear.lubrication.contact_points import LoadedContact, contact_points, loaded_contacts, stored_lines
from facegear.lubrication.loss import hat_slip
from facegear.lubrication.oil import FixedCoefficient, Oil, PolyolEster, PowerOfViscosity
from facegear.lubrication.request import BorrowedBulk, Cooling, FlankMaterial, GivenBulk, Limits, Lubrication
from facegear.schema.cards import EsterLaw, FixedLaw, OilCard, PowerLaw
from facegear.schema.lubrication import RQ_PER_RA, SUPPLY_FACTORS, FrictionSection, LubricationSection
from facegear.teeth.design import PairDesign
from facegear.teeth.placement import distinct_pairs


def oil_of(card: OilCard) -> Oil:
    """Convert an oil card to SI units.

    Parameters
    ----------
    card : OilCard
        The validated card.

    Returns
    -------
    Oil
        The oil; temperatures in C, kinematic viscosities in m2/s, all else in SI units.
    """
    return Oil(
        name=card.name,
        temperatures=card.temperatures_c,
        viscosities=(1e-6 * card.viscosities_mm2_s[0], 1e-6 * card.viscosities_mm2_s[1]),
        density=card.density_15_c_kg_m3,
        pressure_coefficient=_law(card.pressure_coefficient),
        conductivity=card.conductivity.w_per_m_k,
        conductivity_at=card.conductivity.at_c,
        conductivity_slope=card.conductivity.falls_per_k,
        flash_point=card.flash_point_c,
        lubricant_factor=card.lubricant_factor,
    )


def _law(section: PowerLaw | EsterLaw | FixedLaw) -> PowerOfViscosity | PolyolEster | FixedCoefficient:
    """Return the pressure-viscosity law of an oil from its section; a fixed coefficient in 1/Pa."""
    if isinstance(section, PowerLaw):
        return PowerOfViscosity(section.scale, section.exponent)
    return FixedCoefficient(1e-9 * section.per_gpa) if isinstance(section, FixedLaw) else PolyolEster()


def contacts_of(
    ltca: pd.DataFrame, pressure: Arrays, section: ToothPair
) -> tuple[list[tuple[LoadedContact, ...]], Integers]:
    """Return the loaded contacts of the flanks of a pair, with pressure, sliding and radii at their points.

    Parameters
    ----------
    ltca : pd.DataFrame
        Table `ltca` of stage contact; columns position (pitches) and unloaded_ste_um are taken.
    pressure : Arrays
        Arrays `pressure` of stage contact.
    section : ToothPair
        Section `tooth_pair` of the config.

    Returns
    -------
    list of tuple of LoadedContact
        For each contact, that of the upper gear's drive flank first, one for each torque of the analysis,
        rising.
    (2, 2) array of int
        Number of the contact of each gear (upper, lower) and flank (drive, back).

    Raises
    ------
    ConfigError
        For a section without bodies.
    """
    arrays, numbers = pressure_of_flanks(pressure)
    unloaded_error = dict(zip(ltca["position"], 1e-6 * ltca["unloaded_ste_um"], strict=True))
    contacts: list[tuple[LoadedContact, ...]] = []
    for contact_arrays, design in zip(arrays, designs_of_contacts(section, len(arrays)), strict=True):
        if contacts:
            unloaded_error = dict(
                zip(contact_arrays["contact_position"], contact_arrays["unloaded_m"], strict=True)
            )
        lines = stored_lines(design, contact_arrays, unloaded_error)
        contact_places = contact_points(design, contact_arrays, lines, contact_modulus(materials(section)))
        contacts.append(loaded_contacts(contact_places, hat_slip(design, contact_arrays)))
    return contacts, numbers


def designs_of_contacts(section: ToothPair, count: int) -> list[PairDesign]:
    """Return the pairs whose drive flanks the stored contacts belong to.

    Parameters
    ----------
    section : ToothPair
        Section `tooth_pair` of the config.
    count : int
        Number of stored contacts.

    Returns
    -------
    list of PairDesign
        As `distinct_pairs` orders them, that of the upper gear's drive flank first.
    """
    return distinct_pairs(pair_design(section))[0][:count]


def lubrication_of(section: LubricationSection, teeth: ToothPair) -> Lubrication:
    """Build the lubrication of a pair's flanks in SI units, with contact modulus and pitch radius of the
    pair.

    Parameters
    ----------
    section : LubricationSection
        Section `lubrication` of the config.
    teeth : ToothPair
        Section `tooth_pair` of the config.

    Returns
    -------
    Lubrication
        Oil, roughness, friction and bulk temperature in SI units.
    """
    return lubrication_request(
        section, contact_modulus(materials(teeth)), pair_design(teeth).pinion_pitch_radius
    )


def lubrication_request(section: LubricationSection, modulus: float, pitch_radius: float) -> Lubrication:
    """Return the lubrication of flanks in SI units, given the two numbers of the pair that it needs.

    Roughness Rq is RQ_PER_RA times Ra where the config gives no Rq.

    Parameters
    ----------
    section : LubricationSection
        Section `lubrication` of the config.
    modulus : float
        Contact modulus E* of the pair, Pa: 1/E* is the sum of (1 - nu^2)/E of both. The result has 2 E*.
    pitch_radius : float
        Pitch radius of the pinion, m.

    Returns
    -------
    Lubrication
        Oil, roughness Ra and Rq (m) of pinion and gear, friction model, source of the bulk temperature
        (C).
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
        Allowed contact temperature (C) with its source, FZG stage, factors and film ratio. The section
        goes before the oil card; None where neither gives a limit.
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
    """Return in words where the allowed contact temperature comes from: key, oil card, FZG stage, or not
    given.
    """
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
        Speeds, rpm: those of the section, else 12 evenly from 0.1 to 1.25 times the nominal speed.
    """
    return section.map_speeds_rpm or tuple(nominal_rpm * (0.1 + 1.15 * step / 11) for step in range(12))


def _bulk(section: LubricationSection) -> GivenBulk | Cooling | BorrowedBulk:
    """Return where the bulk temperature comes from: given (C), cooling of both bodies (W/K), or a supply
    factor.

    The factor of the way of supply stands in where the section gives neither a temperature nor cooling.
    """
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
    """Return the model of the friction coefficient from its section.

    A given coefficient goes before given constants of Doleschel's model, and these before the named
    model. `oil_factor` is the lubricant factor X_L of the oil card, for models that take one; the
    section's goes before.
    """
    if section.coefficient is not None:
        return friction.Constant(section.coefficient)
    if section.constants is not None:
        return friction.Doleschel(**section.constants.model_dump())
    if section.model in MODELS:
        return MODELS[section.model](section.lubricant_factor or oil_factor)
    return friction.Xu() if section.model == "xu" else friction.BenedictKelley()
