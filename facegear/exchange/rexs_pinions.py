"""Pinions of a REXS file as wishes for a machine to start from."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from facegear.errors import FacegearError
from facegear.exchange.rexs import read_rexs

RIGID = 1e12
"""Stiffness of a bearing, N/m, from which it counts as rigid: ten thousand times that of a mesh."""


@dataclass(frozen=True)
class RexsPinions:
    """The equal pinions of a REXS file.

    Attributes
    ----------
    values : dict
        By the fields of `facegear.new_machine.wishes.MachineWishes`; only what the file gives.
    notes : tuple of str
        What was changed on the way, a line each.
    """

    values: dict[str, Any]
    notes: tuple[str, ...]


def known_of_rexs(path: str | Path) -> RexsPinions:
    """Read the values for a starting config from a REXS file, whose pinions must be equal.

    These are number, teeth and sizes of the pinions, and mass and bearing stiffness of the first. The
    file has no face gears, roles, torques and speeds. Bearings of RIGID or stiffer become RIGID.

    Parameters
    ----------
    path : str or Path
        The REXS file.

    Returns
    -------
    RexsPinions
        Values of the equal pinions by wish name, and notes on what was changed.

    Raises
    ------
    FacegearError
        For a file without cylindrical gears, or with several kinds of them.
    """
    shafts = [shaft for shaft in read_rexs(path).shafts if shaft.gear is not None]
    gears = {shaft.gear for shaft in shafts if shaft.gear is not None}
    if len(gears) != 1:
        sizes = sorted((gear.teeth, gear.module) for gear in gears)
        descriptions = ", ".join(f"{teeth} teeth of {module:g} mm" for teeth, module in sizes) or "none"
        raise FacegearError(f"{path}: cylindrical gears = {descriptions}: must be equal pinions")
    (teeth,) = gears
    first = shafts[0]
    file_values = {
        "pinions": len(shafts),
        "pinion_teeth": teeth.teeth,
        "module_mm": teeth.module,
        "pressure_angle_deg": teeth.right_angle,
        "coast_pressure_angle_deg": None if teeth.left_angle == teeth.right_angle else teeth.left_angle,
        "helix_angle_deg": teeth.helix_angle or None,
        "pinion_width_mm": teeth.width,
        "pinion_bore_radius_mm": teeth.bore,
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
