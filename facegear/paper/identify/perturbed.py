"""Inputs moved by rounding: a claim that hangs on an irregular motion may then come out otherwise."""

import zlib
from collections.abc import Mapping
from typing import Any

SIZE = 1e-12
"""Relative change of every number."""
SECTIONS = ("transmission", "mesh_stiffness")


def perturbed(values: Mapping[str, Any], run: int) -> dict[str, Any]:
    """A config with every number of the machine and its stiffness moved up or down by SIZE.

    Run 0 is the config itself. The same number moves alike in every case of a run, so that cases that are the
    same machine stay so.
    """
    if run == 0:
        return dict(values)
    return {key: _moved(value, key, run) if key in SECTIONS else value for key, value in values.items()}


def _moved(value: Any, place: str, run: int) -> Any:
    if isinstance(value, Mapping):
        return {key: _moved(inside, f"{place}.{key}", run) for key, inside in value.items()}
    if isinstance(value, list | tuple):
        return [_moved(inside, f"{place}.{row}", run) for row, inside in enumerate(value)]
    if not isinstance(value, float):
        return value
    up = zlib.crc32(f"{run} {place}".encode()) & 1
    return value * (1.0 + (SIZE if up else -SIZE))
