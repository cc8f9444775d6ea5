"""How far an operating speed is from the nearest jump of the response."""

from facegear.dynamics.steady_state.simulate import Model
from facegear.dynamics.sweeps.jumps import Jump
from facegear.dynamics.sweeps.plan import JumpRange
from facegear.dynamics.sweeps.sweep import run_chunk
from facegear.dynamics.sweeps.whole_sweep import whole_sweep


def jump_margin(model: Model, speed_rpm: float, within: JumpRange) -> float:
    """Distance (rpm) from a speed to the nearest jump of sweeps up and down; the range where there is none.

    A jump is what `facegear.dynamics.sweeps.jumps` calls one, and lies at the nearer end of its bracket: the
    margin is 0 at a speed inside it. What jumps farther away than the range is not seen, nor are motions that
    neither sweep meets. Raises NotConverged naming the speed.
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
