"""Loci of folds and period doublings in the plane of speed and a second parameter."""

from facegear.arrays import Arrays
from facegear.config.branches import Branches, branch_plan
from facegear.dynamics.branches.machine import machine_loci, machine_period_map
from facegear.dynamics.branches.motion_arrays import special_points
from facegear.dynamics.branches.summary import loci_summary, tell
from facegear.dynamics.branches.tables import locus_table
from facegear.dynamics.steady_state.simulate import build_model
from facegear.stages.outcome import Outcome
from facegear.transmission.machine import Machine


def branches_loci(
    orbits: Arrays,
    machine: Machine,
    branches: Branches | None,
    speed_rpm: float,
) -> Outcome:
    """Follow folds and period doublings in the plane of speed and a second parameter.

    Parameters
    ----------
    orbits : Arrays
        Arrays of the special points, of stage branches.
    machine : Machine
        The machine.
    branches : Branches or None
        Section `branches` of the config, None if it has none.
    speed_rpm : float
        Nominal speed of the pinions, rpm.

    Returns
    -------
    Outcome
        Table `loci`.
    """
    model = build_model(machine)
    plan = branch_plan(branches, speed_rpm)
    loci, failures = machine_loci(model, plan, special_points(machine_period_map(model, plan), orbits), tell)
    return Outcome({"loci": locus_table(loci)}, loci_summary(loci, failures))
