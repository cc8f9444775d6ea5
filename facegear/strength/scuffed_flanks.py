"""Scuffing and micropitting beside the safety of every flank, under the loads of the running machine."""

import pandas as pd

from facegear.strength.columns import SCUFFED_COLUMNS

RED = "red"
"""Verdict of a flank that is less safe than required."""


def with_scuffing(safety: pd.DataFrame, spectrum: pd.DataFrame, losses: pd.DataFrame) -> pd.DataFrame:
    """Add SCUFFED_COLUMNS to the table of safety: the worst of all bins and meshes of each flank.

    A flank is red where its contact is too hot or its film too thin for the oil.

    Parameters
    ----------
    safety : DataFrame
        Columns as SAFETY_COLUMNS.
    spectrum : DataFrame
        Columns as DUTY_SPECTRUM_COLUMNS; it names the meshes of each flank.
    losses : DataFrame
        A row a bin and loaded flank of stage machine_loss.

    Returns
    -------
    DataFrame
        Columns as SAFETY_COLUMNS with SCUFFED_COLUMNS.
    """
    of_duty = losses.loc[losses["bin"] > 0, ["mesh", "flank", *SCUFFED_COLUMNS, "within_torques_solved"]]
    meshes = spectrum[["body", "flank", "mesh"]].drop_duplicates()
    worst = meshes.merge(of_duty, on=["mesh", "flank"]).groupby(["body", "flank"]).min(numeric_only=True)
    rows = worst.reindex(pd.MultiIndex.from_frame(safety[["body", "flank"]])).reset_index(drop=True)
    table = safety.assign(**{name: rows[name].to_numpy() for name in SCUFFED_COLUMNS})
    is_within = rows["within_torques_solved"].fillna(True).astype(bool).to_numpy()
    table["within_torques_solved"] = table["within_torques_solved"] & is_within
    for column, failure in (("scuffing_safety", "scuffing"), ("micropitting_safety", "micropitting")):
        short = table[column] < 1.0
        table.loc[short, "verdict"] = RED
        reasons = [f"safety against {failure} {value:.2f}" for value in table.loc[short, column]]
        before = table.loc[short, "reason"]
        all_reasons = [f"{old}; {new}" if old else new for old, new in zip(before, reasons, strict=True)]
        table.loc[short, "reason"] = all_reasons
    return table
