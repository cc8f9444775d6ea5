"""Exchange of a machine with REXS files: shafts and bearings of a config, pinions of a file."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from facegear.config.machine_layout import ToothNumbers, layout
from facegear.config.model import Config
from facegear.errors import ConfigError, FacegearError
from facegear.exchange.rexs import Shaft, Spur, Unit, read_rexs
from facegear.transmission.layout import Body

RIGID = 1e12
"""Stiffness of a bearing, N/m, from which it counts as rigid: ten thousand times that of a mesh."""


def gear_unit(config: Config) -> Unit:
    """Return pinions and face gears as shafts on their bearings.

    Parameters
    ----------
    config : Config
        The config.

    Returns
    -------
    Unit
        The unit in the units of REXS: stiffness in N/m, Young's modulus in MPa, lengths in mm.

    Raises
    ------
    ConfigError
        If the config has no transmission.
    """
    pair, machine = config.tooth_pair, config.transmission
    if machine is None:
        raise ConfigError("transmission", None, "given, as REXS describes shafts and bearings")
    body = pair.pinion
    spur = Spur(
        teeth=pair.pinion_teeth,
        module=pair.module_mm,
        width=None if body is None else body.width_mm,
        pressure_angle=pair.pressure_angle_deg,
        bore=None if body is None else body.bore_radius_mm,
    )
    machine_layout = layout(machine, ToothNumbers.of_config(pair.model_dump()))
    shafts = [_pinion(pinion.name, pinion.body, spur) for pinion in machine_layout.pinions]
    shafts += [_gear(gear.name, gear.body) for gear in machine_layout.gears]
    material = (body and body.material) or pair.material
    return Unit(tuple(shafts), 1e3 * material.young_modulus_gpa, material.poisson_ratio)


def _pinion(name: str, body: Body, spur: Spur) -> Shaft:
    """A pinion's own axis is z."""
    x, y, z = body.bearing
    return Shaft(name, body.mass, min(x, y), z, spur)


def _gear(name: str, body: Body) -> Shaft:
    x, y, z = body.bearing
    return Shaft(name, body.mass, min(x, y), z)


@dataclass(frozen=True)
class RexsPinions:
    """The equal pinions of a REXS file.

    Attributes
    ----------
    values : dict
        By the fields of `facegear.variants.starting_wishes.MachineWishes`; only what the file gives.
    notes : tuple of str
        What was changed on the way, a line each.
    """

    values: dict[str, Any]
    notes: tuple[str, ...]


def known_of_rexs(path: str | Path) -> RexsPinions:
    """Return the values that a REXS file has for a starting config.

    These are the pinions with their bearings and bodies. The file has no face gears, roles, torques and
    speeds.

    Parameters
    ----------
    path : str or Path
        The REXS file.

    Returns
    -------
    RexsPinions
        Values of the equal pinions, and notes.

    Raises
    ------
    FacegearError
        For a file without cylindrical gears, or with several kinds of them.
    """
    shafts = [shaft for shaft in read_rexs(path).shafts if shaft.spur is not None]
    spurs = {shaft.spur for shaft in shafts if shaft.spur is not None}
    if len(spurs) != 1:
        sizes = sorted((spur.teeth, spur.module) for spur in spurs)
        descriptions = ", ".join(f"{teeth} teeth of {module:g} mm" for teeth, module in sizes) or "none"
        raise FacegearError(f"{path}: cylindrical gears = {descriptions}: must be equal pinions")
    (spur,) = spurs
    first = shafts[0]
    file_values = {
        "pinions": len(shafts),
        "pinion_teeth": spur.teeth,
        "module_mm": spur.module,
        "pressure_angle_deg": spur.pressure_angle,
        "pinion_width_mm": spur.width,
        "pinion_bore_radius_mm": spur.bore,
        "pinion_mass_kg": first.mass,
        "input_bearing_n_per_m": first.radial,
        "idler_bearing_n_per_m": first.radial,
        "axial_bearing_n_per_m": first.axial,
    }
    values = {name: value for name, value in file_values.items() if value is not None}
    notes = []
    for name in [name for name in values if name.endswith("_n_per_m") and values[name] >= RIGID]:
        if name != "idler_bearing_n_per_m":
            notes.append(f"{path}: {name} = {values[name]:g}: taken as rigid, {RIGID:g} N/m")
        values[name] = RIGID
    return RexsPinions(values, tuple(notes))
