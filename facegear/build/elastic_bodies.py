"""The bodies of face gears that bend, from the config: their sections in SI units, and what these must be."""

from collections.abc import Hashable, Mapping
from dataclasses import replace
from math import radians, tan
from typing import Any, NoReturn

import numpy as np

from facegear.arrays import Array
from facegear.build.teeth_on_body import ON_LINE, TeethOnBody, require_teeth_on_rim, teeth_on_body
from facegear.build.tooth_pair import ToothPair, pair, pair_design
from facegear.errors import ConfigError, InvalidInput
from facegear.parts import section as shapes
from facegear.parts import wheel
from facegear.parts.wheel import Patch, require_meshable
from facegear.schema.gear_body import BodySection
from facegear.schema.transmission import Transmission
from facegear.teeth.design import PairDesign
from facegear.teeth.flank_shapes import Flanks, GearModifications
from facegear.teeth.placement import pair_at
from facegear.teeth.section_outline import tooth_fill

THINNEST = "thinnest wall of the section"
"""Name of the quantity by which `facegear.parts` refuses a thin wall."""
KEYS = {
    "outer radius of the hub": "hub.outer_radius_mm",
    "bore radius of the hub": "hub.bore_radius_mm",
    "inner radius of the rim": "rim.inner_radius_mm",
    "back of the hub": "hub.back_mm",
    "back of the rim": "rim.back_mm",
    "offset of the web": "web.offset_mm",
    "corners of the section": "corners_mm",
    THINNEST: "corners_mm",
}
"""Keys of the section by the words in which its shape is refused."""
MASS_ROUNDING = 1e-6
"""Largest part of the mass of a section by which the mass of the config may lie below it, from rounding."""


def body_of(section: Transmission, side: str) -> BodySection | None:
    """Return section `body` of one face gear: its own where it has one, else that of all face gears.

    Parameters
    ----------
    section : Transmission
        Section `transmission` of the config.
    side : str
        Which face gear: `lower` or `upper`.

    Returns
    -------
    BodySection or None
        Dimensions of hub, web and rim as the config gives them; None for a rigid gear.
    """
    single_gear = section.single_gears.get(side)
    return (single_gear.body if single_gear is not None else None) or section.face_gear.body


def elastic_gears(section: Transmission) -> dict[str, BodySection]:
    """Return the sections `body` of all face gears that bend; rigid gears are left out.

    Parameters
    ----------
    section : Transmission
        Section `transmission` of the config.

    Returns
    -------
    dict[str, BodySection]
        Section `body` by side, `lower` or `upper`; empty where all gears are rigid.
    """
    bodies = {side: body_of(section, side) for side in section.face_gears}
    return {side: body for side, body in bodies.items() if body is not None}


def any_elastic(transmission: Mapping[str, Any] | None) -> bool:
    """Whether any face gear bends, told from plain values.

    Parameters
    ----------
    transmission : Mapping[str, Any] or None
        Plain values of section `transmission`; None without it.

    Returns
    -------
    bool
        True if one of the gears has a body that bends.
    """
    if transmission is None:
        return False
    parts = (transmission["face_gear"], *transmission["single_gears"].values())
    return any(part.get("body") is not None for part in parts)


def contact_patch(section: BodySection, teeth: ToothPair, side: str = "upper") -> Patch:
    """Return the patch of the rim over which the force of one mesh is spread.

    The patch lies at the height of the pitch plane. It is `contact_width_pitches` tooth pitches wide.

    Parameters
    ----------
    section : BodySection
        Section `body` of a face gear.
    teeth : ToothPair
        Section `tooth_pair` of the config, with bodies.
    side : str
        Which face gear: `lower` or `upper`.

    Returns
    -------
    Patch
        Height over height 0 of the section (m), and half its width round the axis (rad).
    """
    pitch = 2.0 * np.pi / teeth.face_gear_teeth
    return Patch(teeth_on_body(teeth, side).pitch_height, 0.5 * section.contact_width_pitches * pitch)


def body_shape(section: BodySection, teeth: ToothPair, side: str = "upper") -> shapes.Section:
    """Return the cross-section of a body in SI units.

    The material is the section's own, else that of the pair's face gear. Teeth are a layer on the rim.
    With `teeth: fitted` its density and taper are those of the real teeth, but not yet its stiffness.

    Parameters
    ----------
    section : BodySection
        Section `body` of a face gear.
    teeth : ToothPair
        Section `tooth_pair` of the config, with bodies.
    side : str
        Which face gear: `lower` or `upper`.

    Returns
    -------
    shapes.Section
        Corners as distance from the axis and height (m), held edges, radii of the teeth, material and
        tooth layer; no layer where `body.teeth` leaves teeth out.

    Raises
    ------
    InvalidInput
        For a cross-section that cannot exist.
    """
    heights = teeth_on_body(teeth, side)
    corners, held_edges = _polygon(section, heights)
    material = pair(teeth).material("face_gear")
    if (material_section := section.material) is not None:
        material = type(material)(1e9 * material_section.young_modulus_gpa, material_section.poisson_ratio)
    layer = heights.layer if section.teeth else None
    if layer is not None and section.teeth == "fitted":
        fill_factor, centre = tooth_fill(pair_at(pair_design(teeth), side, "drive"))
        layer = replace(layer, density=fill_factor, taper=6.0 * (0.5 - centre))
    ends = heights.inner_radius, heights.outer_radius
    return shapes.Section(corners, held_edges, ends, material, section.density_kg_per_m3, layer)


def fitted_shape(section: BodySection, teeth: ToothPair, side: str = "upper") -> shapes.Section:
    """Return the cross-section of a body, as `body_shape`, with its teeth as stiff as `body.teeth` says.

    For `fitted` the hoop and shear stiffness of the layer are fitted to finite elements of the teeth,
    which takes time. Else the result is that of `body_shape`.

    Parameters
    ----------
    section : BodySection
        Section `body` of a face gear.
    teeth : ToothPair
        Section `tooth_pair` of the config, with bodies.
    side : str
        Which face gear: `lower` or `upper`.

    Returns
    -------
    shapes.Section
        Cross-section in SI units, for `facegear.parts.gear_body`.

    Raises
    ------
    NotConverged
        If the stiffness of the teeth is not found.
    """
    shape = body_shape(section, teeth, side)
    if section.teeth != "fitted":
        return shape
    from facegear.parts.tooth_layer import fitted_teeth  # loads finite elements

    return fitted_teeth(shape, pair_at(pair_design(teeth), side, "drive"))


def body_key(section: BodySection, teeth: ToothPair, side: str) -> Hashable:
    """Return a key of everything on which the solved body of a face gear depends.

    Parameters
    ----------
    section : BodySection
        Section `body` of a face gear.
    teeth : ToothPair
        Section `tooth_pair` of the config, with bodies.
    side : str
        Which face gear: `lower` or `upper`.

    Returns
    -------
    Hashable
        Equal for gears that share one solution.
    """
    shape, patch = body_shape(section, teeth, side), contact_patch(section, teeth, side)
    mounting = (shape.teeth, shape.material, shape.layer, patch, teeth.face_gear_teeth)
    fitted_teeth = None
    if section.teeth == "fitted":
        fitted_teeth = _nominal_teeth(pair_at(pair_design(teeth), side, "drive"))
    return (section, shape.corners.tobytes(), mounting, fitted_teeth)


def _nominal_teeth(design: PairDesign) -> Hashable:
    """Return a key of everything on which the stiffness of a face gear's fitted teeth depends; no
    deviations.
    """
    gear = replace(design.face_gear, modifications=GearModifications(), flanks=Flanks())
    pinion = design.pinion.teeth, design.pinion.profile_shift, design.middle
    axes = design.shaft_angle, design.offset, design.helix_angle, design.taper_angle
    return (design.module, design.pressure_angles, axes, pinion, gear, design.shaper)


def _polygon(section: BodySection, heights: TeethOnBody) -> tuple[Array, tuple[bool, ...]]:
    """Return the corners (n, 2) of a body's section and whether the edge after each corner is held (n,).

    A corner is distance from the axis and height, m; corners run anticlockwise. They are those of the
    config, else those of a wheel of hub, web and rim, or of a plain ring where hub or web is not given.
    Held edges are those that the config names, else the bore. `heights`: those of the teeth, which stand on
    the rim's front.
    """
    if section.corners_mm:
        config_corners = 1e-3 * np.array(section.corners_mm)
        shapes.require_simple(config_corners)
        corners = shapes.anticlockwise(config_corners)
        if section.held_edges:
            is_held = np.isin(np.arange(1, len(config_corners) + 1), section.held_edges)
            return corners, tuple(
                (is_held if np.array_equal(corners, config_corners) else is_held[::-1]).tolist()
            )
        return corners, bore(corners)
    rim = section.rim
    assert rim is not None
    rim_inner = heights.inner_radius if rim.inner_radius_mm is None else 1e-3 * rim.inner_radius_mm
    rim_outer = heights.outer_radius if rim.outer_radius_mm is None else 1e-3 * rim.outer_radius_mm
    if rim_inner >= rim_outer:
        raise InvalidInput("inner radius of the rim", 1e3 * rim_inner, f"below {1e3 * rim_outer:g} mm")
    whole = wheel.Rim(rim_inner, rim_outer, 1e-3 * rim.back_mm, heights.root_at(rim_inner), heights.slope)
    if section.hub is None or section.web is None:
        corners = shapes.rectangle(rim_inner, rim_outer, whole.back, whole.front)
        corners[2, 1] = whole.outer_front
    else:
        hub, web = section.hub, section.web
        corners = wheel.wheel(
            wheel.Hub(*(1e-3 * getattr(hub, key) for key in type(hub).model_fields)),
            wheel.Web(
                1e-3 * web.hub_thickness_mm,
                1e-3 * web.rim_thickness_mm,
                1e-3 * web.offset_mm,
                tan(radians(web.cone_angle_deg)),
            ),
            whole,
        )
    return corners, bore(corners)


def bore(corners: Array) -> tuple[bool, ...]:
    """Find the edges of the bore, with both ends at the smallest distance from the axis: held by default.

    Parameters
    ----------
    corners : (corners, 2) array
        Distance from the axis and height of each corner, m.

    Returns
    -------
    tuple[bool, ...]
        For the edge from each corner to the next, whether it belongs to the bore.
    """
    inside = corners[:, 0] < corners[:, 0].min() + ON_LINE
    return tuple((inside & np.roll(inside, -1)).tolist())


def check_bodies(teeth: ToothPair, section: Transmission) -> None:
    """Require that elastic bodies of face gears can exist and fit the teeth, masses and inertias.

    Parameters
    ----------
    teeth : ToothPair
        Section `tooth_pair` of the config.
    section : Transmission
        Section `transmission` of the config.

    Raises
    ------
    ConfigError
        For the first body that does not, and for a hub's tilt where no body bends.
    """
    _refuse_hubs_alone(section)
    for side in section.face_gears:
        if (body := body_of(section, side)) is None:
            continue
        single_gear = section.single_gears.get(side)
        alone = single_gear is not None and single_gear.body is not None
        key = f"transmission.single_gears.{side}" if alone else "transmission.face_gear"
        _check_body(key, side, body, teeth, section)


def _refuse_hubs_alone(section: Transmission) -> None:
    """Raise ConfigError where `hub_tilt` is given for a face gear without a body that bends."""
    single = section.single_gears.items()
    rigid = [
        f"single_gears.{side}"
        for side, single_gear in single
        if single_gear.hub_tilt and not body_of(section, side)
    ]
    if section.face_gear.hub_tilt is not None and not elastic_gears(section):
        rigid.append("face_gear")
    if rigid:
        requirement = "left out where the gear has no body that bends, whose tilt is given by tilt"
        raise ConfigError(f"transmission.{rigid[0]}.hub_tilt", "given", requirement)


def _check_hub(side: str, shape: shapes.Section, teeth: ToothPair, section: Transmission) -> None:
    """Refuse a tilting hub with less inertia about a diameter than the section of its gear has.

    `hub_tilt` gives the inertia of the whole gear about a diameter through its tilt centre. `shape` is
    the section of the body on the given side.
    """
    single_gear = section.single_gears.get(side)
    alone = single_gear is not None and single_gear.hub_tilt is not None
    tilt = (
        single_gear.hub_tilt
        if single_gear is not None and single_gear.hub_tilt is not None
        else section.face_gear.hub_tilt
    )
    if tilt is None:
        return
    centre = teeth_on_body(teeth, side).pitch_height - 1e-3 * tilt.centre_below_pitch_plane_mm
    min_inertia = shapes.inertia_about(shape, centre)
    if tilt.inertia_kg_m2 < min_inertia * (1.0 - MASS_ROUNDING):
        owner_key = f"transmission.single_gears.{side}" if alone else "transmission.face_gear"
        requirement = f"at least {min_inertia:.6g} kg m2, which the section of the body has about that point"
        raise ConfigError(f"{owner_key}.hub_tilt.inertia_kg_m2", tilt.inertia_kg_m2, requirement)


def _check_body(key: str, side: str, body: BodySection, teeth: ToothPair, section: Transmission) -> None:
    """Raise ConfigError for the elastic body of one face gear that does not fit teeth or machine.

    Refused are printed kinematics, a pair without bodies, a tilt beside the body, a section that does not
    carry the teeth or cannot be meshed, and a mass or inertia below that of the section. `key` is the
    section that holds the body.
    """
    if section.mesh_kinematics == "printed":
        raise ConfigError(f"{key}.body", "a section", "rigid where mesh_kinematics is printed")
    if teeth.face_gear is None:
        raise ConfigError("tooth_pair.face_gear", None, f"given, as required by {key}.body")
    single_gear = section.single_gears.get(side)
    if section.face_gear.tilt is not None or (single_gear is not None and single_gear.tilt is not None):
        raise ConfigError(
            f"{key}.tilt",
            "given",
            "left out beside a body, whose web tilts the rim; hub_tilt is that of its bearings",
        )
    try:
        shape = body_shape(body, teeth, side)
        require_teeth_on_rim(shape, teeth_on_body(teeth, side))
        require_meshable(shape.corners)
    except InvalidInput as error:
        _refuse_shape(f"{key}.body", body, error)
    mass, polar, *_ = shapes.section_properties(shape)
    for name, min_value, unit in (("mass_kg", mass, "kg"), ("inertia_kg_m2", polar, "kg m2")):
        single = getattr(single_gear, name) if single_gear is not None else None
        value = getattr(section.face_gear, name) if single is None else single
        if value < min_value * (1.0 - MASS_ROUNDING):
            owner_key = key if single is None else f"transmission.single_gears.{side}"
            requirement = (
                f"at least {min_value:.6g} {unit}, which the section of the body has; more is the hub's"
            )
            raise ConfigError(f"{owner_key}.{name}", value, requirement)
    _check_hub(side, shape, teeth, section)


def _refuse_shape(key: str, body: BodySection, error: InvalidInput) -> NoReturn:
    """Raise ConfigError for an InvalidInput about a body's section, under the key that its quantity has.

    `key` is the section `body`, such as `transmission.face_gear.body`.
    """
    name, value, requirement = KEYS[error.quantity], error.value, error.requirement.replace("`", "")
    if error.quantity == THINNEST:
        name, value = _thinnest_key(body)
        requirement = f"such that the thinnest wall of the section, now {error.value} mm, is {requirement}"
    elif body.corners_mm:
        name = "corners_mm"
    raise ConfigError(f"{key}.{name}", value, requirement) from None


def _thinnest_key(body: BodySection) -> tuple[str, object]:
    """Return key and value, inside section `body`, of the dimension that makes the thinnest wall."""
    if body.web is not None:
        keys = ("hub_thickness_mm", "rim_thickness_mm")
        value, thinner = min((getattr(body.web, key), key) for key in keys)
        return f"web.{thinner}", value
    return ("corners_mm", list(body.corners_mm)) if body.corners_mm else ("rim", "given")
