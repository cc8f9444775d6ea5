"""A stored set of undisclosed inputs as changes of the config."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from facegear.paper.identify.inputs import WAVEFORM_TERMS, Waveform


def config_changes(row: Mapping[str, Any], error_um: float) -> dict[str, Any]:
    """Dotted config keys and values of one row of a sets file; `error_um` is the paper's size of e(t)."""
    first, *others = WAVEFORM_TERMS[Waveform(row["waveform"])]
    phase = float(row["error_phase_deg"])
    half_range = error_um * (1.0 if row["meaning"] == "amplitude" else 0.5)
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
            "amplitude_um": error_um * first[1],
            "meaning": str(row["meaning"]),
            "phase_deg": _wrapped(phase),
            "phasing": str(row["phasing"]),
            "more_harmonics": more,
        },
        "mesh_stiffness.torque_n_m": float(row["stiffness_torque_n_m"]),
    }


def named_set(sets: pd.DataFrame, name: str) -> dict[str, Any]:
    """The row of a set. Raises KeyError if there is none."""
    rows = sets[sets["set"].astype(str) == name]
    if rows.empty:
        raise KeyError(name)
    return rows.iloc[0].to_dict()


def _wrapped(degrees: float) -> float:
    return float(np.mod(degrees, 360.0))
