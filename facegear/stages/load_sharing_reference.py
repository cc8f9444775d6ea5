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
    """`reference` and `speeds` (tables). Raises NotConverged naming the speed."""
    wanted = sharing_options(options)
    reference = reference_table(machine, settings(accuracy), wanted)
    speeds = speed_range_table(machine, settings(range_accuracy), wanted)
    return Outcome({"reference": reference, "speeds": speeds}, _summary(speeds))


def _summary(speeds: pd.DataFrame) -> str:
    if not speeds["mean"].notna().any():
        return "no meshes share a load"
    worst = first_largest_row(speeds, "mean")
    return f"largest mean {worst['mean']:.2f} ({worst['group']}) at {worst['speed_rpm']:.0f} rpm"
