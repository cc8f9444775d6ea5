"""Load sharing of the running machine while its runouts and pitch deviations turn."""

from facegear.config.dynamics import Accuracy, settings
from facegear.errors import ConfigError
from facegear.load_sharing.hunting import hunting_cycle, hunting_length
from facegear.load_sharing.running_machine import running, running_mesh_table, running_table
from facegear.stages.outcome import Outcome
from facegear.transmission.machine import Machine

FINER = 4
"""Samples of the running machine for each position of the machine at rest: it has peaks between."""


def following(
    machine: Machine,
    accuracy: Accuracy,
    speed_rpm: float,
    positions: int,
    cycles: int | None,
) -> Outcome:
    """Compute the load sharing of the running machine while its runouts and pitch deviations turn.

    Parameters
    ----------
    machine : Machine
        The machine.
    accuracy : Accuracy
        Section `dynamics.accuracy` of the config.
    speed_rpm : float
        Nominal speed of the pinions, rpm.
    positions : int
        Number of positions of a mesh cycle of the machine at rest; the running machine has FINER times as
        many samples.
    cycles : int or None
        Number of mesh cycles, None for the whole hunting cycle.

    Returns
    -------
    Outcome
        Tables `groups` and `meshes`.

    Raises
    ------
    NotConverged
        Naming the position or the mesh phase.
    ConfigError
        If the flanks of the machine's mesh kinematics are not treated apart.
    """
    if not machine.layout.kinematics.flanks_apart:
        raise ConfigError(
            "transmission.mesh_kinematics", "printed", "geometric where the running machine is followed"
        )
    length = hunting_length(machine)
    part = length if cycles is None else min(cycles, length)
    running_machine = running(machine, speed_rpm, part, FINER * positions, settings(accuracy))
    groups = running_table(running_machine, hunting_cycle(machine, positions))
    factors = ", ".join(
        f"{row.group} {row.k_gamma:.3f} (at rest {row.k_gamma_static:.3f}), K_v {row.k_v:.3f}"
        for row in groups.itertuples()
    )
    return Outcome(
        {"groups": groups, "meshes": running_mesh_table(running_machine)},
        f"K_gamma over {part} of {length} mesh cycles: {factors or 'no path shares a load'}; "
        f"two starts differ by {running_machine.memory:.0e}",
    )
