"""Mesh forces of the running machine in every bin of the duty cycle, and what its teeth meet of them."""

import pandas as pd

from facegear.config.dynamics import Accuracy, settings
from facegear.config.machines import MachineInputs
from facegear.config.strength import Strength
from facegear.errors import ConfigError
from facegear.progress import Progress
from facegear.stages.outcome import Outcome
from facegear.strength.columns import DUTY_LOAD_COLUMNS, DUTY_SPECTRUM_COLUMNS
from facegear.strength.duty_loads import history_of, load_rows, spectrum_rows
from facegear.ties import first_largest_row


def duty_loads(
    inputs: MachineInputs,
    accuracy: Accuracy,
    strength: Strength | None,
) -> Outcome:
    """Compute the mesh forces of the running machine in every bin of its duty cycle.

    K_gamma is the largest mean of a mesh cycle over the mesh's nominal even share of the bin's load, K_v the
    largest force over that mean.

    Parameters
    ----------
    inputs : MachineInputs
        What the machine is built from.
    accuracy : Accuracy
        Section `dynamics.accuracy` of the config.
    strength : Strength or None
        Section `strength` of the config, None if it has none.

    Returns
    -------
    Outcome
        Tables `duty_loads` and `duty_spectrum`.

    Raises
    ------
    ConfigError
        Without section strength.
    NotConverged
        Naming the speed.
    """
    if strength is None:
        raise ConfigError("strength", None, "given for the loads of its duty cycle")
    integration = settings(accuracy)
    progress, loads, spectrum = Progress("duty cycle", len(strength.duty)), [], []
    for number, load in enumerate(strength.duty, start=1):
        machine = inputs.at_torque(load.torque_n_m).build()
        history = history_of(machine, load.speed_rpm, integration)
        key = (number, load.torque_n_m, load.speed_rpm)
        loads += [(*key, *row) for row in load_rows(history)]
        spectrum += [(number, *row) for row in spectrum_rows(history)]
        progress.step()
    content = {
        "duty_loads": pd.DataFrame(loads, columns=list(DUTY_LOAD_COLUMNS)),
        "duty_spectrum": pd.DataFrame(spectrum, columns=list(DUTY_SPECTRUM_COLUMNS)),
    }
    return Outcome(content, _summary(content["duty_loads"]))


def _summary(table: pd.DataFrame) -> str:
    worst = first_largest_row(table, "largest_force_n")
    position = f"{worst['mesh']} in bin {worst['bin']} of {worst['torque_n_m']:g} N m"
    factors = f"K_gamma {worst['mesh_load_factor']:.3f}, K_v {worst['dynamic_factor']:.3f}"
    text = f"largest force {worst['largest_force_n']:.0f} N, {position}: {factors}"
    loose = ", ".join(str(number) for number in table.loc[~table["settled"], "bin"].unique())
    return f"{text}; bins without a settled motion: {loose}" if loose else text
