"""Scuffing and micropitting beside the safety of every flank, under the loads of the running machine."""

import pandas as pd

from facegear.strength.columns import SCUFFED_COLUMNS

RED = "red"


def with_scuffing(safety: pd.DataFrame, spectrum: pd.DataFrame, losses: pd.DataFrame) -> pd.DataFrame:
    """The table of SAFETY_COLUMNS with SCUFFED_COLUMNS: the worst of all bins and meshes of each flank.

    spectrum: columns as DUTY_SPECTRUM_COLUMNS, which says what meshes a flank runs in; losses: a row a bin
    and loaded flank of stage machine_loss. A flank is red where its contact is too hot or its film too thin
    for the oil.
    """
    of_duty = losses.loc[losses["bin"] > 0, ["mesh", "flank", *SCUFFED_COLUMNS, "within_torques_solved"]]
    meshes = spectrum[["body", "flank", "mesh"]].drop_duplicates()
    worst = meshes.merge(of_duty, on=["mesh", "flank"]).groupby(["body", "flank"]).min(numeric_only=True)
    rows = worst.reindex(pd.MultiIndex.from_frame(safety[["body", "flank"]])).reset_index(drop=True)
    table = safety.assign(**{name: rows[name].to_numpy() for name in SCUFFED_COLUMNS})
    solved = rows["within_torques_solved"].fillna(True).astype(bool).to_numpy()
    table["within_torques_solved"] = table["within_torques_solved"] & solved
    for column, failure in (("scuffing_safety", "scuffing"), ("micropitting_safety", "micropitting")):
        short = table[column] < 1.0
        table.loc[short, "verdict"] = RED
        reasons = [f"safety against {failure} {value:.2f}" for value in table.loc[short, column]]
        before = table.loc[short, "reason"]
        joined = [f"{old}; {new}" if old else new for old, new in zip(before, reasons, strict=True)]
        table.loc[short, "reason"] = joined
    return table
