"""Criteria on load-sharing coefficients; tables `sharing`, `curves`, `reference`."""

import numpy as np
import pandas as pd

from facegear.paper.scorecard.outcome import Outcome, Tables, number, statement

NEARLY_ONE_CARRIER = 0.02
Point = str | float
FLAT_SLOPE = 0.1
FLAT_SHARE = 0.05


def sharing(tables: Tables, kind: str, column: str = "mean", study: str = "", point: Point = "") -> Outcome:
    """A column of the load-sharing summary, averaged over the input pinions where kind is inputs."""
    return number(_value(tables, kind, column, study, point), 4)


def reference(tables: Tables, kind: str, quantity: str, column: str = "mean") -> Outcome:
    """A static or quasi-static coefficient, averaged over the input pinions where kind is inputs."""
    frame = tables["reference"]
    rows = frame[(frame["quantity"] == quantity) & (frame["kind"] == kind)]
    return number(rows[column].mean(), 4)


def one_carrier_occurs(tables: Tables, study: str) -> Outcome:
    """At every point of the study the coefficient comes within 2 % of its bound somewhere in the cycle."""
    frame = tables["curves"]
    rows = frame[frame["study"] == study]
    tops = rows.groupby(["kind", "point"])["coefficient"].max()
    bounds = tops.index.get_level_values("kind").map({"inputs": 2.0, "idlers": 3.0}).to_numpy(float)
    reached = tops.to_numpy() > bounds * (1.0 - NEARLY_ONE_CARRIER)
    return statement(reached.all(), f"{reached.sum()} of {reached.size} curves reach their maximum")


def flat_region(tables: Tables, study: str, point: Point, kind: str) -> Outcome:
    """For at least 5 % of the cycle the coefficient changes by less than 0.1 of its value per cycle."""
    share = _flat_share(_curve(tables, study, point, kind))
    return statement(share >= FLAT_SHARE, f"flat for {100 * share:.0f} % of the cycle")


def orders(
    tables: Tables, study: str, kind: str, points: list[Point], column: str = "mean", margin: float = 0.0
) -> Outcome:
    """The column grows along the listed points of the study, each time by more than the margin."""
    values = [_value(tables, kind, column, study, point) for point in points]
    return statement(bool((np.diff(values) > margin).all()), _listed(points, values))


def lowest_at(tables: Tables, study: str, kind: str, point: Point, column: str = "mean") -> Outcome:
    """Among all points of the study the column is lowest at the named one."""
    frame = _study(tables, study)
    points = list(dict.fromkeys(frame["point"]))
    values = [_value(tables, kind, column, study, name) for name in points]
    return statement(points[int(np.argmin(values))] == _name(point), _listed(points, values))


def steeper(tables: Tables, study: str, kind: str, point: Point) -> Outcome:
    """The curve's RMS slope at the named point exceeds that at every other point of the study."""
    points = list(dict.fromkeys(_study(tables, study)["point"]))
    slopes = [float(np.sqrt(np.mean(_slope(_curve(tables, study, name, kind)) ** 2))) for name in points]
    return statement(
        points[int(np.argmax(slopes))] == _name(point), f"rms slope per cycle {_listed(points, slopes)}"
    )


def differ(tables: Tables, study: str, kind: str, column: str, by: float) -> Outcome:
    """Between the study's points the column changes by more than the stated amount."""
    points = list(dict.fromkeys(_study(tables, study)["point"]))
    values = [_value(tables, kind, column, study, name) for name in points]
    return statement(max(values) - min(values) > by, _listed(points, values))


def lost_regions_move(tables: Tables, study: str, by: float, kind: str = "") -> Outcome:
    """Between two points of the study contact is lost at different instants for more than the stated share of
    the cycle, in some group of the kind (of any kind if none is named).
    """
    frame = tables["curves"]
    rows = frame[(frame["study"] == study) & (frame["kind"].isin([kind]) if kind else True)]
    moved = {}
    for group, curves in rows.groupby("group", sort=False):
        regions = [
            curve.sort_values("cycle_fraction")["lost_share"].to_numpy(float)
            for _, curve in curves.groupby("point", sort=False)
        ]
        moved[str(group)] = max(float(np.abs(a - b).mean()) for a in regions for b in regions)
    shown = ", ".join(f"{group} {100 * value:.0f} %" for group, value in moved.items())
    return statement(max(moved.values()) > by, f"different for {shown} of the cycle")


def _name(point: Point) -> str:
    """Name of a study's point; a claims file turns names such as 80 into numbers."""
    return f"{point:g}" if isinstance(point, float) else str(point)


def _study(tables: Tables, study: str) -> pd.DataFrame:
    frame = tables["sharing"]
    return frame[frame["study"] == study]


def _value(tables: Tables, kind: str, column: str, study: str, point: Point) -> float:
    frame = tables["sharing"]
    rows = frame[(frame["study"] == study) & (frame["kind"] == kind)]
    if point:
        rows = rows[rows["point"] == _name(point)]
    if rows.empty:
        raise KeyError(f"no load-sharing result for study {study!r}, point {point!r}, kind {kind!r}")
    return float(rows[column].mean())


def _curve(tables: Tables, study: str, point: Point, kind: str) -> np.ndarray:
    """Coefficient over one cycle, shape (samples,), of the group named first."""
    frame = tables["curves"]
    rows = frame[(frame["study"] == study) & (frame["point"] == _name(point)) & (frame["kind"] == kind)]
    first = rows[rows["group"] == rows["group"].iloc[0]].sort_values("cycle_fraction")
    return first["coefficient"].to_numpy(float)


def _slope(curve: np.ndarray) -> np.ndarray:
    """Central difference of a periodic curve, per cycle."""
    return 0.5 * curve.size * (np.roll(curve, -1) - np.roll(curve, 1))


def _flat_share(curve: np.ndarray) -> float:
    slope = _slope(curve)
    flat = np.abs(slope) < FLAT_SLOPE * curve
    return float(flat[np.isfinite(slope)].mean())


def _listed(points: list[Point], values: list[float]) -> str:
    return ", ".join(f"{_name(point)}: {value:.3g}" for point, value in zip(points, values, strict=True))
