"""The bodies of face gears that bend, from the config: their sections in SI units, and what these must be."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import radians, tan
from typing import Any, NoReturn

import numpy as np

from facegear.arrays import Array
from facegear.config.gear_body import BodySection
from facegear.config.tooth_pair import ToothPair, pair, pair_design
from facegear.config.transmission import Transmission
from facegear.errors import ConfigError, InvalidInput
from facegear.gear_body import section as shapes
from facegear.gear_body.mesh_limits import require_meshable
from facegear.gear_body.patch import Patch
from facegear.mesh.tooth_volume import tooth_fill

THINNEST = "thinnest wall of the section"
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
ROUNDED = 1e-6
"""Part of the mass of a section by which that of the config may be rounded below it."""
ON_LINE = 1e-9


def body_of(section: Transmission, side: str) -> BodySection | None:
    """The body of the lower or upper gear, None for a rigid one."""
    own = section.single_gears.get(side)
    return (own.body if own is not None else None) or section.face_gear.body


def elastic_gears(section: Transmission) -> dict[str, BodySection]:
    """The bodies of the gears that bend, by side."""
    bodies = {side: body_of(section, side) for side in section.face_gears}
    return {side: body for side, body in bodies.items() if body is not None}


def any_elastic(transmission: Mapping[str, Any] | None) -> bool:
    """Whether a gear bends, by the plain values of section transmission."""
    if transmission is None:
        return False
    parts = (transmission["face_gear"], *transmission["single_gears"].values())
    return any(part.get("body") is not None for part in parts)


def pitch_height(teeth: ToothPair) -> float:
    """Height (m) of the pitch plane over the plane on which the contact analysis clamps the teeth."""
    assert teeth.face_gear is not None and teeth.shaper is not None
    return 1e-3 * (teeth.face_gear.rim_thickness_mm + teeth.module_mm * teeth.shaper.addendum_modules)


def contact_patch(section: BodySection, teeth: ToothPair) -> Patch:
    """Where a mesh presses on the body."""
    pitch = 2.0 * np.pi / teeth.face_gear_teeth
    return Patch(pitch_height(teeth), 0.5 * section.contact_width_pitches * pitch)


def body_shape(section: BodySection, teeth: ToothPair) -> shapes.Section:
    """The section in SI units. Raises InvalidInput for one that cannot be."""
    gear = teeth.face_gear
    assert gear is not None and teeth.shaper is not None
    inner, outer = 1e-3 * gear.inner_radius_mm, 1e-3 * gear.outer_radius_mm
    top = 1e-3 * gear.rim_thickness_mm
    corners, held = _polygon(section, inner, outer, top)
    tip = pitch_height(teeth) + 1e-3 * teeth.module_mm * gear.addendum_modules
    material = pair(teeth).material("face_gear")
    if (own := section.material) is not None:
        material = type(material)(1e9 * own.young_modulus_gpa, own.poisson_ratio)
    layer = shapes.Layer(inner, outer, top, tip) if section.teeth else None
    if layer is not None and section.teeth == "fitted":
        filled, centre = tooth_fill(pair_design(teeth))
        layer = replace(layer, density=filled, taper=6.0 * (0.5 - centre))
    return shapes.Section(corners, held, (inner, outer), material, section.density_kg_per_m3, layer)


def fitted_shape(section: BodySection, teeth: ToothPair) -> shapes.Section:
    """The section as `body_shape`, its teeth as stiff as `body.teeth` says. Raises NotConverged."""
    shape = body_shape(section, teeth)
    if section.teeth != "fitted":
        return shape
    from facegear.tooth_layer.fit import fitted_teeth  # loads finite elements

    return fitted_teeth(shape, pair_design(teeth))


def _polygon(section: BodySection, inner: float, outer: float, top: float) -> tuple[Array, tuple[bool, ...]]:
    """Corners in m, anticlockwise, and which edges are held."""
    if section.corners_mm:
        given = 1e-3 * np.array(section.corners_mm)
        shapes.require_simple(given)
        corners = shapes.anticlockwise(given)
        if section.held_edges:
            held = np.isin(np.arange(1, len(given) + 1), section.held_edges)
            return corners, tuple((held if np.array_equal(corners, given) else held[::-1]).tolist())
        return corners, bore(corners)
    rim = section.rim
    assert rim is not None
    rim_inner = inner if rim.inner_radius_mm is None else 1e-3 * rim.inner_radius_mm
    rim_outer = outer if rim.outer_radius_mm is None else 1e-3 * rim.outer_radius_mm
    if rim_inner >= rim_outer:
        raise InvalidInput("inner radius of the rim", 1e3 * rim_inner, f"below {1e3 * rim_outer:g} mm")
    whole = shapes.Rim(rim_inner, rim_outer, 1e-3 * rim.back_mm, top)
    if section.hub is None or section.web is None:
        corners = shapes.rectangle(rim_inner, rim_outer, whole.back, top)
    else:
        hub, web = section.hub, section.web
        corners = shapes.wheel(
            shapes.Hub(*(1e-3 * getattr(hub, key) for key in type(hub).model_fields)),
            shapes.Web(
                1e-3 * web.hub_thickness_mm,
                1e-3 * web.rim_thickness_mm,
                1e-3 * web.offset_mm,
                tan(radians(web.cone_angle_deg)),
            ),
            whole,
        )
    return corners, bore(corners)


def bore(corners: Array) -> tuple[bool, ...]:
    """The edges at the smallest distance from the axis."""
    inside = corners[:, 0] < corners[:, 0].min() + ON_LINE
    return tuple((inside & np.roll(inside, -1)).tolist())


def check_bodies(teeth: ToothPair, section: Transmission) -> None:
    """The bodies of a machine can be and fit its teeth and masses. Raises ConfigError."""
    _refuse_hubs_alone(section)
    for side in section.face_gears:
        if (body := body_of(section, side)) is None:
            continue
        own = section.single_gears.get(side)
        alone = own is not None and own.body is not None
        key = f"transmission.single_gears.{side}" if alone else "transmission.face_gear"
        _check_body(key, side, body, teeth, section)


def _refuse_hubs_alone(section: Transmission) -> None:
    """Raises ConfigError for the tilt of a hub where no web bends."""
    single = section.single_gears.items()
    rigid = [f"single_gears.{side}" for side, own in single if own.hub_tilt and not body_of(section, side)]
    if section.face_gear.hub_tilt is not None and not elastic_gears(section):
        rigid.append("face_gear")
    if rigid:
        allowed = "left out where the gear has no body that bends, whose tilt is given by tilt"
        raise ConfigError(f"transmission.{rigid[0]}.hub_tilt", "given", allowed)


def _check_hub(side: str, shape: shapes.Section, teeth: ToothPair, section: Transmission) -> None:
    """The hub's tilt carries at least the section. Raises ConfigError."""
    own = section.single_gears.get(side)
    alone = own is not None and own.hub_tilt is not None
    tilt = own.hub_tilt if own is not None and own.hub_tilt is not None else section.face_gear.hub_tilt
    if tilt is None:
        return
    centre = pitch_height(teeth) - 1e-3 * tilt.centre_below_pitch_plane_mm
    needed = shapes.inertia_about(shape, centre)
    if tilt.inertia_kg_m2 < needed * (1.0 - ROUNDED):
        where = f"transmission.single_gears.{side}" if alone else "transmission.face_gear"
        allowed = f"at least {needed:.6g} kg m2, which the section of the body has about that point"
        raise ConfigError(f"{where}.hub_tilt.inertia_kg_m2", tilt.inertia_kg_m2, allowed)


def _check_body(key: str, side: str, body: BodySection, teeth: ToothPair, section: Transmission) -> None:
    if section.mesh_kinematics == "printed":
        raise ConfigError(f"{key}.body", "a section", "rigid where mesh_kinematics is printed")
    if teeth.face_gear is None:
        raise ConfigError("tooth_pair.face_gear", None, f"given, as required by {key}.body")
    own = section.single_gears.get(side)
    if section.face_gear.tilt is not None or (own is not None and own.tilt is not None):
        raise ConfigError(
            f"{key}.tilt",
            "given",
            "left out beside a body, whose web tilts the rim; hub_tilt is that of its bearings",
        )
    try:
        shape = body_shape(body, teeth)
        require_teeth_on_rim(shape, 1e-3 * teeth.face_gear.rim_thickness_mm)
        require_meshable(shape.corners)
    except InvalidInput as error:
        _refuse_shape(f"{key}.body", body, error)
    mass, polar, *_ = shapes.section_properties(shape)
    for name, needed, unit in (("mass_kg", mass, "kg"), ("inertia_kg_m2", polar, "kg m2")):
        single = getattr(own, name) if own is not None else None
        value = getattr(section.face_gear, name) if single is None else single
        if value < needed * (1.0 - ROUNDED):
            where = key if single is None else f"transmission.single_gears.{side}"
            allowed = f"at least {needed:.6g} {unit}, which the section of the body has; more is the hub's"
            raise ConfigError(f"{where}.{name}", value, allowed)
    _check_hub(side, shape, teeth, section)


def _refuse_shape(key: str, body: BodySection, error: InvalidInput) -> NoReturn:
    name, value, allowed = KEYS[error.quantity], error.value, error.allowed.replace("`", "")
    if error.quantity == THINNEST:
        name, value = _thinnest_key(body)
        allowed = f"such that the thinnest wall of the section, now {error.value} mm, is {allowed}"
    elif body.corners_mm:
        name = "corners_mm"
    raise ConfigError(f"{key}.{name}", value, allowed) from None


def _thinnest_key(body: BodySection) -> tuple[str, object]:
    """The key, with its value, that a user changes who has drawn a wall too thin."""
    if body.web is not None:
        keys = ("hub_thickness_mm", "rim_thickness_mm")
        value, thinner = min((getattr(body.web, key), key) for key in keys)
        return f"web.{thinner}", value
    return ("corners_mm", list(body.corners_mm)) if body.corners_mm else ("rim", "given")


def require_teeth_on_rim(shape: shapes.Section, top: float) -> None:
    """Raises InvalidInput unless an edge of the section carries all teeth, with their rim solid below it."""
    inner, outer = shape.teeth
    words = f"such that it has an edge at height {1e3 * top:g} mm from {1e3 * inner:g} to {1e3 * outer:g} mm"
    flat = np.abs(shape.edges[:, :, 1] - top).max(axis=1) < ON_LINE
    covers = (shape.edges[:, :, 0].min(axis=1) < inner + ON_LINE) & (
        shape.edges[:, :, 0].max(axis=1) > outer - ON_LINE
    )
    shown: Sequence[float] = (1e3 * shape.corners[:, 0]).round(6).tolist()
    if not (flat & covers).any():
        allowed = f"{words}, on which the teeth stand"
        raise InvalidInput("inner radius of the rim", [min(shown), max(shown)], allowed)
    if crosses_rectangle(shape.edges, inner, outer, 0.0, top):
        raise InvalidInput("corners of the section", "a gap below the teeth", f"{words}, solid to height 0")


def crosses_rectangle(edges: Array, inner: float, outer: float, back: float, front: float) -> bool:
    """Whether an edge runs through the inside of a rectangle."""
    low, high = np.array([inner, back]) + ON_LINE, np.array([outer, front]) - ON_LINE
    first, way = edges[:, 0], edges[:, 1] - edges[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        to_low, to_high = (low - first) / way, (high - first) / way
    still = way == 0.0
    inside = (first > low) & (first < high)
    enter = np.where(still, np.where(inside, 0.0, np.inf), np.minimum(to_low, to_high)).max(axis=1)
    leave = np.where(still, np.where(inside, 1.0, -np.inf), np.maximum(to_low, to_high)).min(axis=1)
    return bool((np.maximum(enter, 0.0) < np.minimum(leave, 1.0)).any())
