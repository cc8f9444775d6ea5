"""Position of the mesh forces in the table of their load-dependent law."""

import pandas as pd

from facegear.dynamics.between_samples import located_extremes
from facegear.dynamics.response_tables import shows_a_period

LAW_LOAD_COLUMNS = (
    *("last_level_n", "smallest_n", "mean_n", "largest_n", "past_fraction"),
    *("sweep_largest_n", "sweep_past_fraction"),
)
"""Columns of law_loads_table() after mesh and flank."""


def law_loads_table(
    levels: pd.DataFrame, response: pd.DataFrame, summary: pd.DataFrame, sweep: pd.DataFrame
) -> pd.DataFrame:
    """Tabulate where the forces of each mesh lie in the table of its law.

    Parameters
    ----------
    levels : DataFrame
        Table of stage mesh_law, in which one gear alone is the upper.
    response, summary : DataFrame
        Tables of stage dynamics_response.
    sweep : DataFrame
        Table of stage dynamics_sweep.

    Returns
    -------
    DataFrame
        One row a mesh: mesh, flank, and LAW_LOAD_COLUMNS.

        - last_level_n: mean force at the last level of the table of the flank that carries the load
        - smallest_n, mean_n, largest_n: elastic force at the nominal speed, counted on that flank; extremes
          are located between the samples
        - past_fraction: largest fraction of the samples past the last level there
        - sweep_largest_n, sweep_past_fraction: the largest of both over the sweep
    """
    last = levels.groupby(["gear", "flank"])["force_n"].max()
    sides = {name.rpartition("/")[2] for name in response["mesh"]}
    rows, whole = [], shows_a_period(response, summary)
    for mesh, forces in response.groupby("mesh", sort=False)["elastic_force_n"]:
        sign = 1.0 if forces.mean() >= 0.0 else -1.0
        side = str(mesh).rpartition("/")[2] if len(sides) > 1 else "upper"
        flank = "drive" if sign > 0.0 else "back"
        flank_forces = sign * forces
        extremes = located_extremes(flank_forces.to_numpy()[:, None], whole)
        smallest, largest = (float(extreme[0]) for extreme in extremes)
        rows.append(
            (
                mesh,
                flank,
                last[side, flank],
                *(smallest, flank_forces.mean(), largest),
                _largest(summary, "past_law_fraction", mesh),
                _largest(sweep, "largest_elastic_force_n", mesh),
                _largest(sweep, "past_law_fraction", mesh),
            )
        )
    return pd.DataFrame(rows, columns=["mesh", "flank", *LAW_LOAD_COLUMNS])


def _largest(table: pd.DataFrame, quantity: str, mesh: object) -> float:
    """Largest value of a quantity of a mesh, 0 where the table has none."""
    values = table.loc[(table["quantity"] == quantity) & (table["body_or_mesh"] == mesh), "value"]
    return float(values.max()) if len(values) else 0.0
