"""Numbers of the machine at rest that several parts of a report read."""

from collections.abc import Mapping
from typing import Any

import pandas as pd

ROUNDING_OF_POWER = 1e-9
"""Relative difference of power in and out that is rounding."""


def machine_numbers(tables: Mapping[str, pd.DataFrame]) -> dict[str, Any]:
    """Return numbers of the machine at rest, with the torques of what takes most power.

    That is a gear, or pinions: then neither the number of teeth nor the gear's speed is that of the output.

    Parameters
    ----------
    tables : mapping of str to DataFrame
        Tables of the report by name.

    Returns
    -------
    dict
        Numbers by quantity, whose names end in their units; empty without a machine.
    """
    if "ratings" not in tables:
        return {}
    numbers = dict(tables["ratings"].itertuples(index=False))
    driven_bodies = tables["bodies"][tables["bodies"]["power_kw"] < 0.0]
    gears = driven_bodies["role"] == "face gear"
    if (
        len(driven_bodies)
        and driven_bodies.loc[~gears, "power_kw"].sum() < driven_bodies.loc[gears, "power_kw"].sum()
    ):
        torques = dict.fromkeys(sorted(driven_bodies.loc[~gears, "torque_n_m"].abs()))
        return {
            **{name: value for name, value in numbers.items() if name != "gear_ratio"},
            "speed_ratio": 1.0,
            "output_pinions_n_m": tuple(torques),
        }
    torques = tables["bodies"].loc[tables["bodies"]["role"] == "face gear", "torque_n_m"]
    return numbers | {"output_torque_n_m": float(torques.abs().max())}


def nominal(tables: Mapping[str, pd.DataFrame]) -> pd.DataFrame:
    """Return the summary of load sharing of the machine itself.

    Parameters
    ----------
    tables : mapping of str to DataFrame
        Tables of the report by name.

    Returns
    -------
    DataFrame
        Rows of table `summary`; empty where there is none.
    """
    summary = tables.get("summary")
    return pd.DataFrame() if summary is None else summary[summary["study"] == "nominal"]
