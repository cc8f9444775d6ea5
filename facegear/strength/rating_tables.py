"""Tables of a rating: safety of every flank, a row a way to fail, and the damage of each bin."""

from collections.abc import Mapping, Sequence
from itertools import groupby

import numpy as np
import pandas as pd

from facegear.strength.columns import (
    CURVE_COLUMNS,
    DAMAGE_COLUMNS,
    RATING_COLUMNS,
    SAFETY_COLUMNS,
    SCUFFED_COLUMNS,
)
from facegear.strength.contact_pressure import ContactPressure
from facegear.strength.materials import DutyBin
from facegear.strength.rating import FailureRating
from facegear.strength.root_stress import RootStress

POINTS = 61
"""Number of points of a curve of allowed stress."""
RED, OPEN_VERDICT = "red", "undecided"
"""Verdicts of a flank that is less safe than required, and of one whose pitting could not be rated."""
WORST_FIRST = (RED, OPEN_VERDICT, "green")
"""Verdicts from the worst to the best."""
SAFETY_WAYS = (
    *(("bending", "finite elements"), ("bending", "ISO 6336-3")),
    *(("pitting", "contact analysis"), ("pitting", "ISO 6336-2")),
)
"""Failure and method of each safety in SAFETY_COLUMNS, in their order."""
UNRATED = "pitting: not rated, as edges carry all load, where pressure has no limit"
"""Reason of an undecided verdict."""


def safety_table(ratings: Sequence[FailureRating], pressure: ContactPressure) -> pd.DataFrame:
    """Tabulate the safeties of each flank and the first failure to come, one row a flank.

    Reliability is the product of those of both failures, each by its worst method. A flank whose pitting has
    no rating is `undecided` unless its bending is red.

    Parameters
    ----------
    ratings : Sequence[FailureRating]
        Ratings of all flanks, those of one flank in sequence.
    pressure : ContactPressure
        Gives the load on tip edges under the largest torque of any cycle.

    Returns
    -------
    DataFrame
        Columns as SAFETY_COLUMNS, without reliability where no card has a Weibull shape.
    """
    rows = []
    for (body, flank), group in groupby(ratings, key=lambda rating: (rating.duty.body, rating.duty.flank)):
        ways = list(group)
        safety = {(rating.failure, rating.method): rating.safety for rating in ways}
        nearest = min(ways, key=lambda rating: rating.safety / rating.required_safety)
        reliabilities = [
            np.nanmin(by_method)
            for failure in ("bending", "pitting")
            if np.isfinite(
                by_method := [rating.reliability for rating in ways if rating.failure == failure]
            ).any()
        ]
        edge_load, edge_length = pressure.edge_at(ways[0].duty.largest)
        verdicts = [rating.verdict for rating in ways]
        reasons = [f"{rating.failure}: {rating.reason}" for rating in _worst_ways(ways) if rating.reason]
        if all(rating.failure != "pitting" for rating in ways):
            verdicts.append(OPEN_VERDICT)
            reasons.append(UNRATED)
        rows.append(
            (
                *(body, flank, min(verdicts, key=WORST_FIRST.index)),
                *(safety.get(way, np.nan) for way in SAFETY_WAYS),
                *(1e-3 * edge_load, 1e3 * edge_length),
                min(rating.life for rating in ways) / 3600.0,
                float(np.prod(reliabilities)) if reliabilities else np.nan,
                f"{nearest.failure} ({nearest.method})",
                "; ".join(reasons),
                "; ".join(dict.fromkeys(caveat for rating in ways for caveat in rating.caveats)),
                all(bool(_within(rating, pressure).all()) for rating in ways),
            )
        )
    return _without_empty_reliability(pd.DataFrame(rows, columns=list(SAFETY_COLUMNS)), ratings)


def _worst_ways(ways: Sequence[FailureRating]) -> list[FailureRating]:
    """Return for each failure (bending, pitting) the rating of one flank whose method gives the smallest
    safety.
    """
    return [
        min((rating for rating in ways if rating.failure == failure), key=lambda rating: rating.safety)
        for failure in dict.fromkeys(rating.failure for rating in ways)
    ]


def rating_table(
    ratings: Sequence[FailureRating], pressure: ContactPressure, roots: Mapping[str, RootStress]
) -> pd.DataFrame:
    """Tabulate safety and life by flank, failure and method; stress is that of the hardest load of any
    cycle.

    The error is that of the contact analysis' `pressure`, or of the mesh at the largest of `roots`; other
    methods have none.

    Parameters
    ----------
    ratings : Sequence[FailureRating]
        Ratings of all flanks.
    pressure : ContactPressure
        Pressure on the flanks; gives its error and the range of solved torques.
    roots : Mapping[str, RootStress]
        Root stress of both bodies; gives its error.

    Returns
    -------
    DataFrame
        Columns as RATING_COLUMNS, without reliability where no card has a Weibull shape.
    """
    rows = [
        (
            *_subject(rating),
            1e-6 * float(rating.stress.max(where=rating.duty.cycles > 0.0, initial=0.0)),
            1e-6 * _error(rating, pressure, roots),
            1e-6 * rating.allowed_stress,
            float(rating.duty.cycles.sum()),
            rating.safety,
            rating.required_safety,
            rating.verdict,
            rating.reason,
            "; ".join(rating.caveats),
            float(rating.damage.sum()),
            rating.life / 3600.0,
            rating.reliability,
            bool(_within(rating, pressure).all()),
        )
        for rating in ratings
    ]
    return _without_empty_reliability(pd.DataFrame(rows, columns=list(RATING_COLUMNS)), ratings)


def _without_empty_reliability(table: pd.DataFrame, ratings: Sequence[FailureRating]) -> pd.DataFrame:
    """Remove the column `reliability` where no rating's material has a Weibull shape."""
    return table if any(rating.has_shape for rating in ratings) else table.drop(columns="reliability")


def _error(rating: FailureRating, pressure: ContactPressure, roots: Mapping[str, RootStress]) -> float:
    """Return the error (Pa) of a rating's stress under its largest load; nan for methods of the standard.

    `pressure` gives it for the contact analysis, `roots` by body for finite elements.
    """
    if rating.method == "contact analysis":
        return pressure.error_at(rating.duty.largest)
    return (
        roots[rating.duty.gear].error_at(rating.duty.largest)
        if rating.method == "finite elements"
        else np.nan
    )


def curve_table(ratings: Sequence[FailureRating]) -> pd.DataFrame:
    """Tabulate the allowed stress of each rating over the number of cycles: its limit times the life
    factor.

    Parameters
    ----------
    ratings : Sequence[FailureRating]
        Ratings of all flanks.

    Returns
    -------
    DataFrame
        Columns as CURVE_COLUMNS; POINTS rows a rating, from the first to the last point of the life
        curve.
    """
    parts = []
    for rating in ratings:
        cycles = np.geomspace(rating.limit.cycles[0], rating.limit.cycles[-1], POINTS)
        columns = (*_subject(rating), cycles, 1e-6 * rating.allowed_stress * rating.limit.factor(cycles))
        parts.append(pd.DataFrame(dict(zip(CURVE_COLUMNS, columns, strict=True))))
    return pd.concat(parts, ignore_index=True)


def damage_table(
    ratings: Sequence[FailureRating], duty: Sequence[DutyBin], pressure: ContactPressure
) -> pd.DataFrame:
    """Tabulate the damage of each rating by bin of the duty cycle, one row a bin that loads the flank.

    The ratings hold torque, stress, cycles and damage of every load; a bin may hold several loads. Torque and
    stress of a row are the largest of its loads, cycles and damage are their sums.

    Parameters
    ----------
    ratings : Sequence[FailureRating]
        Ratings of all flanks, one for each failure and method.
    duty : Sequence[DutyBin]
        Bins of the duty cycle, which give speed and time.
    pressure : ContactPressure
        Range of solved torques; it decides column `within_torques_solved` alone.

    Returns
    -------
    DataFrame
        Columns as DAMAGE_COLUMNS of `facegear.strength.columns`: body, gear, flank, failure, method, bin
        (from 1), torque_n_m (with all load factors), speed_rpm, hours, stress_mpa, cycles, damage,
        within_torques_solved (all loads).
    """
    rows = []
    for rating in ratings:
        within = _within(rating, pressure)
        for number in np.unique(rating.duty.bins):
            is_in_bin = rating.duty.bins == number
            rows.append(
                (
                    *(*_subject(rating), number + 1, float(rating.duty.torque[is_in_bin].max())),
                    *(60.0 * duty[number].speed, duty[number].time / 3600.0),
                    1e-6 * float(rating.stress[is_in_bin].max()),
                    *(float(rating.duty.cycles[is_in_bin].sum()), float(rating.damage[is_in_bin].sum())),
                    bool(within[is_in_bin].all()),
                )
            )
    return pd.DataFrame(rows, columns=list(DAMAGE_COLUMNS))


def _subject(rating: FailureRating) -> tuple[str, ...]:
    """Return the columns that identify a rating: body, gear, flank, failure, method."""
    return rating.duty.body, rating.duty.gear, rating.duty.flank, rating.failure, rating.method


def _within(rating: FailureRating, pressure: ContactPressure) -> np.ndarray:
    """Mark the loads (n,) within the torques of the contact analysis, and those without cycles."""
    return pressure.within(rating.duty.torque) | (rating.duty.cycles == 0.0)


def with_scuffing(safety: pd.DataFrame, spectrum: pd.DataFrame, losses: pd.DataFrame) -> pd.DataFrame:
    """Add SCUFFED_COLUMNS to the table of safety: the worst of all bins and meshes of each flank.

    A flank turns red, with a reason, where its safety against scuffing or micropitting is below 1.
    `within_torques_solved` becomes false where a load of `losses` lies outside.

    Parameters
    ----------
    safety : DataFrame
        Columns as SAFETY_COLUMNS.
    spectrum : DataFrame
        Columns as DUTY_SPECTRUM_COLUMNS; it names the meshes of each flank.
    losses : DataFrame
        A row a bin and loaded flank of stage machine_loss: columns bin, mesh, flank, SCUFFED_COLUMNS and
        within_torques_solved.

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
