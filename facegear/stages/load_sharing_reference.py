"""Load sharing at rest, running slowly, and over a range of speeds."""

import pandas as pd

from facegear.arrays import Arrays
from facegear.config.dynamics import Accuracy, settings
from facegear.config.load_sharing import LoadSharing, sharing_options
from facegear.config.machine_layout import ToothNumbers
from facegear.config.machines import wired_machine
from facegear.config.transmission import Transmission
from facegear.load_sharing.reference import reference_table, speed_range_table
from facegear.stages.outcome import Outcome
from facegear.ties import first_largest_row


def load_sharing_reference(
    harmonics: pd.DataFrame,
    transmission: Transmission,
    teeth: ToothNumbers,
    accuracy: Accuracy,
    range_accuracy: Accuracy,
    options: LoadSharing,
    friction: pd.DataFrame | None = None,
    law: Arrays | None = None,
    poses: Arrays | None = None,
    bodies: Arrays | None = None,
) -> Outcome:
    """`reference` and `speeds` (tables). Raises NotConverged naming the speed."""
    machine = wired_machine(
        transmission, teeth, harmonics, friction=friction, law=law, poses=poses, bodies=bodies
    )
    wanted = sharing_options(options)
    reference = reference_table(machine, settings(accuracy), wanted)
    speeds = speed_range_table(machine, settings(range_accuracy), wanted)
    return Outcome({"reference": reference, "speeds": speeds}, _summary(speeds))


def _summary(speeds: pd.DataFrame) -> str:
    if not speeds["mean"].notna().any():
        return "no meshes share a load"
    worst = first_largest_row(speeds, "mean")
    return f"largest mean {worst['mean']:.2f} ({worst['group']}) at {worst['speed_rpm']:.0f} rpm"
