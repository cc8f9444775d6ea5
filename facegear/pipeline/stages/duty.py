"""Stages of the duty cycle: loads and poses of the running machine in every bin."""

import numpy as np
import pandas as pd

from facegear.arrays import Arrays
from facegear.build.machine import MachineInputs
from facegear.build.plans import settings
from facegear.errors import ConfigError
from facegear.machine.poses.fixed_point import operating_pose
from facegear.machine.poses.posed_flanks import flank_surfaces
from facegear.machine.poses.surface import PoseSurface
from facegear.number_format import count_noun
from facegear.pipeline.outcome import Outcome
from facegear.progress import Progress
from facegear.schema.motion import Accuracy
from facegear.schema.strength import Strength
from facegear.strength.columns import DUTY_LOAD_COLUMNS, DUTY_SPECTRUM_COLUMNS
from facegear.strength.duty_loads import history_of, load_rows, spectrum_rows
from facegear.teeth.conjugate import contact_at
from facegear.teeth.placement import FLANKS
from facegear.ties import first_largest_row


def duty_loads(
    inputs: MachineInputs,
    accuracy: Accuracy,
    strength: Strength | None,
) -> Outcome:
    """Compute the mesh forces of the running machine in every bin of its duty cycle.

    A machine whose runouts turn is followed through its hunting cycle, any other to its steady state.
    K_gamma is the largest mean of a mesh cycle over the mesh's nominal even share of the bin's load,
    K_v the largest force over that mean.

    Parameters
    ----------
    inputs : MachineInputs
        Everything that a machine is built from; the torque is set bin by bin.
    accuracy : Accuracy
        Section `dynamics.accuracy` of the config.
    strength : Strength or None
        Section `strength` of the config with the duty cycle (torque, speed, hours of each bin), None if
        it has none.

    Returns
    -------
    Outcome
        Table `duty_loads` (DUTY_LOAD_COLUMNS): a row a bin and flank that carries load, bins from 1.
        Table `duty_spectrum` (DUTY_SPECTRUM_COLUMNS): fraction of tooth passages by class of force, for
        each bin, body and flank.

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
    """Say in one line which mesh of which bin carries the largest force."""
    worst = first_largest_row(table, "largest_force_n")
    position = f"{worst['mesh']} in bin {worst['bin']} of {worst['torque_n_m']:g} N m"
    factors = f"K_gamma {worst['mesh_load_factor']:.3f}, K_v {worst['dynamic_factor']:.3f}"
    text = f"largest force {worst['largest_force_n']:.0f} N, {position}: {factors}"
    loose = ", ".join(str(number) for number in table.loc[~table["settled"], "bin"].unique())
    return f"{text}; bins without a settled motion: {loose}" if loose else text


COLUMNS = (
    *("bin", "torque_n_m", "mesh", "flank"),
    *("force_n", "unloaded_path_mm", "shaft_angle_error_deg", "stiffness_factor"),
)
"""Columns of table `duty_poses`; units stand in the names."""


def duty_poses(
    surface: Arrays,
    inputs: MachineInputs,
    strength: Strength | None,
) -> Outcome:
    """Compute where the contact of every mesh lies under the mean load of every bin of the duty cycle.

    Parameters
    ----------
    surface : Arrays
        Arrays `surface` of stage pose_surface.
    inputs : MachineInputs
        Everything that a machine is built from; the torque is set bin by bin.
    strength : Strength or None
        Section `strength` of the config, None if it has none.

    Returns
    -------
    Outcome
        `duty_poses`, a row for each bin (from 1), mesh and flank, with COLUMNS. force_n is along the
        line of action, not negative, 0 on the flank that does not carry; stiffness_factor is the
        stiffness over the machine's own.

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
        result, names = operating_pose(machine, pose_surface), machine.layout.mesh_names
        surfaces = flank_surfaces(machine, pose_surface)
        for mesh, name in enumerate(names):
            for back, flank in enumerate(FLANKS):
                flank_surface = surfaces[mesh + len(names) * back]
                contact = contact_at(flank_surface.pair, result.poses.errors(mesh, bool(back)))
                carries = bool(back) == (result.forces[mesh] < 0.0)
                rows.append(
                    (
                        *(number, load.torque_n_m, name, flank),
                        abs(result.forces[mesh]) if carries else 0.0,
                        np.nan if contact is None else 1e3 * contact.path,
                        np.degrees(result.angle[mesh]),
                        result.factor[mesh],
                    )
                )
    table = pd.DataFrame(rows, columns=list(COLUMNS))
    loaded_paths = table.loc[table["force_n"] > 0.0, "unloaded_path_mm"]
    between = f"{loaded_paths.min():.1f} to {loaded_paths.max():.1f} mm" if len(loaded_paths) else "no load"
    return Outcome({"duty_poses": table}, f"{count_noun(len(strength.duty), 'bin')}, contact at {between}")
