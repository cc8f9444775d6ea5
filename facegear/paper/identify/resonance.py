"""Jumps of the response level along sweeps up and down."""

import numpy as np
from numpy.typing import NDArray

from facegear.dynamics.motion import Settings, State
from facegear.dynamics.steady_state.simulate import Model, simulate

JUMP = 0.12
"""Change of the level between neighbouring speeds that counts as a jump, relative to the higher level."""


def swept_levels(
    model: Model, speeds: NDArray[np.float64], settings: Settings, start: State
) -> NDArray[np.float64]:
    """RMS about the mean of the mesh deflections, averaged over the meshes, m; the state is carried along."""
    levels, state = np.empty(speeds.size), start
    for row, speed in enumerate(speeds):
        response = simulate(model, float(speed), settings, start=state)
        levels[row] = response.deflections.std(axis=0).mean()
        state = response.state
    return levels


def jump_speeds(speeds: NDArray[np.float64], levels: NDArray[np.float64]) -> NDArray[np.float64]:
    """Midpoints of the steps over which the level jumps."""
    change = np.abs(np.diff(levels)) / np.maximum(levels[1:], levels[:-1])
    return 0.5 * (speeds[1:] + speeds[:-1])[change > JUMP]


def jump_distance(
    model: Model, target: float, reach: float, points: int, settings: Settings, start: State
) -> float:
    """Relative distance from `target` (rpm) to the nearest jump of either sweep, at most `reach`."""
    speeds = target * np.linspace(1.0 - reach, 1.0 + reach, points)
    up = swept_levels(model, speeds, settings, start)
    down = swept_levels(model, speeds[::-1], settings, start)
    found = np.concatenate([jump_speeds(speeds, up), jump_speeds(speeds[::-1], down)])
    return float(np.abs(found / target - 1.0).min()) if found.size else reach
