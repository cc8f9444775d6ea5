"""Load sharing at rest, running slowly, and over a range of speeds."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from facegear.config.base import parse
from facegear.config.dynamics import Accuracy, settings
from facegear.config.load_sharing import LoadSharing, sharing_options
from facegear.config.machines import wired_machine
from facegear.load_sharing.reference import reference_table, speed_range_table
from facegear.stages.outcome import Outcome


def load_sharing_reference(
    harmonics: pd.DataFrame,
    transmission: Mapping[str, Any],
    teeth: Mapping[str, Any],
    accuracy: Mapping[str, Any],
    range_accuracy: Mapping[str, Any],
    options: Mapping[str, Any],
    friction: pd.DataFrame | None = None,
) -> Outcome:
    """`reference` and `speeds` (tables). Raises NotConverged naming the speed."""
    machine = wired_machine(transmission, teeth, harmonics, friction=friction)
    wanted = sharing_options(parse(LoadSharing, options))
    reference = reference_table(machine, settings(parse(Accuracy, accuracy)), wanted)
    speeds = speed_range_table(machine, settings(parse(Accuracy, range_accuracy)), wanted)
    return Outcome({"reference": reference, "speeds": speeds}, _summary(speeds))


def _summary(speeds: pd.DataFrame) -> str:
    if not speeds["mean"].notna().any():
        return "no meshes share a load"
    worst = speeds.iloc[int(np.nanargmax(speeds["mean"]))]
    return f"largest mean {worst['mean']:.2f} ({worst['group']}) at {worst['speed_rpm']:.0f} rpm"
