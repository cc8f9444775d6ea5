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
