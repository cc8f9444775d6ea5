"""Where the forces of the meshes lie in the table of their load-dependent law, and what lies beyond."""

import pandas as pd

from facegear.dynamics.law_loads import law_loads_table
from facegear.stages.outcome import Outcome


def law_loads(
    levels: pd.DataFrame, response: pd.DataFrame, summary: pd.DataFrame, sweep: pd.DataFrame
) -> Outcome:
    """`loads` (table), a row a mesh."""
    table = law_loads_table(levels, response, summary, sweep)
    used = (table["largest_n"] / table["last_level_n"]).max()
    past = table["sweep_past_fraction"].max()
    text = (
        f"at most {100.0 * used:.0f} % of the last level's force at the nominal speed; in the sweep past it "
        f"for up to {100.0 * past:.2g} % of the time"
    )
    return Outcome({"loads": table}, text)
