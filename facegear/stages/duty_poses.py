"""Where the load of every bin of the duty cycle puts the teeth of every mesh."""

import numpy as np
import pandas as pd

from facegear.arrays import Arrays
from facegear.config.machines import MachineInputs
from facegear.config.strength import Strength
from facegear.errors import ConfigError
from facegear.geometry.conjugate import contact_at
from facegear.geometry.flank_errors import FLANKS
from facegear.number_format import count_noun
from facegear.poses.fixed_point import operating_pose
from facegear.poses.surface import PoseSurface
from facegear.stages.outcome import Outcome

COLUMNS = (
    *("bin", "torque_n_m", "mesh", "flank"),
    *("force_n", "unloaded_path_mm", "shaft_angle_error_deg", "stiffness_factor"),
)


def duty_poses(
    surface: Arrays,
    inputs: MachineInputs,
    strength: Strength | None,
) -> Outcome:
    """Compute the contact pose of every mesh under the load of every bin of the duty cycle.

    Parameters
    ----------
    surface : Arrays
        Arrays of stage pose_surface.
    inputs : MachineInputs
        What the machine is built from.
    strength : Strength or None
        Section `strength` of the config, None if it has none.

    Returns
    -------
    Outcome
        `duty_poses`, a row for each bin, mesh and flank, with COLUMNS.

    Raises
    ------
    ConfigError
        Without section strength.
    InvalidInput
        For a pose outside the surface.
    NotConverged
        Where an equilibrium does not converge.
    """
    if strength is None:
        raise ConfigError("strength", None, "given for the loads of its duty cycle")
    pose_surface, rows = PoseSurface.of_arrays(surface), []
    for number, load in enumerate(strength.duty, start=1):
        machine = inputs.at_torque(load.torque_n_m).build()
        result = operating_pose(machine, pose_surface)
        for mesh, name in enumerate(machine.layout.mesh_names):
            for back, flank in enumerate(FLANKS):
                contact = contact_at(pose_surface.pair, result.poses.errors(mesh, bool(back)))
                carries = bool(back) == (result.forces[mesh] < 0.0)
                rows.append(
                    (
                        *(number, load.torque_n_m, name, flank),
                        abs(result.forces[mesh]) if carries else 0.0,
                        np.nan if contact is None else 1e3 * contact.y,
                        np.degrees(result.angle[mesh]),
                        result.factor[mesh],
                    )
                )
    table = pd.DataFrame(rows, columns=list(COLUMNS))
    loaded_paths = table.loc[table["force_n"] > 0.0, "unloaded_path_mm"]
    between = f"{loaded_paths.min():.1f} to {loaded_paths.max():.1f} mm" if len(loaded_paths) else "no load"
    return Outcome({"duty_poses": table}, f"{count_noun(len(strength.duty), 'bin')}, contact at {between}")
