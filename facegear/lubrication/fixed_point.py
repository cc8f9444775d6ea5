"""Fixed points of maps that contract, or nearly do: Anderson's acceleration (1965) with a short memory."""

from collections.abc import Callable

import numpy as np

from facegear.arrays import Array

MEMORY = 3


def fixed_point(step: Callable[[Array], Array], start: Array, settled: float, steps: int) -> Array | None:
    """The array that `step` leaves alone within `settled`, its largest change; None after so many steps."""
    at, points, changes = start, list[Array](), list[Array]()
    for _ in range(steps):
        after = step(at)
        change = (after - at).ravel()
        if np.abs(change).max(initial=0.0) < settled:
            return at
        points, changes = [*points, after.ravel()][-MEMORY - 1 :], [*changes, change][-MEMORY - 1 :]
        at = _mixed(points, changes).reshape(start.shape)
    return None


def _mixed(points: list[Array], changes: list[Array]) -> Array:
    """Where the changes, linear between the points, are smallest."""
    if len(points) == 1:
        return points[0]
    slopes = np.diff(changes, axis=0).T
    weights = np.linalg.lstsq(slopes, changes[-1], rcond=1e-10)[0]
    return points[-1] - np.diff(points, axis=0).T @ weights
