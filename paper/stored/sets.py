"""A stored set of undisclosed inputs as changes of the config."""

import csv
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from paper.stored.cases import Cases, PointChanges, changed_cases
from paper.stored.waveforms import WAVEFORM_TERMS, Waveform

HALF_TURN = 0.5
"""Mesh periods."""
ERROR_UM = 50.0
"""The paper's size of e(t)."""
BEARING_STUDY, BEARING_KEY = "pinion_bearings", "transmission.pinion.bearing_stiffness_n_per_m"
"""The study whose two stiffer points the paper does not disclose, and the key that it sets."""


def config_changes(row: Mapping[str, Any]) -> dict[str, Any]:
    """Dotted config keys and values of one row of a sets file."""
    first, *others = WAVEFORM_TERMS[Waveform(row["waveform"])]
    phase = float(row["error_phase_deg"])
    half_range = ERROR_UM * (1.0 if row["meaning"] == "amplitude" else 0.5)
    more = [
        {
            "order": order,
            "amplitude_um": abs(weight) * half_range,
            "phase_deg": _wrapped(order * phase + (180.0 if weight < 0.0 else 0.0)),
        }
        for order, weight in others
    ]
    return {
        "transmission.torque.per_input_n_m": float(row["per_input_n_m"]),
        "transmission.torque.tail_share": float(row["tail_share"]),
        "transmission.phase_convention": str(row["phase_convention"]),
        "transmission.transmission_error": {
            "amplitude_um": ERROR_UM * first[1],
            "meaning": str(row["meaning"]),
            "phase_deg": _wrapped(phase),
            "phasing": phasing_of(row["pattern"]),
            "more_harmonics": more,
        },
        "transmission.damping.open_flanks": str(row["open_flanks"]),
        "mesh_stiffness.torque_n_m": float(row["stiffness_torque_n_m"]),
        "mesh_stiffness.variation": float(row["stiffness_variation"]),
    }


def point_changes(row: Mapping[str, Any]) -> PointChanges:
    """Keys that the points of studies set with the inputs of a row: the two stiffer pinion bearings."""
    stiffness = {point: float(row[f"{point}_bearing_n_per_m"]) for point in ("mid", "stiff")}
    return {
        (BEARING_STUDY, point): {BEARING_KEY: {"x": k, "y": k, "z": 0.0}} for point, k in stiffness.items()
    }


def set_cases(values: Mapping[str, Any], row: Mapping[str, Any] | None) -> Cases:
    """Cases of a config with the inputs of a row of a sets file; its own for None."""
    if row is None:
        return changed_cases(values, {})
    return changed_cases(values, config_changes(row), point_changes(row))


def phasing_of(pattern: str) -> dict[str, float]:
    """Value of the config key transmission.transmission_error.phasing for a pattern of half turns.

    A pattern names the meshes at which e(t) lags by half a mesh period, joined by `+`, or is `none`.
    """
    return {} if pattern == "none" else dict.fromkeys(pattern.split("+"), HALF_TURN)


def stored_sets(path: str | Path) -> dict[str, dict[str, str]]:
    """Name -> the row of each stored set."""
    with Path(path).open(encoding="utf-8", newline="") as file:
        return {row["set"]: row for row in csv.DictReader(file)}


def _wrapped(degrees: float) -> float:
    return float(np.mod(degrees, 360.0))
