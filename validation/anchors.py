"""Public measurements and published numbers beside ours: `python -m validation.anchors`.

Runs the configs of config/anchors, takes the comparisons with published spur gears from the table of
references, and writes the scorecard to docs/measured/anchors.csv, which docs/reference/anchors.md shows.
"""

from collections.abc import Iterator
from math import radians

import numpy as np
import pandas as pd

import facegear
from facegear.gearbox import Gearbox
from validation.references import REFERENCES, ROOT

CONFIGS = ROOT / "config" / "anchors"
TABLE = ROOT / "docs" / "measured" / "anchors.csv"
COLUMNS = ("source", "quantity", "claimed", "ours", "verdict", "not_known")
KRANTZ = "Krantz and Delgado 1996, ADA314767, abstract"
WINDOWS_RAD = {"box 1": 0.0007, "box 2": 0.0009}
"""Half the range of clocking in which no path carried more than LARGEST_SHARE of 367 N m, as measured."""
LARGEST_SHARE = 0.53
SCALE_SOURCE = "Handschuh, Lewicki and Bossler 1992, NASA TM-105434, abstract"
PUBLISHED = {"FZG type C": "FZG type C gears", "GEARpie": "C40 gears, report of GEARpie"}
"""Names of the sources of published spur gears, by words in the table of references."""
Row = tuple[str, str, str, str, str, str]


def split_path() -> Gearbox:
    """Return the face gear split path of the anchor.

    Returns
    -------
    Gearbox
        The machine.
    """
    return facegear.load(CONFIGS / "split_path.yaml", None)


def shares(gearbox: Gearbox, clocking_deg: float) -> np.ndarray:
    """Return the fractions of the input's torque that go to the lower and the upper gear, at rest.

    Parameters
    ----------
    gearbox : Gearbox
        The machine.
    clocking_deg : float
        Clocking, deg.

    Returns
    -------
    (2,) array
        Fractions.
    """
    values = {"transmission.single_pinions": {"input": {"clocking_deg": clocking_deg}}}
    table = gearbox.with_values(values).statics().table().set_index("mesh")
    torques = table.loc[["input/lower", "input/upper"], "pinion_torque_n_m"].to_numpy(float)
    return torques / torques.sum()


def clocking_window(gearbox: Gearbox) -> tuple[float, float]:
    """Return the clocking of even shares, and half the range in which no path has more than LARGEST_SHARE.

    Shares at rest are linear in the clocking as long as no mesh opens. The upper end of the range lies past
    what the backlash of the unloaded gears takes up, where a config is refused.

    Parameters
    ----------
    gearbox : Gearbox
        The machine.

    Returns
    -------
    float, float
        Clocking and half range, rad.
    """
    low, high = 0.1, 0.2
    rise = (shares(gearbox, high)[0] - shares(gearbox, low)[0]) / radians(high - low)
    even = radians(low) + (0.5 - shares(gearbox, low)[0]) / rise
    return float(even), float((LARGEST_SHARE - 0.5) / abs(rise))


def clocking_rows() -> Iterator[Row]:
    """Yield the effect of clocking on a split path.

    Yields
    ------
    Row
        One claim.
    """
    even, half = clocking_window(split_path())
    not_known = "teeth, shafts and bearings of the tested gearboxes, which had no face gears"
    yield (
        *(KRANTZ, "clocking makes the shares even", "yes", f"yes, at {even:.4f} rad"),
        *("agrees", not_known),
    )
    for box, half_range in WINDOWS_RAD.items():
        yield (
            *(KRANTZ, f"{box}: half the range of clocking with at most 53 % in a path at 367 N m, rad"),
            *(f"{half_range}", f"{half:.2g}", "same order; another machine, so no more is said", not_known),
        )


def similarity_rows() -> Iterator[Row]:
    """Yield the stresses of gears at half scale and one eighth of the power over those at full scale.

    Yields
    ------
    Row
        One claim.
    """
    full, half = (facegear.load(CONFIGS / f"{name}_scale.yaml", None) for name in ("full", "half"))
    pressure = [gearbox.contact().table()["pressure_mpa"].max() for gearbox in (full, half)]
    stress = [gearbox.root_stress().table().groupby("body")["largest_mpa"].max() for gearbox in (full, half)]
    ratios = {"pressure": pressure[1] / pressure[0]}
    ratios |= {
        f"root stress, {str(body).replace('_', ' ')}": stress[1][body] / stress[0][body]
        for body in stress[0].index
    }
    for quantity, ratio in ratios.items():
        yield (
            *(SCALE_SOURCE, f"{quantity}: half scale over full scale", "slightly above 1", f"{ratio:.6f}"),
            "undecided: exact similarity gives 1, and the abstract gives no number",
            "the tested teeth, and what was not scaled with them",
        )


def published_rows() -> Iterator[Row]:
    """Yield published spur gears, as the tests compare with them.

    Yields
    ------
    Row
        One claim.
    """
    references = pd.read_csv(REFERENCES)
    for words, source in PUBLISHED.items():
        for row in references[references["source"].str.contains(words)].itertuples():
            near = abs(row.computed - row.expected) <= row.tolerance
            verdict = f"within {100 * row.tolerance / abs(row.expected):.2g} %" if near else "differs"
            yield (source, row.quantity, f"{row.expected:.6g}", f"{row.computed:.6g}", verdict, "")


def scorecard() -> pd.DataFrame:
    """Tabulate all claims.

    Returns
    -------
    DataFrame
        Columns COLUMNS, one row a claim.
    """
    rows = [*clocking_rows(), *similarity_rows(), *published_rows()]
    return pd.DataFrame(rows, columns=list(COLUMNS))


def main() -> None:
    """Write the scorecard and print it."""
    table = scorecard()
    table.to_csv(TABLE, index=False)
    print(table.to_string(index=False))


if __name__ == "__main__":
    main()
