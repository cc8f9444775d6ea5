"""Quasi-static load sharing over the hunting cycle, against bearing stiffness, and error by error."""

from facegear.load_sharing.hunting import hunting_cycle
from facegear.load_sharing.hunting_tables import bearing_table, cycle_table, group_table, mesh_table
from facegear.load_sharing.sensitivity import bearing_scan, sensitivities
from facegear.stages.outcome import Outcome
from facegear.ties import first_largest_row
from facegear.transmission.flanks import past_law
from facegear.transmission.machine import Machine
from facegear.transmission.static_gears import at_rest


def hunting(
    machine: Machine,
    positions: int,
) -> Outcome:
    """Compute the quasi-static load sharing over the hunting cycle.

    Parameters
    ----------
    machine : Machine
        The machine.
    positions : int
        Number of positions in a mesh cycle.

    Returns
    -------
    Outcome
        Tables `meshes`, `groups`, `bearings`, `cycles`, `scan` and `sensitivity`.

    Raises
    ------
    NotConverged
        Where an equilibrium does not converge.
    """
    machine_at_rest = at_rest(machine)
    cycle = hunting_cycle(machine_at_rest, positions)
    content = {
        "meshes": mesh_table(cycle),
        "groups": (groups := group_table(cycle)),
        "bearings": bearing_table(cycle, machine.drive_line),
        "cycles": cycle_table(cycle),
        "scan": bearing_scan(machine_at_rest),
        "sensitivity": sensitivities(cycle),
    }
    groups_with_factor = groups.dropna(subset="k_gamma")
    if groups_with_factor.empty:
        return Outcome(content, "no path shares a load")
    past = float(past_law(machine_at_rest, cycle.cycles, cycle.flank_forces).max())
    beyond = f"; past the mesh law's last level at up to {100.0 * past:.2g} % of positions" if past else ""
    worst = first_largest_row(groups_with_factor, "k_gamma")
    summary = f"K_gamma {worst['k_gamma']:.3f} ({worst['group']}) at {worst['torque_n_m']:g} N m"
    return Outcome(content, f"{summary} over {worst['mesh_cycles']:.0f} mesh cycles{beyond}")
