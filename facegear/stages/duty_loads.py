"""What the running machine adds to the mesh torque in every bin of the duty cycle."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from facegear.config.base import parse
from facegear.config.dynamics import Accuracy, settings
from facegear.config.lumped_model import at_mesh_torque
from facegear.config.machines import wired_machine
from facegear.config.strength import Strength
from facegear.dynamics.steady_state.simulate import build_model, simulate
from facegear.errors import ConfigError
from facegear.progress import Progress
from facegear.stages.outcome import Outcome
from facegear.strength.columns import DUTY_LOAD_COLUMNS


def duty_loads(
    harmonics: pd.DataFrame,
    transmission: Mapping[str, Any],
    teeth: Mapping[str, Any],
    accuracy: Mapping[str, Any],
    strength: Mapping[str, Any] | None,
) -> Outcome:
    """`duty_loads` (table): K_gamma and K_v of every bin, from the machine's steady motion in it.

    K_gamma is the largest mean mesh force over that of the bin's torque, K_v the largest force of all meshes
    over the largest mean one. Raises ConfigError without section strength, NotConverged naming the speed.
    """
    if strength is None:
        raise ConfigError("strength", None, "required for the loads of its duty cycle")
    section, known = parse(Strength, strength), parse(Accuracy, accuracy)
    progress, rows = Progress("duty cycle", len(section.duty)), []
    for number, one in enumerate(section.duty, start=1):
        loaded = at_mesh_torque(transmission, one.torque_n_m)
        model = build_model(wired_machine(loaded, teeth, harmonics))
        found = simulate(model, one.speed_rpm, settings(known))
        forces, means = np.abs(found.forces).max(axis=0), np.abs(found.mean_forces)
        worst = int(np.argmax(forces))
        nominal = one.torque_n_m / model.machine.layout.pinion_arm
        rows.append(
            (
                *(number, one.torque_n_m, one.speed_rpm),
                *(means.max() / nominal, forces.max() / means.max()),
                *(model.machine.layout.mesh_names[worst], found.label),
            )
        )
        progress.step()
    table = pd.DataFrame(rows, columns=list(DUTY_LOAD_COLUMNS))
    most = table["mesh_load_factor"] * table["dynamic_factor"]
    told = f"{most.max():.3f} times the bin's torque in bin {table['bin'][most.idxmax()]}"
    return Outcome({"duty_loads": table}, f"largest load on a mesh {told}")
