"""The figures of a speed sweep by name, from its tables alone."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import pandas as pd

from facegear.plots.campbell import campbell, waterfall
from facegear.plots.description import Figure
from facegear.plots.response import deflections
from facegear.plots.sweep import mesh_sweeps, translations


@dataclass(frozen=True)
class DrawnMachine:
    """What the figures show of a machine: pinions (names), those with a panel, sides of its gears, teeth."""

    pinions: tuple[str, ...]
    pinions_shown: tuple[str, ...]
    sides: tuple[str, ...]
    teeth: int

    @property
    def gears(self) -> list[str]:
        """Names of the face gears, lower one first."""
        return [f"{side} face gear" for side in reversed(self.sides)]

    @property
    def meshes(self) -> list[str]:
        """Names of the meshes in the order of the arrays."""
        return [f"{name}/{side}" for side in reversed(self.sides) for name in self.pinions]


def drawn_machine(transmission: Mapping[str, Any], pinion_teeth: int) -> DrawnMachine:
    """From the plain values of the config's section `transmission`.

    Pinions of one role and torque stand for each other, the first is shown; where parts differ singly, all.
    """
    pinions, gears = transmission["pinions"], transmission["face_gears"]
    differ = any(transmission[key] for key in ("single_pinions", "single_meshes", "single_gears"))
    duties = [(pinion["role"], pinion["torque_n_m"]) for pinion in pinions]
    pinion_names = [
        pinion["name"] for i, pinion in enumerate(pinions) if differ or duties[i] not in duties[:i]
    ]
    sides = [side for side in ("upper", "lower") if side in gears]
    return DrawnMachine(
        tuple(pinion["name"] for pinion in pinions), tuple(pinion_names), tuple(sides), pinion_teeth
    )


def _waterfall(tables: Mapping[str, Any], machine: DrawnMachine) -> Figure:
    mesh_name = f"{machine.pinions_shown[-1]}/{machine.sides[0]}"
    return waterfall(tables["waterfall"], machine.meshes.index(mesh_name), mesh_name, machine.teeth)


def _campbell(tables: Mapping[str, Any], machine: DrawnMachine) -> Figure:
    last = tables["sweep"]["speed_rpm"].max()
    return campbell(tables["frequencies"], tables["resonances"], tables["jumps"], machine.teeth, last)


SWEEP_FIGURES: dict[str, Callable[[Mapping[str, Any], DrawnMachine], Figure]] = {
    "pinions": lambda tables, machine: translations(tables["sweep"], machine.pinions_shown, "xy"),
    "gears": lambda tables, machine: translations(tables["sweep"], machine.gears, "xyz"),
    "meshes": lambda tables, machine: mesh_sweeps(
        tables["sweep"], tables["jumps"], machine.pinions_shown, machine.sides
    ),
    "campbell": _campbell,
    "waterfall": _waterfall,
}
"""Figure by name: RMS of pinions, of face gears, of the meshes (with jumps), Campbell diagram, waterfall.

`tables` holds the tables sweep, jumps, resonances, frequencies and the arrays waterfall.
"""


def figures(
    response: pd.DataFrame,
    spectrum: pd.DataFrame,
    transmission: Mapping[str, Any],
    pinion_teeth: int,
    **swept: Any,
) -> list[Figure]:
    """Deflections at the nominal speed, and every figure of SWEEP_FIGURES from the tables `swept`."""
    machine = drawn_machine(transmission, pinion_teeth)
    nominal = deflections(response, spectrum, machine.pinions)
    return [nominal, *(draw(swept, machine) for draw in SWEEP_FIGURES.values())]
