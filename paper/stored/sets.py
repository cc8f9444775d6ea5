"""A stored set of undisclosed inputs as changes of the config."""

import csv
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from paper.stored.cases import Cases, PointChanges, changed_cases
from paper.stored.waveforms import WAVEFORM_TERMS, Waveform

HALF_TURN = 0.5
"""Lag of e(t) by half a mesh period, in mesh periods."""
ERROR_UM = 50.0
"""The paper's size of e(t), um."""
BEARING_STUDY, BEARING_KEY = "pinion_bearings", "transmission.pinion.bearing_stiffness_n_per_m"
"""The study whose two stiffer points the paper does not disclose, and the key that it sets."""


def config_changes(row: Mapping[str, Any]) -> dict[str, Any]:
    """Return the values of one row of a sets file by dotted config key.

    Parameters
    ----------
    row : Mapping[str, Any]
        Row of the file.

    Returns
    -------
    dict[str, Any]
        Values by key.
    """
    first, *other_terms = WAVEFORM_TERMS[Waveform(row["waveform"])]
    phase = float(row["error_phase_deg"])
    half_range = ERROR_UM * (1.0 if row["meaning"] == "amplitude" else 0.5)
    more_harmonics = [
        {
            "order": order,
            "amplitude_um": abs(weight) * half_range,
            "phase_deg": _wrap_degrees(order * phase + (180.0 if weight < 0.0 else 0.0)),
        }
        for order, weight in other_terms
    ]
    return {
        "transmission.torque.per_input_n_m": float(row["per_input_n_m"]),
        "transmission.torque.tail_share": float(row["tail_share"]),
        "transmission.phase_convention": str(row["phase_convention"]),
        "transmission.transmission_error": {
            "amplitude_um": ERROR_UM * first[1],
            "meaning": str(row["meaning"]),
            "phase_deg": _wrap_degrees(phase),
            "phasing": phasing_of(row["pattern"]),
            "more_harmonics": more_harmonics,
        },
        "transmission.damping.open_flanks": str(row["open_flanks"]),
        "mesh_stiffness.torque_n_m": float(row["stiffness_torque_n_m"]),
        "mesh_stiffness.variation": float(row["stiffness_variation"]),
    }


def point_changes(row: Mapping[str, Any]) -> PointChanges:
    """Return the keys that the points of studies set with the inputs of a row: the two stiffer pinion
    bearings.

    Parameters
    ----------
    row : Mapping[str, Any]
        Row of a sets file.

    Returns
    -------
    PointChanges
        Values by key, of each (study, point).
    """
    stiffness = {point: float(row[f"{point}_bearing_n_per_m"]) for point in ("mid", "stiff")}
    return {
        (BEARING_STUDY, point): {BEARING_KEY: {"x": k, "y": k, "z": 0.0}} for point, k in stiffness.items()
    }


def set_cases(values: Mapping[str, Any], row: Mapping[str, Any] | None) -> Cases:
    """Return the cases of a config with the inputs of a row of a sets file.

    Parameters
    ----------
    values : Mapping[str, Any]
        Plain values of the config.
    row : Mapping[str, Any] or None
        Row of the file, None for the config's own inputs.

    Returns
    -------
    Cases
        Cases of the machine and of each (study, point).
    """
    if row is None:
        return changed_cases(values, {})
    return changed_cases(values, config_changes(row), point_changes(row))


def phasing_of(pattern: str) -> dict[str, float]:
    """Return the value of the config key transmission.transmission_error.phasing for a pattern of half turns.

    Parameters
    ----------
    pattern : str
        Names of the meshes at which e(t) lags by half a mesh period, joined by `+`, or `none`.

    Returns
    -------
    dict[str, float]
        Lag by mesh, in mesh periods.
    """
    return {} if pattern == "none" else dict.fromkeys(pattern.split("+"), HALF_TURN)


def stored_sets(path: str | Path) -> dict[str, dict[str, str]]:
    """Read a sets file.

    Parameters
    ----------
    path : str or Path
        Path of the file.

    Returns
    -------
    dict[str, dict[str, str]]
        Row of each set by name.
    """
    with Path(path).open(encoding="utf-8", newline="") as file:
        return {row["set"]: row for row in csv.DictReader(file)}


def _wrap_degrees(degrees: float) -> float:
    return float(np.mod(degrees, 360.0))
