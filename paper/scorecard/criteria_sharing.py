"""Criteria on load-sharing coefficients; tables `sharing`, `curves`, `reference`."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pandas as pd

from paper.scorecard.outcome import ClaimOutcome, Tables, number, statement

WINDOWS = ("cycle", "starts")
"""The summary holds the minimum and the maximum mean of these."""
NEARLY_ONE_CARRIER = 0.02
BOUNDS = {"inputs": 2.0, "idlers": 3.0}
"""The coefficient where one mesh of the group carries all."""
Point = str | float
FLAT_SLOPE = 0.1
FLAT_SHARE = 0.05
MAX_UNDEFINED = 0.5
"""A curve that is drawn over the whole cycle is not judged where this share of it or more is undefined: no
mesh of the group carries load there.
"""


def sharing(
    tables: Tables, kind: str, column: str = "mean", study: str = "", point: Point = ""
) -> ClaimOutcome:
    """A column of the load-sharing summary, averaged over the input pinions where kind is inputs; no number
    where the coefficient is undefined for half the cycle or more.

    The mean is also that of single cycles and from other starts.

    Parameters
    ----------
    tables : Tables
        Stored results by name.
    kind : str
        Kind of the group: `inputs` or `idlers`.
    column : str
        Column of the load-sharing summary.
    study : str
        Name of the study.
    point : Point
        Name of the point of the study, empty for any.

    Returns
    -------
    ClaimOutcome
        The number, in the unit of the claim.
    """
    undefined_share = _value(tables, kind, "undefined_fraction", study, point)
    value = _value(tables, kind, column, study, point)
    if undefined_share >= MAX_UNDEFINED:
        return ClaimOutcome(
            None, f"{value:.4g}, but undefined for {100 * undefined_share:.0f} % of the cycle"
        )
    if column != "mean":
        return number(value, 4)
    ends = [_value(tables, kind, f"{of}_{end}", study, point) for of in WINDOWS for end in ("low", "high")]
    return replace(number(value, 4), windows=(float(np.nanmin(ends)), float(np.nanmax(ends))))


def reference(tables: Tables, kind: str, quantity: str, column: str = "mean") -> ClaimOutcome:
    """A static or quasi-static coefficient, averaged over the input pinions where kind is inputs.

    Parameters
    ----------
    tables : Tables
        Stored results by name.
    kind : str
        Kind of the group: `inputs` or `idlers`.
    quantity : str
        Name of the quantity.
    column : str
        Column of the table `reference`.

    Returns
    -------
    ClaimOutcome
        The number, in the unit of the claim.
    """
    frame = tables["reference"]
    rows = frame[(frame["quantity"] == quantity) & (frame["kind"] == kind)]
    return number(rows[column].mean(), 4)


def one_carrier_occurs(tables: Tables, study: str) -> ClaimOutcome:
    """At least one curve of the study, for the inputs as for the idlers, comes within 2 % of its bound
    somewhere in the cycle.

    Parameters
    ----------
    tables : Tables
        Stored results by name.
    study : str
        Name of the study.

    Returns
    -------
    ClaimOutcome
        Whether the statement holds, with the evidence.
    """
    frame = tables["curves"]
    tops = frame[frame["study"] == study].groupby(["kind", "point"])["coefficient"].max()
    bounds = tops.index.get_level_values("kind").map(BOUNDS).to_numpy(float)
    counts_by_kind = (tops > bounds * (1.0 - NEARLY_ONE_CARRIER)).groupby("kind").agg(["sum", "size"])
    text = ", ".join(f"{row.Index} {row.sum} of {row.size}" for row in counts_by_kind.itertuples())
    return statement((counts_by_kind["sum"] > 0).all(), f"curves that reach their maximum: {text}")


def flat_region(tables: Tables, study: str, point: Point, kind: str) -> ClaimOutcome:
    """For at least 5 % of the cycle the coefficient changes by less than 0.1 of its value per cycle and lies
    below its bound, in a curve that is defined for more than half the cycle.

    Parameters
    ----------
    tables : Tables
        Stored results by name.
    study : str
        Name of the study.
    point : Point
        Name of the point of the study.
    kind : str
        Kind of the group: `inputs` or `idlers`.

    Returns
    -------
    ClaimOutcome
        Whether the statement holds, with the evidence.
    """
    curve = _curve(tables, study, point, kind)
    undefined_share = float(np.isnan(curve).mean())
    if undefined_share >= MAX_UNDEFINED:
        return statement(False, f"undefined for {100 * undefined_share:.0f} % of the cycle")
    fraction = _flat_share(curve, BOUNDS[kind] * (1.0 - NEARLY_ONE_CARRIER))
    return statement(fraction >= FLAT_SHARE, f"flat for {100 * fraction:.0f} % of the cycle")


def orders(
    tables: Tables, study: str, kind: str, points: list[Point], column: str = "mean", margin: float = 0.0
) -> ClaimOutcome:
    """The column grows along the listed points of the study, each time by more than the margin.

    Parameters
    ----------
    tables : Tables
        Stored results by name.
    study : str
        Name of the study.
    kind : str
        Kind of the group: `inputs` or `idlers`.
    points : list[Point]
        Names of the points, in the order in which the column grows.
    column : str
        Column of the load-sharing summary.
    margin : float
        Least growth from point to point, dimensionless.

    Returns
    -------
    ClaimOutcome
        Whether the statement holds, with the evidence.
    """
    values = [_value(tables, kind, column, study, point) for point in points]
    return statement(bool((np.diff(values) > margin).all()), _format_points(points, values))


def minimum_at(tables: Tables, study: str, kind: str, point: Point, column: str = "mean") -> ClaimOutcome:
    """Among all points of the study the column has its minimum at the named one; points without a value do
    not count, and the named one must have one.

    Parameters
    ----------
    tables : Tables
        Stored results by name.
    study : str
        Name of the study.
    kind : str
        Kind of the group: `inputs` or `idlers`.
    point : Point
        Name of the point of the study.
    column : str
        Column of the load-sharing summary.

    Returns
    -------
    ClaimOutcome
        Whether the statement holds, with the evidence.
    """
    frame = _study(tables, study)
    points = list(dict.fromkeys(frame["point"]))
    values = [_value(tables, kind, column, study, name) for name in points]
    return statement(_extreme(points, -np.array(values)) == _name(point), _format_points(points, values))


def steeper(tables: Tables, study: str, kind: str, point: Point) -> ClaimOutcome:
    """The curve's RMS slope at the named point exceeds that at every other point of the study; undefined
    instants are left out, and a curve that is undefined for half the cycle or more is not compared.

    Parameters
    ----------
    tables : Tables
        Stored results by name.
    study : str
        Name of the study.
    kind : str
        Kind of the group: `inputs` or `idlers`.
    point : Point
        Name of the point of the study.

    Returns
    -------
    ClaimOutcome
        Whether the statement holds, with the evidence.
    """
    points = list(dict.fromkeys(_study(tables, study)["point"]))
    slopes = [_steepness(_curve(tables, study, name, kind)) for name in points]
    return statement(
        _extreme(points, np.array(slopes)) == _name(point),
        f"rms slope per cycle {_format_points(points, slopes)}",
    )


def differ(tables: Tables, study: str, kind: str, column: str, by: float) -> ClaimOutcome:
    """Between the study's points the column changes by more than the stated amount.

    Parameters
    ----------
    tables : Tables
        Stored results by name.
    study : str
        Name of the study.
    kind : str
        Kind of the group: `inputs` or `idlers`.
    column : str
        Column of the load-sharing summary.
    by : float
        The stated amount, in the unit of the column (of coefficients dimensionless).

    Returns
    -------
    ClaimOutcome
        Whether the statement holds, with the evidence.
    """
    points = list(dict.fromkeys(_study(tables, study)["point"]))
    values = [_value(tables, kind, column, study, name) for name in points]
    finite = [value for value in values if np.isfinite(value)]
    return statement(len(finite) > 1 and max(finite) - min(finite) > by, _format_points(points, values))


def lost_regions_move(tables: Tables, study: str, by: float, kind: str = "") -> ClaimOutcome:
    """Between two points of the study contact is lost at different instants for more than the stated share of
    the cycle, in some group of the kind (of any kind if none is named).

    Parameters
    ----------
    tables : Tables
        Stored results by name.
    study : str
        Name of the study.
    by : float
        The stated share of the cycle, 0 to 1.
    kind : str
        Kind of the group, empty for any.

    Returns
    -------
    ClaimOutcome
        Whether the statement holds, with the evidence.
    """
    frame = tables["curves"]
    rows = frame[(frame["study"] == study) & (frame["kind"].isin([kind]) if kind else True)]
    difference_by_group = {}
    for group, curves in rows.groupby("group", sort=False):
        regions = [
            curve.sort_values("cycle_fraction")["lost_fraction"].to_numpy(float)
            for _, curve in curves.groupby("point", sort=False)
        ]
        difference_by_group[str(group)] = max(float(np.abs(a - b).mean()) for a in regions for b in regions)
    text = ", ".join(f"{group} {100 * value:.0f} %" for group, value in difference_by_group.items())
    return statement(max(difference_by_group.values()) > by, f"different for {text} of the cycle")


def _name(point: Point) -> str:
    """Name of a study's point; a claims file turns names such as 80 into numbers."""
    return f"{point:g}" if isinstance(point, float) else str(point)


def _study(tables: Tables, study: str) -> pd.DataFrame:
    frame = tables["sharing"]
    return frame[frame["study"] == study]


def _value(tables: Tables, kind: str, column: str, study: str, point: Point) -> float:
    frame = tables["sharing"]
    selection = {"study": study, "kind": kind, **({"point": _name(point)} if point else {})}
    rows = np.logical_and.reduce([frame[key].to_numpy(object) == value for key, value in selection.items()])
    if not rows.any():
        raise KeyError(f"no load-sharing result for study {study!r}, point {point!r}, kind {kind!r}")
    values = frame[column].to_numpy(float)[rows]
    return float(np.nanmean(values)) if np.isfinite(values).any() else float("nan")


def _curve(tables: Tables, study: str, point: Point, kind: str) -> np.ndarray:
    """Coefficient over one cycle, shape (samples,), of the group named first."""
    frame = tables["curves"]
    rows = frame[(frame["study"] == study) & (frame["point"] == _name(point)) & (frame["kind"] == kind)]
    first = rows[rows["group"] == rows["group"].iloc[0]].sort_values("cycle_fraction")
    return first["coefficient"].to_numpy(float)


def _slope(curve: np.ndarray) -> np.ndarray:
    """Central difference of a periodic curve, per cycle."""
    return 0.5 * curve.size * (np.roll(curve, -1) - np.roll(curve, 1))


def _steepness(curve: np.ndarray) -> float:
    """RMS slope over the defined instants; NaN where half the cycle or more is undefined."""
    slope = _slope(curve)
    if np.isnan(curve).mean() >= MAX_UNDEFINED:
        return float("nan")
    return float(np.sqrt(np.nanmean(slope**2)))


def _extreme(points: Sequence[str], values: np.ndarray) -> str | None:
    """The point with the largest value, NaN left out; None where there are not two values to compare."""
    if np.isfinite(values).sum() < 2:
        return None
    return points[int(np.nanargmax(values))]


def _flat_share(curve: np.ndarray, below: float) -> float:
    slope = _slope(curve)
    flat = (np.abs(slope) < FLAT_SLOPE * curve) & (curve < below)
    return float(flat.mean())


def _format_points(points: list[Point], values: list[float]) -> str:
    return ", ".join(f"{_name(point)}: {value:.3g}" for point, value in zip(points, values, strict=True))
