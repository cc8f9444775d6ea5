"""Mesh forces beside the levels of their load-dependent law, and what lies beyond the last level."""

import pandas as pd

from facegear.dynamics.law_loads import law_loads_table
from facegear.stages.outcome import Outcome


def law_loads(
    levels: pd.DataFrame, response: pd.DataFrame, summary: pd.DataFrame, sweep: pd.DataFrame
) -> Outcome:
    """Compare the mesh forces with the levels of the mesh law.

    Parameters
    ----------
    levels : pd.DataFrame
        Table of stage mesh_law.
    response : pd.DataFrame
        Table of stage dynamics_response.
    summary : pd.DataFrame
        Table of stage dynamics_response.
    sweep : pd.DataFrame
        Table of stage dynamics_sweep.

    Returns
    -------
    Outcome
        Table `loads`, a row for each mesh.
    """
    table = law_loads_table(levels, response, summary, sweep)
    ratio = (table["largest_n"] / table["last_level_n"]).max()
    past = table["sweep_past_fraction"].max()
    text = (
        f"at most {100.0 * ratio:.0f} % of the last level's force at the nominal speed; in the sweep past it "
        f"for up to {100.0 * past:.2g} % of the time"
    )
    return Outcome({"loads": table}, text)
