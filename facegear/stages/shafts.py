"""Shafts of pinions and masses behind torsional springs, with the machine at rest under its torques."""

import numpy as np
import pandas as pd

from facegear.config.machines import MachineInputs
from facegear.config.shafts import stepped_shaft
from facegear.errors import ConfigError
from facegear.stages.outcome import Outcome
from facegear.ties import first_largest_row
from facegear.transmission.shaft_tables import (
    deflection_table,
    load_table,
    seat_table,
    stiffness_table,
    torsion_table,
)
from facegear.transmission.static_gears import at_rest
from facegear.transmission.statics import mean_equilibrium


def shafts(
    inputs: MachineInputs,
) -> Outcome:
    """Compute shafts and torsional springs with the machine at rest under its torques.

    Parameters
    ----------
    inputs : MachineInputs
        What the machine is built from.

    Returns
    -------
    Outcome
        Tables `seats`, `stiffness`, `bearings`, `deflections` and `torsion`.

    Raises
    ------
    ConfigError
        Without shafts and torsion.
    NotConverged
        Where the equilibrium does not converge.
    """
    machine = inputs.build()
    if (line := machine.drive_line) is None:
        raise ConfigError("transmission.shafts", {}, "given, or transmission.torsion")
    machine_at_rest, section = at_rest(machine), inputs.transmission
    equilibrium = mean_equilibrium(machine_at_rest)
    shaft_sections = {i: section.shaft_of(pinion) for i, pinion in enumerate(section.pinions)}
    stepped = {i: stepped_shaft(shaft) for i, shaft in shaft_sections.items() if shaft is not None}
    content = {
        "seats": seat_table(machine_at_rest, line, equilibrium),
        "stiffness": stiffness_table(line),
        "bearings": load_table(machine_at_rest, line, equilibrium),
        "deflections": deflection_table(machine_at_rest, line, equilibrium, stepped),
        "torsion": torsion_table(machine, line),
    }
    return Outcome(content, _summary(content))


def _summary(content: dict[str, pd.DataFrame]) -> str:
    parts, seats, bearings, torsion = [], content["seats"], content["bearings"], content["torsion"]
    if len(seats):
        sagged = np.hypot(seats["x_um"], seats["y_um"])
        worst = first_largest_row(bearings, "radial_n")
        parts.append(
            f"shafts give way by up to {sagged.max():.4g} um ({seats['pinion'][int(sagged.argmax())]}), "
            f"{worst['radial_n']:.5g} N on bearing {worst['bearing']} of {worst['pinion']}"
        )
    for row in torsion.itertuples():
        parts.append(f"{row.mass} on {row.body}: {row.windup_deg:.4g} deg, {row.frequency_hz:.5g} Hz")
    return "; ".join(parts)
