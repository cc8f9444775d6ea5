"""Criteria on the mesh stiffness; tables `tvms` and `load_dependence` of the stiffness stage."""

import numpy as np

from paper.scorecard.outcome import ClaimOutcome, Tables, number, statement


def fe_mean_stiffness(tables: Tables) -> ClaimOutcome:
    """Mean of the average stiffness from contact analysis at the load at which k(t) is taken.

    Parameters
    ----------
    tables : Tables
        Stored results by name.

    Returns
    -------
    ClaimOutcome
        The number, in the unit of the claim.
    """
    frame = tables["load_dependence"]
    rows = frame[frame["definition"] == "average"].sort_values("torque_n_m")
    logs = np.log(rows["torque_n_m"].to_numpy(float))
    torque = float(tables["inputs"]["stiffness_torque_n_m"].iloc[0])
    return number(float(np.interp(np.log(torque), logs, rows["mean_n_per_m"])), 4)


def series_carries_curve(tables: Tables, within: float) -> ClaimOutcome:
    """The kept Fourier series differs from the contact analysis nowhere by more than this part of the
    peak-to-peak value.

    Parameters
    ----------
    tables : Tables
        Stored results by name.
    within : float
        Part of the peak-to-peak value, relative.

    Returns
    -------
    ClaimOutcome
        Whether the statement holds, with the evidence.
    """
    frame = tables["tvms"]
    off = float(np.abs(frame["k_series_n_per_m"] - frame["k_n_per_m"]).max() / np.ptp(frame["k_n_per_m"]))
    return statement(off <= within, f"{100 * off:.2g} % of peak-to-peak")
