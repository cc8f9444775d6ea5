"""Quasi-static load sharing over the hunting cycle, against bearing stiffness, and error by error."""

import pandas as pd

from facegear.arrays import Arrays
from facegear.config.machine_layout import ToothNumbers
from facegear.config.machines import wired_machine
from facegear.config.transmission import Transmission
from facegear.load_sharing.hunting import hunting_cycle
from facegear.load_sharing.hunting_tables import bearing_table, cycle_table, group_table, mesh_table
from facegear.load_sharing.sensitivity import bearing_scan, sensitivities
from facegear.stages.outcome import Outcome
from facegear.ties import first_largest_row
from facegear.transmission.flanks import past_law
from facegear.transmission.static_gears import at_rest


def hunting(
    harmonics: pd.DataFrame,
    transmission: Transmission,
    teeth: ToothNumbers,
    positions: int,
    law: Arrays | None = None,
    poses: Arrays | None = None,
    bodies: Arrays | None = None,
    tooth_errors: Arrays | None = None,
) -> Outcome:
    """Tables `meshes`, `groups`, `bearings`, `cycles`, `scan`, `sensitivity`. Raises NotConverged."""
    whole = wired_machine(
        transmission, teeth, harmonics, law=law, poses=poses, bodies=bodies, tooth_errors=tooth_errors
    )
    machine = at_rest(whole)
    cycle = hunting_cycle(machine, positions)
    content = {
        "meshes": mesh_table(cycle),
        "groups": (groups := group_table(cycle)),
        "bearings": bearing_table(cycle, whole.drive_line),
        "cycles": cycle_table(cycle),
        "scan": bearing_scan(machine),
        "sensitivity": sensitivities(cycle),
    }
    known = groups.dropna(subset="k_gamma")
    if known.empty:
        return Outcome(content, "no path shares a load")
    past = float(past_law(machine, cycle.cycles, cycle.flank_forces).max())
    beyond = f"; past the mesh law's last level at up to {100.0 * past:.2g} % of positions" if past else ""
    worst = first_largest_row(known, "k_gamma")
    summary = f"K_gamma {worst['k_gamma']:.3f} ({worst['group']}) at {worst['torque_n_m']:g} N m"
    return Outcome(content, f"{summary} over {worst['mesh_cycles']:.0f} mesh cycles{beyond}")
