"""Random starts at one speed: which motions they end on."""

from facegear.config.branches import Branches, branch_plan
from facegear.dynamics.branches.machine import random_starts
from facegear.dynamics.branches.motion_arrays import to_arrays
from facegear.dynamics.steady_state.simulate import build_model
from facegear.progress import Progress
from facegear.stages.outcome import Outcome
from facegear.transmission.machine import Machine


def branches_starts(
    number: int,
    machine: Machine,
    branches: Branches | None,
    speed_rpm: float,
) -> Outcome:
    """Find the motions that random starts end on, at one of the speeds of the config.

    Parameters
    ----------
    number : int
        Index of the speed, from 0.
    machine : Machine
        The machine.
    branches : Branches or None
        Section `branches` of the config, None if it has none.
    speed_rpm : float
        Nominal speed of the pinions, rpm.

    Returns
    -------
    Outcome
        Arrays `motions`.

    Raises
    ------
    NotConverged
        Naming the speed.
    """
    model = build_model(machine)
    plan = branch_plan(branches, speed_rpm)
    speed = plan.speeds_rpm[number]
    motions = random_starts(model, plan, speed, Progress("random starts", plan.starts).step)
    fractions = ", ".join(
        f"{motion.label} {100 * motion.fraction:.1f} +- {100 * motion.error:.1f} %" for motion in motions
    )
    return Outcome({"motions": to_arrays(speed, motions)}, f"{speed:g} rpm: {fractions}")
