"""Distance of an operating speed from the nearest jump of the response."""

from facegear.dynamics.steady_state.simulate import Model
from facegear.dynamics.sweeps.jumps import Jump
from facegear.dynamics.sweeps.plan import JumpRange
from facegear.dynamics.sweeps.sweep import run_chunk
from facegear.dynamics.sweeps.whole_sweep import whole_sweep


def jump_margin(model: Model, speed_rpm: float, within: JumpRange) -> float:
    """Compute the distance from a speed to the nearest jump of sweeps up and down.

    A jump is defined in `facegear.dynamics.sweeps.jumps`, and lies at the nearer end of its bracket: the
    margin is 0 at a speed inside it. Jumps farther away than the range are not seen, nor are motions that
    neither sweep meets.

    Parameters
    ----------
    model : Model
        Reduced machine.
    speed_rpm : float
        Pinion speed, rpm.
    within : JumpRange
        Range around the speed.

    Returns
    -------
    float
        Distance, rpm; the range where there is no jump.

    Raises
    ------
    NotConverged
        If a run fails; the message names the speed.
    """
    plan = within.plan(speed_rpm)
    by_direction = whole_sweep(
        model, plan, {name: [run_chunk(model, plan, name, 0)] for name in plan.directions}
    )
    distances = [
        _distance(jump, speed_rpm) for direction in by_direction.values() for jump in direction.jumps
    ]
    return min([*distances, within.range_rpm])


def _distance(jump: Jump, speed: float) -> float:
    low, high = sorted((jump.before.speed, jump.after.speed))
    return max(low - speed, speed - high, 0.0)
