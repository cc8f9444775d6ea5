"""Mean and variation of the mesh stiffness at every torque of the contact analysis."""

import pandas as pd

from facegear.number_format import format_number
from facegear.stages.outcome import Outcome
from facegear.stiffness.curve import load_table
from facegear.stiffness.tables import load_dependence as table_of


def load_dependence(ltca: pd.DataFrame) -> Outcome:
    """Compute mean and variation of the mesh stiffness at every torque.

    Parameters
    ----------
    ltca : pd.DataFrame
        Table `ltca` of stage contact.

    Returns
    -------
    Outcome
        `table`.
    """
    table = table_of(load_table(ltca))
    means = table.loc[table["definition"] == "average", "mean_n_per_m"]
    least, largest = (format_number(1e-6 * mean) for mean in (means.min(), means.max()))
    summary = f"mean average stiffness {least} to {largest} N/um over the torques solved"
    return Outcome({"table": table}, summary)
