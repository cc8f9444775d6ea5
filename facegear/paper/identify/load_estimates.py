"""The first estimate of the undisclosed load, and whether the config's load agrees with it."""

from collections.abc import Mapping

import pandas as pd
import scipy.optimize

from facegear.stiffness.curve import LoadTable
from facegear.stiffness.request import Definition


def estimate_table(
    tables: Mapping[str, LoadTable], mean: float, definition: Definition, load: float
) -> pd.DataFrame:
    """One row a gear design: the load of the paper's mean stiffness, and the mean at the fitted load.

    Loads are torques on the pinion of one mesh, N m. The first estimate needs no dynamics; the two agree for
    a design whose mean at the config's load is the paper's. Empty where a load lies outside those solved.
    """
    rows = []
    for name, table in tables.items():
        inside = table.torques[0] <= load <= table.torques[-1]
        at_load = float(table.at(load, definition).mean()) if inside else None
        rows.append(
            {
                "design": name,
                "load_from_mean_stiffness_n_m": load_for_mean(table, mean, definition),
                "config_load_n_m": load,
                "mean_at_config_load_n_per_m": at_load,
                "ratio_to_paper": at_load / mean if at_load else None,
            }
        )
    return pd.DataFrame(rows)


def load_for_mean(table: LoadTable, mean: float, definition: Definition) -> float | None:
    """Torque on a pinion for one mesh (N m) at which the mean stiffness is `mean` (N/m).

    None if no load of the table gives it.
    """

    def excess(torque: float) -> float:
        return float(table.at(torque, definition).mean()) - mean

    low, high = float(table.torques[0]), float(table.torques[-1])
    if excess(low) * excess(high) > 0.0:
        return None
    return float(scipy.optimize.brentq(excess, low, high, rtol=1e-10))
