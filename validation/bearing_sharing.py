"""Which rolling bearings give which load sharing: `python -m validation.bearing_sharing`.

The machine of config/bearings.yaml is put on other bearings, at several torques, and through its hunting
cycle at rest. Springs of the paper's stiffness stand beside them.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pandas as pd

from facegear.errors import ConfigError
from facegear.gearbox import Gearbox, load

ROOT = Path(__file__).parents[1]
CONFIG = ROOT / "config" / "bearings.yaml"
TABLE = ROOT / "docs" / "measured" / "bearing_sharing.csv"
TORQUES = (200.0, 600.0, 1000.0)
"""Torques of each input pinion, N m."""
SPRING = 6.5e7
"""Radial bearing stiffness of the paper's pinions, N/m."""
COLUMNS = (
    *("bearings", "torque_n_m", "input_stiffness_n_per_um", "idler_stiffness_n_per_um"),
    *("k_gamma_inputs", "k_gamma_idlers", "l10r_hours"),
)
"""Columns of the table: tangent stiffness of the seats along x, largest K_gamma of each kind of group, and
life of all bearings together at 3000 rpm; nan where a bearing is overloaded or there are springs."""


def shaft_bearings(ball_um: float, roller_um: float) -> list[dict[str, Any]]:
    """Return a deep groove ball bearing 6210 and a cylindrical roller bearing NU 210 as the config has them.

    Parameters
    ----------
    ball_um, roller_um : float
        Diametral clearances in operation, um.

    Returns
    -------
    list of dict
        Values of `bearings` of a shaft.
    """
    return [
        {"at_mm": 10, "rolling": {"card": "deep_groove_6210", "clearance_diametral_um": ball_um}},
        {"at_mm": 120, "rolling": {"card": "cylindrical_roller_nu210", "clearance_diametral_um": roller_um}},
    ]


def pair(card: str, preload_um: float = 0.0, **values: Any) -> dict[str, Any]:
    """Return two equal bearings in an O arrangement with a preload.

    Parameters
    ----------
    card : str
        Card of both bearings.
    preload_um : float
        Preload of the pair, um; 0 for none.
    **values : Any
        Further keys of both bearings.

    Returns
    -------
    dict
        Values of a shaft's `bearings` and `preload`.
    """
    is_angular = card.startswith("angular")
    ways = [{"loaded_by": way} if is_angular else {} for way in ("+z", "-z")]
    bearings = [
        {"at_mm": at, "rolling": {"card": card, **values, **way}}
        for at, way in zip((10, 120), ways, strict=True)
    ]
    preload = {"bearings": ["A", "B"], "axial_um": preload_um} if preload_um else None
    return {"bearings": bearings, "preload": preload}


SETS: dict[str, dict[str, Any]] = {
    "6210 and NU 210, without clearance": {"bearings": shaft_bearings(0.0, 0.0)},
    "6210 and NU 210, 15 and 30 um": {"bearings": shaft_bearings(15.0, 30.0)},
    "6210 and NU 210, 45 and 70 um": {"bearings": shaft_bearings(45.0, 70.0)},
    "two 6210, 15 um": pair("deep_groove_6210", clearance_diametral_um=15.0),
    "two 6305, 15 um": pair("deep_groove_6305", clearance_diametral_um=15.0),
    "two 7208, preload 8 um": pair("angular_contact_7208", 8.0),
}
"""Bearings of every shaft by the words of the table."""
SPRINGS = "springs of 65 N/um"
"""Words of the rows with springs."""


def machines() -> dict[str, Gearbox]:
    """Return the machine on each set of bearings.

    Returns
    -------
    dict of str to Gearbox
        By the words of the table.
    """
    base = load(CONFIG)
    shafts = base.values["transmission"]["shafts"]
    boxes = {
        words: base.with_values(
            {"transmission.shafts": {name: with_bearings(shaft, changes) for name, shaft in shafts.items()}}
        )
        for words, changes in SETS.items()
    }
    springs = {"x": SPRING, "y": SPRING, "z": 0.0}
    boxes[SPRINGS] = base.with_values(
        {"transmission.shafts": {}, "transmission.pinion.bearing_stiffness_n_per_m": springs}
    )
    return boxes


def with_bearings(shaft: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """Return the values of a shaft with other bearings.

    Parameters
    ----------
    shaft : mapping
        Plain values of a shaft.
    changes : mapping
        Values of `bearings` and `preload`.

    Returns
    -------
    dict
        The new values.
    """
    return {**shaft, "preload": None, **changes}


def sharing_row(words: str, box: Gearbox, torque: float) -> tuple[object, ...]:
    """Return a row of the table.

    Parameters
    ----------
    words : str
        Name of the bearings.
    box : Gearbox
        Machine on them.
    torque : float
        Torque of each input pinion, N m.

    Returns
    -------
    tuple
        Values of COLUMNS.
    """
    at_torque = box.with_values({"transmission.torque.per_input_n_m": torque})
    groups = at_torque.hunting().content["groups"]
    factors = [float(groups.loc[groups["kind"] == kind, "k_gamma"].max()) for kind in ("inputs", "idlers")]
    if words == SPRINGS:
        return (words, torque, 1e-6 * SPRING, 1e-6 * SPRING, *factors, float("nan"))
    seats = at_torque.shafts().table().set_index("pinion")["stiffness_x_n_per_m"]
    stiffness = [1e-6 * float(seats[name]) for name in ("right input", "right idler")]
    try:
        life = at_torque.bearing_life().table()["l10r_hours"].iloc[-1]
    except ConfigError:
        life = float("nan")
    return (words, torque, *stiffness, *factors, float(life))


def sharing_table() -> pd.DataFrame:
    """Compute all rows.

    Returns
    -------
    pd.DataFrame
        COLUMNS.
    """
    rows = [sharing_row(words, box, torque) for words, box in machines().items() for torque in TORQUES]
    return pd.DataFrame(rows, columns=list(COLUMNS))


def page_table(table: pd.DataFrame) -> str:
    """Return the table as a page shows it.

    Parameters
    ----------
    table : pd.DataFrame
        Stored table.

    Returns
    -------
    str
        Markdown; a life that is not known is empty.
    """
    lines = [
        "| bearings of every shaft | torque of an input, N m | stiffness of inputs, N/um | of idlers, N/um "
        "| K_gamma of inputs | of idlers | L10r of all, h |",
        "|---|---|---|---|---|---|---|",
    ]
    for row in table.itertuples():
        life = "" if pd.isna(row.l10r_hours) else f"{float(f'{row.l10r_hours:.3g}'):,g}"
        lines.append(
            f"| {row.bearings} | {row.torque_n_m:g} | {row.input_stiffness_n_per_um:.0f} "
            f"| {row.idler_stiffness_n_per_um:.0f} | {row.k_gamma_inputs:.3f} | {row.k_gamma_idlers:.3f} "
            f"| {life} |"
        )
    return "\n".join(lines)


if __name__ == "__main__":
    sharing_table().to_csv(TABLE, index=False, float_format="%.7g", lineterminator="\n")
