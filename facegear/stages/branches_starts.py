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
    """`motions` (arrays) at one of the config's speeds. Raises NotConverged naming the speed."""
    model = build_model(machine)
    plan = branch_plan(branches, speed_rpm)
    speed = plan.speeds_rpm[number]
    motions = random_starts(model, plan, speed, Progress("random starts", plan.starts).step)
    fractions = ", ".join(
        f"{motion.label} {100 * motion.fraction:.1f} +- {100 * motion.error:.1f} %" for motion in motions
    )
    return Outcome({"motions": to_arrays(speed, motions)}, f"{speed:g} rpm: {fractions}")
