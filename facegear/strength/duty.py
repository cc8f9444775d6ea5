"""How often, and by how much, each flank of every gear is loaded in the bins of a duty cycle."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from facegear.arrays import Array, Integers

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True)
class DutyBin:
    """Torque (N m) on the pinion in one mesh, speed of the pinion (turns a second) and time (s)."""

    torque: float
    speed: float
    time: float


@dataclass(frozen=True, eq=False)
class FlankDuty:
    """Loads of one flank of the teeth of one gear.

    Attributes
    ----------
    body
        Its name.
    gear
        `pinion` or `face_gear`, as which the body's teeth are rated.
    flank
        `drive` (the pinion drives), `back`, or `each` where both are loaded alike.
    bins : (n,)
        Bin of each load, from 0.
    torque : (n,)
        On the pinion with all load factors, N m.
    cycles : (n,)
        Of each load.
    opposite : (bins,)
        Largest torque of the other flank in each bin, 0 where it carries none.
    meshes
        Name of the mesh of each load, none where the duty cycle does not say.
    """

    body: str
    gear: str
    flank: str
    bins: Integers
    torque: Array
    cycles: Array
    opposite: Array
    meshes: tuple[str, ...] = ()

    @property
    def largest(self) -> float:
        """Torque (N m) of the largest load that occurs: a bin of the duty cycle may last no time."""
        return float(self.torque.max(where=self.cycles > 0.0, initial=0.0))


def given_duty(gear: str, duty: Sequence[DutyBin], turns: float, both_ways: bool) -> FlankDuty:
    """Return the loads of the teeth of one gear where the duty cycle gives one torque a bin.

    Parameters
    ----------
    gear : str
        `pinion` or `face_gear`.
    duty : Sequence[DutyBin]
        Bins of the duty cycle.
    turns : float
        Loads of a tooth for one turn of the pinion, dimensionless number.
    both_ways : bool
        Whether both flanks carry every load.

    Returns
    -------
    FlankDuty
        Flank `each` where both flanks carry every load, else flank `drive`.
    """
    torque = np.array([load.torque for load in duty])
    return FlankDuty(
        body=gear,
        gear=gear,
        flank="each" if both_ways else "drive",
        bins=np.arange(len(duty)),
        torque=torque,
        cycles=np.array([turns * load.speed * load.time for load in duty]),
        opposite=torque if both_ways else np.zeros_like(torque),
    )


def machine_duty(
    spectrum: "pd.DataFrame", duty: Sequence[DutyBin], ratio: float, arm: float
) -> tuple[FlankDuty, ...]:
    """Return the loads of every flank that carries load in a machine, each from its own meshes.

    A tooth meets every mesh of its body once a turn.

    Parameters
    ----------
    spectrum : DataFrame
        Columns as DUTY_SPECTRUM_COLUMNS.
    duty : Sequence[DutyBin]
        Bins of the duty cycle.
    ratio : float
        Turns of a face gear for one of a pinion, dimensionless.
    arm : float
        Torque on the pinion of a mesh force of 1 N, with the application factor, m.

    Returns
    -------
    tuple[FlankDuty, ...]
        Loads of each flank, pinions first.
    """
    turns = {"pinion": 1.0, "face_gear": ratio}
    passes = np.array([entry.speed * entry.time for entry in duty])
    max_force = spectrum.groupby(["body", "flank", "bin"])["force_n"].max()
    flanks = []
    for (body, gear, flank), rows in spectrum.groupby(["body", "gear", "flank"], sort=False):
        other_flank = "back" if flank == "drive" else "drive"
        bins = rows["bin"].to_numpy() - 1
        opposite = [max_force.get((body, other_flank, number + 1), 0.0) for number in range(len(duty))]
        flanks.append(
            FlankDuty(
                body=str(body),
                gear=str(gear),
                flank=str(flank),
                bins=bins,
                torque=arm * rows["force_n"].to_numpy(),
                cycles=turns[str(gear)] * passes[bins] * rows["fraction"].to_numpy(),
                opposite=arm * np.array(opposite),
                meshes=tuple(rows["mesh"]),
            )
        )
    return tuple(sorted(flanks, key=lambda entry: entry.gear != "pinion"))
