"""Load sharing at rest, running slowly, and over a range of speeds."""

import pandas as pd

from facegear.config.dynamics import Accuracy, settings
from facegear.config.load_sharing import LoadSharing, sharing_options
from facegear.load_sharing.reference import reference_table, speed_range_table
from facegear.stages.outcome import Outcome
from facegear.ties import first_largest_row
from facegear.transmission.machine import Machine


def load_sharing_reference(
    machine: Machine,
    accuracy: Accuracy,
    range_accuracy: Accuracy,
    options: LoadSharing,
) -> Outcome:
    """Compute the load sharing at rest, running slowly, and over a range of speeds.

    Parameters
    ----------
    machine : Machine
        The machine.
    accuracy : Accuracy
        Section `dynamics.accuracy` of the config.
    range_accuracy : Accuracy
        Section `dynamics.sweep.accuracy` of the config, for the range of speeds.
    options : LoadSharing
        Section `load_sharing` of the config.

    Returns
    -------
    Outcome
        Tables `reference` and `speeds`.

    Raises
    ------
    NotConverged
        Naming the speed.
    """
    sharing = sharing_options(options)
    reference = reference_table(machine, settings(accuracy), sharing)
    speeds = speed_range_table(machine, settings(range_accuracy), sharing)
    return Outcome({"reference": reference, "speeds": speeds}, _summary(speeds))


def _summary(speeds: pd.DataFrame) -> str:
    if not speeds["mean"].notna().any():
        return "no meshes share a load"
    worst = first_largest_row(speeds, "mean")
    return f"largest mean {worst['mean']:.2f} ({worst['group']}) at {worst['speed_rpm']:.0f} rpm"
