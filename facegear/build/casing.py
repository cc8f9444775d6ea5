"""The casing of a machine: its files read and checked, reduced, and set below the bearings."""

import json
from collections.abc import Mapping
from functools import lru_cache
from string import ascii_uppercase
from typing import Any

import numpy as np

from facegear.arrays import Array, Arrays
from facegear.build.machine_layout import stepped_shaft
from facegear.casing.files import content_of, files_of, read_casing
from facegear.casing.mounted import Foot, MountedCasing, mount
from facegear.casing.reduction import Interface, interface_rows, reduce_casing
from facegear.casing.whole import WholeCasing, require_free, require_held, require_mass
from facegear.errors import ConfigError, InvalidInput, plain_reason
from facegear.machine.casing import Casing
from facegear.machine.layout import Layout
from facegear.parts.shafts import SeatedShaft, follow_rings
from facegear.schema.casing import CasingFoot, CasingPlace, CasingSection
from facegear.schema.transmission import PinionPlace, Transmission

KEY = "transmission.casing"
"""Key of the section."""
KEYS = {
    "stiffness of the casing": "stiffness",
    "mass of the casing": "mass",
    "damping of the casing": "damping",
    "nodes of the casing": "nodes",
    "dofs of the casing": "dofs",
    "feet of the casing": "feet",
    "sensor of the casing": "sensors",
}
"""Keys of the section by the words in which a casing is refused."""
SMALL = 500
"""Rows up to which a casing is reduced as soon as a config is read, which takes less than a second."""
NEAR = 1e-3
"""Largest distance, m, from a point to the node that stands for it."""


def seat_names(section: Transmission) -> list[str]:
    """Return the names that seats of a machine may have.

    Parameters
    ----------
    section : Transmission
        Section `transmission` of the config.

    Returns
    -------
    list of str
        Pinions, bearings of pinions with shafts, and gears.
    """
    names = [name for pinion in section.pinions for name in _own_seats(section, pinion)]
    return [*names, *(f"{side} gear" for side in section.face_gears)]


def _own_seats(section: Transmission, pinion: PinionPlace) -> list[str]:
    """Return the names that seats of a pinion may have, in order: its own, and those of its bearings."""
    shaft = section.shaft_of(pinion)
    letters = "" if shaft is None else ascii_uppercase[: len(shaft.bearings)]
    return [pinion.name, *(f"{pinion.name} {letter}" for letter in letters)]


def check_casing(section: Transmission) -> None:
    """Refuse a casing whose files, nodes or seats cannot be used.

    Parameters
    ----------
    section : Transmission
        Section `transmission` of the config.

    Raises
    ------
    ConfigError
        For the first mistake.
    """
    casing = section.casing
    if casing is None:
        return
    if section.mesh_kinematics == "printed":
        raise ConfigError(KEY, "given", "left out where mesh_kinematics is printed")
    known_names = seat_names(section)
    for name in casing.seats:
        if name not in known_names:
            raise ConfigError(f"{KEY}.seats.{name}", name, f"one of {', '.join(known_names)}")
    _refuse_square_hubs(section, casing)
    _refuse_clearance(section, casing)
    try:
        whole = _read(tuple(casing.files.items()), content_of(files_of(casing.files)), casing.units)
        _check_whole(casing, whole)
        if whole.size <= SMALL:
            reduced_casing(casing)
    except OSError as error:
        name = str(error.filename or casing.stiffness)
        key = next((key for key, file in casing.files.items() if file == name), "stiffness")
        condition = f"a file that can be read ({plain_reason(error)})"
        raise ConfigError(f"{KEY}.{key}", name, condition) from None
    except InvalidInput as error:
        raise _config_error(error, casing) from None


def content(section: CasingSection) -> str | None:
    """Return the digest of the files of a casing, for results that are kept.

    Parameters
    ----------
    section : CasingSection
        Section `casing`.

    Returns
    -------
    str or None
        64 hexadecimal digits; None where a file cannot be read.
    """
    try:
        return content_of(files_of(section.files))
    except OSError:
        return None


def reduced_casing(section: CasingSection) -> MountedCasing:
    """Read, reduce and mount a casing; sections that say the same share the result as long as the files stay.

    Parameters
    ----------
    section : CasingSection
        Section `casing`.

    Returns
    -------
    MountedCasing
        SI units, in the axes of the machine.

    Raises
    ------
    ConfigError
        For a casing that cannot be used.
    """
    digest = section.content or content(section) or ""
    return _reduce_once(section.model_copy(update={"content": digest}).model_dump_json())


@lru_cache(maxsize=4)
def _reduce_once(text: str) -> MountedCasing:
    """Return the reduced casing of a section (json), whose `content` is the digest of its files."""
    section = CasingSection.of_config(json.loads(text))
    try:
        whole = _read(tuple(section.files.items()), section.content or "", section.units)
        _check_whole(section, whole)
        seats, feet = _interfaces(section, whole)
        interfaces = [*seats, *(foot.interface for foot in feet)]
        sensors = [(sensor.node, np.array(sensor.direction)) for sensor in section.sensors]
        reduction = reduce_casing(whole, interfaces, section.modes, sensors)
        return mount(
            reduction,
            seats,
            feet,
            [sensor.name for sensor in section.sensors],
            _machine_axes(section),
            section.damping_ratio,
            whole.total_mass,
        )
    except InvalidInput as error:
        raise _config_error(error, section) from None


def machine_casing(section: Transmission, layout: Layout, arrays: Arrays | None) -> Casing | None:
    """Return the casing below the bearings of a machine; None where its seats stand still.

    Parameters
    ----------
    section : Transmission
        Section `transmission` of the config.
    layout : Layout
        Layout of the machine.
    arrays : mapping of arrays or None
        Arrays of stage casing, those of `MountedCasing`; None to reduce the casing here.

    Returns
    -------
    Casing or None
        SI units.
    """
    if section.casing is None:
        return None
    mounted = reduced_casing(section.casing) if arrays is None else MountedCasing.of_arrays(arrays)
    seats: dict[int, tuple[str, ...]] = {}
    shafts: dict[int, SeatedShaft] = {}
    positions: dict[int, Array] = {}
    for body, pinion in enumerate(section.pinions):
        shaft = section.shaft_of(pinion)
        if shaft is None:
            seats[body] = (pinion.name,) if pinion.name in mounted.seats else ()
            continue
        bearings = range(len(shaft.bearings))
        names = tuple(_bearing_seat(pinion.name, number, mounted) for number in bearings)
        if any(names):
            seats[body] = names
            if all(bearing.rolling is None for bearing in shaft.bearings):
                shafts[body] = follow_rings(stepped_shaft(shaft))
            along = [bearing.at_mm - shaft.pinion_mm for bearing in shaft.bearings]
            positions[body] = layout.pinion_middle + 1e-3 * np.array(along)
    for number, gear in enumerate(layout.gears):
        if (name := f"{gear.side.value} gear") in mounted.seats:
            seats[len(layout.pinions) + number] = (name,)
    return Casing(layout, mounted, {body: names for body, names in seats.items() if names}, shafts, positions)


def _bearing_seat(pinion: str, number: int, mounted: MountedCasing) -> str:
    """Return the seat of a bearing of a shaft: its own, else that of the pinion, else empty for the
    ground.
    """
    name = f"{pinion} {ascii_uppercase[number]}"
    return name if name in mounted.seats else pinion if pinion in mounted.seats else ""


def misplaced_seats(section: Transmission, layout: Layout) -> list[str]:
    """List the seats that stand far from what they carry, as where the axes of the file are mistaken.

    Parameters
    ----------
    section : Transmission
        Section `transmission` of the config, with a casing.
    layout : Layout
        Layout of the machine.

    Returns
    -------
    list of str
        One line each, with its key: a pinion's seat behind the gears' axis or less than half as far from
        another pinion's axis, and an upper gear's seat below that of the lower gear.
    """
    casing = section.casing
    assert casing is not None
    digest = casing.content or content_of(files_of(casing.files))
    interfaces, _ = _interfaces(casing, _read(tuple(casing.files.items()), digest, casing.units))
    rotation, origin = _machine_axes(casing)
    seats = {seat.name: rotation @ (seat.position - origin) for seat in interfaces}
    ways = np.stack([np.cos(layout.angles), np.sin(layout.angles), np.zeros(len(layout.angles))], axis=1)
    lines = []
    for number, pinion in enumerate(section.pinions):
        for name in _own_seats(section, pinion):
            if name not in seats:
                continue
            along = ways @ seats[name]
            distances = np.linalg.norm(seats[name] - np.maximum(along, 0.0)[:, None] * ways, axis=1)
            nearest = int(distances.argmin())
            if along[number] > 0.0 and distances[number] <= 2.0 * distances[nearest]:
                continue
            distance = f"{1e3 * distances[number]:.4g} mm from the axis of {pinion.name}"
            beside = "" if nearest == number else f", nearer to that of {section.pinions[nearest].name}"
            lines.append(f"{KEY}.seats.{name}: stands {distance}{beside}; does axes fit the file?")
    lower, upper = (seats.get(f"{side} gear") for side in ("lower", "upper"))
    if lower is not None and upper is not None and upper[2] < lower[2]:
        lines.append(f"{KEY}.seats.upper gear: stands below that of the lower gear; does axes fit the file?")
    return lines


@lru_cache(maxsize=2)
def _read(files: tuple[tuple[str, str | None], ...], digest: str, units: str) -> WholeCasing:
    """Return the casing of files; equal names with equal content (`digest`) share it."""
    return read_casing(dict(files), units)


def _check_whole(section: CasingSection, whole: WholeCasing) -> None:
    """Refuse matrices that are not those of a casing on the feet that the section gives."""
    seats, feet = _interfaces(section, whole)
    interface_rows(whole, [*seats, *(foot.interface for foot in feet)])
    require_mass(whole, section.mass_kg)
    if feet:
        require_free(whole)
    require_held(whole, [(foot.interface.position, foot.stiffness) for foot in feet])
    for sensor in section.sensors:
        if not {1, 2, 3} <= set(whole.rows_of_node.get(sensor.node, {})):
            requirement = "a node with motions along x, y and z in the stiffness"
            raise ConfigError(f"{KEY}.sensors.{sensor.name}.node", sensor.node, requirement)


def _interfaces(section: CasingSection, whole: WholeCasing) -> tuple[list[Interface], list[Foot]]:
    """Return the seats and feet of a casing, SI units."""
    seats = [_interface(f"{KEY}.seats.{name}", name, section.seats[name], whole) for name in section.seats]
    feet = [
        Foot(_interface(f"{KEY}.feet[{number}]", name, foot, whole), _springs(foot))
        for number, (name, foot) in enumerate(zip(section.foot_names, section.feet, strict=True))
    ]
    return seats, feet


def _springs(foot: CasingFoot) -> Array | None:
    """Return the springs (6,) of a foot, N/m and N m/rad; None for one that is held."""
    if foot.held:
        return None
    parts = (foot.stiffness_n_per_m, foot.stiffness_n_m_per_rad)
    return np.array([value for part in parts for value in ((part.x, part.y, part.z) if part else (0.0,) * 3)])


def _interface(key: str, name: str, location: CasingPlace, whole: WholeCasing) -> Interface:
    """Return the nodes and the point of a seat or foot; refuse one that no node meets."""
    at = None if location.at_mm is None else 1e-3 * np.array(location.at_mm)
    if location.patch is not None:
        nodes = tuple(
            int(node)
            for node, patch in zip(whole.numbers, whole.patches, strict=True)
            if patch == location.patch
        )
        if not nodes:
            known_patches = sorted({patch for patch in whole.patches if patch})
            requirement = (
                f"one in column patch of the nodes: {', '.join(known_patches[:20]) or 'it has none'}"
            )
            raise ConfigError(f"{key}.patch", location.patch, requirement)
    elif location.nodes or location.node is not None:
        nodes = location.nodes or (int(location.node or 0),)
    else:
        assert at is not None
        distances = np.linalg.norm(whole.positions - at, axis=1)
        nearest = int(np.argmin(distances))
        if distances[nearest] > NEAR:
            requirement = (
                f"within 1 mm of a node; node {whole.numbers[nearest]} is nearest, "
                f"{1e3 * distances[nearest]:.4g} mm away"
            )
            raise ConfigError(f"{key}.at_mm", list(location.at_mm or ()), requirement)
        nodes, at = (int(whole.numbers[nearest]),), None
    for node in nodes:
        if node not in whole.rows_of_node:
            raise ConfigError(key, node, "a node that has rows in the stiffness of the casing")
    if at is None:
        at = np.mean([whole.position_of_node[node] for node in nodes], axis=0)
    return Interface(name, nodes, at)


def _machine_axes(section: CasingSection) -> tuple[Array, Array]:
    """Return the machine's X, Y and Z as rows (3, 3), and its origin (3,), m, in the file."""
    x, z = (np.array(axis) / np.linalg.norm(axis) for axis in (section.axes.x, section.axes.z))
    x = x - z * (x @ z)
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(z, x), z]), 1e-3 * np.array(section.axes.origin_mm)


def _refuse_square_hubs(section: Transmission, casing: CasingSection) -> None:
    """Refuse a gear that bends but holds its hub square, which would take moments that no foot carries."""
    for side in section.face_gears:
        single = section.single_gears.get(side)
        body = (single and single.body) or section.face_gear.body
        hub_tilt = (single and single.hub_tilt) or section.face_gear.hub_tilt
        if f"{side} gear" in casing.seats and body is not None and hub_tilt is None:
            requirement = f"given, as the {side} gear bends and tilts with its seat on the casing"
            raise ConfigError("transmission.face_gear.hub_tilt", None, requirement)


def _refuse_clearance(section: Transmission, casing: CasingSection) -> None:
    """Refuse clearance_um in a bearing whose seat gives way: a clearance of rolling bearings takes its
    location.
    """
    for pinion in section.pinions:
        single = section.single_pinions.get(pinion.name)
        clearance = single.bearing_clearance_um if single else None
        key = f"transmission.single_pinions.{pinion.name}.clearance_um"
        if clearance is None:
            clearance, key = section.pinion.bearing_clearance_um, "transmission.pinion.clearance_um"
        if clearance and not casing.seats.keys().isdisjoint(_own_seats(section, pinion)):
            raise ConfigError(key, clearance, "0 where the pinion's seat gives way")


def _config_error(error: InvalidInput, section: CasingSection) -> ConfigError:
    """Return the error of a casing with the key of the section; an interface is refused by its name."""
    key = KEYS.get(error.quantity) or f"seats.{error.quantity}"
    if error.quantity in section.foot_names:
        key = f"feet[{section.foot_names.index(error.quantity)}]"
    return ConfigError(f"{KEY}.{key}", error.value, error.requirement.replace("`", ""))


def has_casing(transmission: Mapping[str, Any] | None) -> bool:
    """Whether the machine stands on a casing, told from plain values.

    Parameters
    ----------
    transmission : mapping or None
        Plain values of section `transmission`; None without it.

    Returns
    -------
    bool
        True if so.
    """
    return transmission is not None and transmission.get("casing") is not None
