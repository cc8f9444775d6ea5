"""Natural frequencies, mode shapes and their classes."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from facegear.config.machines import wired_machine
from facegear.errors import ConfigError
from facegear.harmonics.series import Harmonics
from facegear.stages.outcome import Outcome
from facegear.stiffness.tables import series_of
from facegear.transmission.loaded_modes import loaded_modes
from facegear.transmission.modal_tables import frequency_table, shape_table
from facegear.transmission.mode_classes import name_modes


def modal(
    transmission: Mapping[str, Any],
    teeth: Mapping[str, Any],
    mean_stiffness: float | None,
    harmonics: pd.DataFrame | None = None,
) -> Outcome:
    """`frequencies` and `shapes` (tables) of the machine with the mean mesh stiffness (N/m).

    Where the config gives none it is the mean of the stiffness stage's `harmonics`. Raises ConfigError
    without either.
    """
    mean = mean_stiffness if harmonics is None else series_of(harmonics).mean
    if mean is None:
        raise ConfigError("mesh_stiffness.mean_n_per_m", None, "given where k(t) is not computed")
    constant, none = Harmonics(np.zeros(1), np.array([mean])), Harmonics(np.zeros(1), np.zeros(1))
    machine = wired_machine(transmission, teeth, constant, unloaded=none)
    shape, modes = machine.layout, loaded_modes(machine)
    rigid = int((modes.frequencies == 0.0).sum())
    elastic = modes.frequencies[rigid:]
    frequencies = frequency_table(modes, name_modes(shape, modes))
    return Outcome(
        {"frequencies": frequencies, "shapes": shape_table(shape, modes)},
        f"{rigid} rigid body modes, {elastic.size} from {elastic[0]:.1f} to {elastic[-1]:.1f} Hz",
    )
