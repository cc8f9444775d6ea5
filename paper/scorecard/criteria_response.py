"""Criteria on the response at the nominal speed; tables `response` and `spectrum` of the dynamics."""

import numpy as np
import pandas as pd

from facegear.arrays import Array
from paper.scorecard.outcome import ClaimOutcome, Tables, number, statement

SIDES = ("lower", "upper")
WINDOW_LINES = 2
"""Lines on each side over which the Hann window of an irregular motion spreads a line."""
FINE = 1.0 / 64.0
"""Spectra with lines closer than this many orders are those of irregular motions, taken with a window: no
periodic motion looked for is as long."""


def synchronous(tables: Tables, a: str, b: str, lower: float) -> ClaimOutcome:
    """On both sides the deflections of the two pinions correlate by at least the stated value.

    Parameters
    ----------
    tables : Tables
        Stored results by name.
    a : str
        Name of a pinion.
    b : str
        Name of the other pinion.
    lower : float
        Least correlation, dimensionless.

    Returns
    -------
    ClaimOutcome
        Whether the statement holds, with the evidence.
    """
    values = [_correlation(tables, f"{a}/{side}", f"{b}/{side}") for side in SIDES]
    return statement(min(values) >= lower, _sides(values))


def not_synchronous(tables: Tables, a: str, b: list[str], upper: float) -> ClaimOutcome:
    """On at least one side the deflection of the pinion correlates below the stated value with each other.

    Parameters
    ----------
    tables : Tables
        Stored results by name.
    a : str
        Name of a pinion.
    b : list[str]
        Names of the other pinions.
    upper : float
        Largest correlation, dimensionless.

    Returns
    -------
    ClaimOutcome
        Whether the statement holds, with the evidence.
    """
    values = {
        pinion: min(_correlation(tables, f"{a}/{side}", f"{pinion}/{side}") for side in SIDES) for pinion in b
    }
    text = ", ".join(f"with {pinion} {value:z.2f}" for pinion, value in values.items())
    return statement(max(values.values()) <= upper, text)


def sides_not_synchronous(tables: Tables, upper: float) -> ClaimOutcome:
    """The deflections of a pinion's lower and upper mesh correlate below the value, for every pinion.

    Parameters
    ----------
    tables : Tables
        Stored results by name.
    upper : float
        Largest correlation, dimensionless.

    Returns
    -------
    ClaimOutcome
        Whether the statement holds, with the evidence.
    """
    pinions = dict.fromkeys(mesh.rsplit("/", 1)[0] for mesh in _meshes(tables))
    values = {name: _correlation(tables, f"{name}/lower", f"{name}/upper") for name in pinions}
    text = ", ".join(f"{name} {value:z.2f}" for name, value in values.items())
    return statement(max(values.values()) <= upper, text)


def dominant_lines(tables: Tables, pinion: str, lines: list[float]) -> ClaimOutcome:
    """On both sides the largest spectral lines, as many as are listed, stand at the listed orders.

    Parameters
    ----------
    tables : Tables
        Stored results by name.
    pinion : str
        Name of the pinion.
    lines : list[float]
        Orders of the mesh frequency, dimensionless.

    Returns
    -------
    ClaimOutcome
        Whether the statement holds, with the evidence.
    """
    strongest = [_strongest(tables, f"{pinion}/{side}", len(lines)) for side in SIDES]
    holds = all(sorted(orders) == sorted(lines) for orders in strongest)
    return statement(holds, _sides(["+".join(f"{order:g}x" for order in orders) for orders in strongest]))


def line_larger(tables: Tables, pinion: str, line: float, fraction: float) -> ClaimOutcome:
    """The line at the stated order is larger on the upper side than on the lower one, by at least the stated
    share of the upper side's line at 1x.

    Parameters
    ----------
    tables : Tables
        Stored results by name.
    pinion : str
        Name of the pinion.
    line : float
        Order of the mesh frequency, dimensionless.
    fraction : float
        Share of the line at 1x, dimensionless.

    Returns
    -------
    ClaimOutcome
        Whether the statement holds, with the evidence.
    """
    values = [_amplitude(tables, f"{pinion}/{side}", line) for side in SIDES]
    threshold = fraction * _amplitude(tables, f"{pinion}/upper", 1.0)
    return statement(
        values[1] - values[0] >= threshold > 0.0, _sides([f"{value:.3g} um" for value in values])
    )


def subharmonic_content(tables: Tables, pinion: str, fraction: float) -> ClaimOutcome:
    """On both sides some line below 1x has at least the stated share of the line at 1x.

    The lines beside the mean and beside 1x are not counted where the spectrum is that of an irregular motion:
    its window spreads every line over the two beside it.

    Parameters
    ----------
    tables : Tables
        Stored results by name.
    pinion : str
        Name of the pinion.
    fraction : float
        Share of the line at 1x, dimensionless.

    Returns
    -------
    ClaimOutcome
        Whether the statement holds, with the evidence.
    """
    shares = [_below(tables, f"{pinion}/{side}") for side in SIDES]
    return statement(min(shares) >= fraction, _sides([f"{100 * value:.0f} % of 1x" for value in shares]))


def lost_contact(tables: Tables) -> ClaimOutcome:
    """At the nominal speed some mesh is out of contact for part of the time.

    Parameters
    ----------
    tables : Tables
        Stored results by name.

    Returns
    -------
    ClaimOutcome
        Whether the statement holds, with the evidence.
    """
    frame = tables["sharing"]
    fraction = float(frame.loc[frame["study"] == "nominal", "lost_fraction"].max())
    return statement(fraction > 0.0, f"up to {100 * fraction:.0f} % of the time")


def mesh_period(tables: Tables) -> ClaimOutcome:
    """Mesh period at the nominal speed.

    Parameters
    ----------
    tables : Tables
        Stored results by name.

    Returns
    -------
    ClaimOutcome
        The number, in the unit of the claim.
    """
    curve = tables["curves"]
    rows = curve[(curve["study"] == "nominal") & (curve["cycle_fraction"] > 0.0)]
    return number(float((rows["time_s"] / rows["cycle_fraction"]).iloc[0]))


def _meshes(tables: Tables) -> list[str]:
    return list(dict.fromkeys(tables["spectrum"]["mesh"]))


def _lines(tables: Tables, mesh: str) -> pd.DataFrame:
    frame = tables["spectrum"]
    rows = frame[frame["mesh"] == mesh]
    if rows.empty:
        raise KeyError(f"no spectrum of {mesh}")
    return rows


def _amplitude(tables: Tables, mesh: str, order: float) -> float:
    """Largest amplitude within 0.02 of an order, um; 0 where the spectrum has no such line."""
    rows = _lines(tables, mesh)
    close = rows[(rows["order"] - order).abs() < 0.02]["amplitude_um"]
    return float(close.max()) if len(close) else 0.0


def _below(tables: Tables, mesh: str) -> float:
    """Largest amplitude strictly between the mean and 1x over that at 1x; 0 where there is none."""
    rows = _lines(tables, mesh)
    orders = np.sort(rows["order"].to_numpy(float))
    spread = WINDOW_LINES * orders[1] if orders[1] < FINE else 0.0
    inside = rows[(rows["order"] > spread + 1e-9) & (rows["order"] < 1.0 - spread - 1e-9)]["amplitude_um"]
    return float(inside.max()) / _amplitude(tables, mesh, 1.0) if len(inside) else 0.0


def _strongest(tables: Tables, mesh: str, count: int) -> list[float]:
    """Orders of the largest lines, rounded to quarters; the mean is left out."""
    rows = _lines(tables, mesh)
    rows = rows[rows["order"] > 0.02].sort_values("amplitude_um", ascending=False)
    orders = (rows["order"] * 4.0).round() / 4.0
    return list(dict.fromkeys(orders))[:count]


def _correlation(tables: Tables, first: str, second: str) -> float:
    frame = tables["response"]
    values: list[Array] = [
        frame.loc[frame["mesh"] == mesh, "deflection_um"].to_numpy(float) for mesh in (first, second)
    ]
    if not values[0].size or values[0].size != values[1].size:
        raise KeyError(f"no response of {first} and {second}")
    return float(np.corrcoef(values[0], values[1])[0, 1])


def _sides(values: list[float] | list[str]) -> str:
    texts = [f"{value:z.2f}" if isinstance(value, float) else value for value in values]
    return f"lower {texts[0]}, upper {texts[1]}"
