"""What to keep in mind about the numbers of a report."""

from collections.abc import Iterator, Mapping
from math import nan
from typing import Any

import pandas as pd

from facegear.contact.columns import FILLET_CONTACT
from facegear.contact.hertz import DENTED
from facegear.geometry.design import BACKLASH_DIFFERS_UM
from facegear.report.machine import BALANCED, nominal, rated
from facegear.report.page import number

POSITIONS_MATTER = 0.05
"""Relative change of a peak-to-peak value with half of the positions that is worth a warning."""


def warnings(
    values: Mapping[str, Any], tables: Mapping[str, pd.DataFrame], pair: Mapping[str, Any] | None
) -> Iterator[tuple[str, str]]:
    """Subject and what to keep in mind, from the config and the results."""
    if pair is not None and pair["interference"]:
        yield (
            "teeth",
            "the bodies interfere: the loaded contact counts the load in the fillets but gives no pressure "
            "there and no mean stiffness; all that follows without contact leaves the interference out",
        )
    yield from _contact_warnings(values, tables)
    yield from _beyond_warnings(tables)
    transmission = values["transmission"]
    if transmission is None:
        return
    if pair is not None:
        own, teeth = transmission["backlash_um"], pair["backlash_um"]["smallest"]
        if own is not None and abs(own - teeth) > BACKLASH_DIFFERS_UM:
            yield "backlash", f"the dynamics take {own:g} um, the teeth as assembled have {teeth:.1f} um"
    missing = rated(tables).get("power_imbalance", 0.0)
    if abs(missing) > BALANCED:
        yield (
            "power",
            f"power brought in, less power taken out, is {100 * missing:.3g} % of the larger: lever arms as "
            "printed are not those of the teeth",
        )
    yield from _undecided_warnings(tables)
    yield from _open_warnings(tables)
    yield from _sweep_warnings(tables)
    for row in nominal(tables).itertuples():
        if row.lost_fraction > 0.0:
            yield (
                f"load sharing, {row.group}",
                f"a path is out of contact {100 * row.lost_fraction:.0f} % of the time",
            )
        if not str(row.motion).startswith("period-"):
            yield f"load sharing, {row.group}", f"the motion is {row.motion}: numbers are averages"


def _beyond_warnings(tables: Mapping[str, pd.DataFrame]) -> Iterator[tuple[str, str]]:
    """Numbers that were taken from beyond what was solved, or where a model holds."""
    for about, name, rows in (
        ("strength", "rating", "ratings"),
        ("stress over speed", "stress_over_speed", "motions and speeds"),
        ("friction", "mesh_losses", "losses of a flank"),
    ):
        table = tables.get(name, pd.DataFrame())
        if len(table) and not table["within_torques_solved"].all():
            outside = int((~table["within_torques_solved"].astype(bool)).sum())
            yield (
                about,
                f"{outside} of {len(table)} {rows} lie outside the torques of the contact analysis "
                f"(contact.torques_n_m)",
            )
    for row in tables.get("limits", pd.DataFrame()).itertuples():
        if row.loss_outside_percent > 0.0:
            yield (
                "friction",
                f"{number(row.loss_outside_percent, 2)} % of the loss at {row.torque_n_m:g} N m lies outside "
                f"the limits of {row.friction_model}: {row.limit}",
            )


def _undecided_warnings(tables: Mapping[str, pd.DataFrame]) -> Iterator[tuple[str, str]]:
    """Contacts of which the modes do not know whether they carry."""
    contacts = tables.get("contacts", pd.DataFrame(columns=["contact", "state"]))
    names = contacts.loc[contacts["state"] == "undecided", "contact"]
    if len(names):
        yield "modes", f"too little load to tell from rounding, taken as open: {', '.join(names)}"


def _open_warnings(tables: Mapping[str, pd.DataFrame]) -> Iterator[tuple[str, str]]:
    """Meshes that carry nothing at rest."""
    if "meshes" not in tables:
        return
    open_ones = tables["meshes"].loc[tables["meshes"]["flank"] == "open", "mesh"]
    if len(open_ones):
        yield "meshes at rest", f"no load at {', '.join(open_ones)}"


def _sweep_warnings(tables: Mapping[str, pd.DataFrame]) -> Iterator[tuple[str, str]]:
    """Speeds of the sweep without a periodic motion, and meshes out of contact."""
    if "sweep" not in tables:
        return
    sweep = tables["sweep"]
    motions = sweep.drop_duplicates(["direction", "speed_rpm"])
    irregular = ~motions["periodic"].astype(bool)
    if irregular.any():
        yield (
            "speed sweep",
            f"the motion is not periodic at {irregular.sum()} of {len(motions)} speeds, up and down counted "
            "apart: numbers there are averages",
        )
    gaps = sweep[sweep["quantity"] == "open_fraction"].groupby("body_or_mesh", sort=False)["value"]
    min_open, max_open = gaps.min(), gaps.max()
    if (always := min_open.index[min_open >= 1.0]).size:
        yield "speed sweep", f"open at every speed: {', '.join(always)}"
    lost = max_open.index[(max_open > 0.0) & (min_open < 1.0)]
    if lost.size:
        time = f"up to {number(100 * max_open[lost].max(), 2)} % of the time"
        yield "speed sweep", f"contact is lost at some speeds, {time}: {', '.join(lost)}"


def _contact_warnings(
    values: Mapping[str, Any], tables: Mapping[str, pd.DataFrame]
) -> Iterator[tuple[str, str]]:
    if values["mesh_stiffness"]["source"] == "fem_scaled":
        yield "mesh stiffness", "only its shape is computed; its mean is given (mesh_stiffness.mean_n_per_m)"
    if "ltca" in tables:
        columns = ["tip_line_load_n_per_mm", "tip_length_mm"]
        tips = tables["ltca"].groupby("torque_n_m")[columns].max()
        loaded = tips[tips["tip_length_mm"] > 0.0]
        if len(loaded):
            load, length = loaded.max()
            yield (
                "contact",
                f"from {loaded.index[0]:g} N m on tip edges carry load, up to {load:.0f} N/mm over "
                f"{length:.1f} mm; pressure at a sharp edge has no limit: tip relief or a chamfer takes "
                "the load off the pinion's, root relief off the gear's",
            )
    if "by_torque" not in tables:
        return
    by_torque = tables["by_torque"]
    for row in by_torque[by_torque["fillet_share"] >= FILLET_CONTACT].itertuples():
        yield (
            f"contact at {row.torque_n_m:g} N m",
            f"tips press into fillets and carry up to {100 * row.fillet_share:.1f} % of the torque there, "
            "which is kept out of pressure and root stress",
        )
    pressed = by_torque.get("pressure_mpa", pd.Series(nan, by_torque.index))
    for row in by_torque[1e6 * pressed > DENTED].itertuples():
        yield (
            f"contact at {row.torque_n_m:g} N m",
            f"a pressure of {row.pressure_mpa:.0f} MPa: from {1e-6 * DENTED:.0f} MPa on even hardened steel "
            "yields (ISO 76), and elastic contact does not hold",
        )
    change = 1.0 - by_torque["ste_peak_to_peak_half_um"] / by_torque["ste_peak_to_peak_um"]
    for row in by_torque[change > POSITIONS_MATTER].itertuples():
        yield (
            f"contact at {row.torque_n_m:g} N m",
            f"peak-to-peak transmission error {row.ste_peak_to_peak_um:.2f} um, "
            f"{row.ste_peak_to_peak_half_um:.2f} with half of the positions: more of them may change it",
        )
    if "meshes" in tables:
        largest, solved = tables["meshes"]["pinion_torque_n_m"].abs().max(), by_torque["torque_n_m"].max()
        if largest > solved * (1.0 + BALANCED):
            yield (
                "contact",
                f"a mesh carries {largest:.0f} N m at rest, contact was solved up to {solved:g} N m",
            )
