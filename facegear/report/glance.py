"""The report's first screen: machine drawing, key numbers, verdicts and warnings."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from math import nan
from typing import Any

import pandas as pd

from facegear.contact.columns import FILLET_CONTACT
from facegear.contact.hertz import DENTED
from facegear.geometry.design import BACKLASH_DIFFERS_UM
from facegear.report.machine import BALANCED, key_numbers, rated
from facegear.report.page import Chapter, Picture, Table, scientific

POSITIONS_MATTER = 0.05
"""Relative change of a peak-to-peak value with half of the positions that is worth a warning."""
LISTED = 6
"""Names that a warning lists at most."""


def glance_chapter(
    values: Mapping[str, Any],
    tables: Mapping[str, pd.DataFrame],
    drawing: Sequence[Picture],
    pair: Mapping[str, Any] | None,
) -> Chapter:
    """What is read first, from the same inputs as the whole report; `drawing` shows the machine."""
    listed = []
    for caption, rows in (("Verdicts", verdicts(tables, pair)), ("Warnings", warnings(values, tables, pair))):
        listed.append(Table(caption, pd.DataFrame(list(rows), columns=["about", "what was found"])))
    numbers = key_numbers(tables, pair)
    first = [] if numbers.empty else [Table("Key numbers", numbers)]
    return Chapter("At a glance", "", drawing, [*first, *listed])


def verdicts(tables: Mapping[str, pd.DataFrame], pair: Mapping[str, Any] | None) -> Iterator[tuple[str, str]]:
    """Subject and finding, in the order of computation."""
    if pair is not None:
        gap = pair["interference"] or pair["smallest_gap"]
        parts = f"gear {gap['gear_part']} against pinion {gap['pinion_part']}"
        where = f"{parts}, radius {gap['gear_radius_mm']:.1f} mm"
        state = "interference" if pair["interference"] else "free; smallest gap beside the contact"
        yield "teeth", f"{state} {gap['gap_um']:.1f} um ({where})"
    for row in tables.get("by_torque", pd.DataFrame()).itertuples():
        mean = row.k_average_mean_n_per_m
        known = f"mean stiffness {scientific(mean, 4)} N/m" if mean == mean else "no mean stiffness"
        error = f"peak-to-peak transmission error {row.ste_peak_to_peak_um:.2f} um"
        yield f"contact at {row.torque_n_m:g} N m", f"{known}, {error}{_pressure(row)}"
    for row in _nearest(tables.get("rating")).itertuples():
        yield (
            f"{row.body.replace('_', ' ')}, {row.flank} flank, {row.failure} ({row.method})",
            f"{row.verdict}: safety {row.safety:.2f} where {row.required:g} is required"
            f"{'; ' + row.reason if row.reason else ''}"
            f"{'' if row.within_torques_solved else '; outside the torques of the contact analysis'}",
        )
    yield from _lubricated(tables.get("mesh_losses"))
    for row in _nominal(tables).itertuples():
        width = f" ± {row.half_width:.2f}" if row.half_width > 0.005 else ""
        yield f"load sharing, {row.group}", f"mean coefficient {row.mean:.3f}{width}, {row.motion}"
    for row in tables.get("following_groups", pd.DataFrame()).itertuples():
        yield (
            f"K_gamma, {row.group}",
            f"{row.k_gamma:.3f} (K_v {row.k_v:.3f}) at {row.speed_rpm:.0f} rpm and {row.torque_n_m:g} N m, "
            f"{row.k_gamma_static:.3f} at rest, over "
            f"{row.mesh_cycles} mesh cycles while the runouts turn",
        )
    if "jumps" in tables:
        speeds = tables["jumps"].groupby("direction")["speed_after_rpm"].unique()
        counts = [f"{len(at)} {name} ({_range(at.min(), at.max())} rpm)" for name, at in speeds.items()]
        yield "jumps in the sweep", ", ".join(counts) or "none"
    if "scorecard" in tables:
        counted = tables["scorecard"][tables["scorecard"]["counted"]]["verdict"].value_counts(sort=False)
        yield "claims of the paper", ", ".join(f"{name} {rows}" for name, rows in counted.items())


def _nearest(rating: pd.DataFrame | None) -> pd.DataFrame:
    """Of each kind of gear and each failure the row nearest to its limit."""
    if rating is None:
        return pd.DataFrame()
    spare = rating["safety"] / rating["required"]
    return rating.loc[spare.groupby([rating["gear"], rating["failure"]], sort=False).idxmin()]


def _lubricated(losses: pd.DataFrame | None) -> Iterator[tuple[str, str]]:
    """Scuffing, film and micropitting of the mesh that is nearest to each limit, in any bin."""
    for about, column in (
        ("scuffing", "scuffing_safety"),
        ("smallest film", "smallest_film_ratio"),
        ("micropitting", "micropitting_safety"),
    ):
        if losses is None or not losses[column].notna().any():
            continue
        row = losses.loc[losses[column].idxmin()]
        at = f"bin {row['bin']} of the duty cycle" if row["bin"] > 0 else "the nominal load"
        outside = "" if row["within_torques_solved"] else "; outside the torques of the contact analysis"
        where = f"{row['mesh']}, {row['flank']} flank, at {at}{outside}"
        if column == "smallest_film_ratio":
            yield about, f"{row[column]:.2f} times the roughness of both flanks ({where})"
            continue
        margin = f", {row['scuffing_margin_k']:.0f} K to the limit" if about == "scuffing" else ""
        yield about, f"safety {row[column]:.2f}{margin} ({where})"


def _range(first: float, last: float) -> str:
    """Both ends of a range, or the one number they are when rounded."""
    ends = dict.fromkeys((f"{first:.0f}", f"{last:.0f}"))
    return " to ".join(ends)


def _pressure(row: Any) -> str:
    """The largest pressure with its error, where one is known."""
    if not getattr(row, "pressure_mpa", nan) > 0.0:
        return ""
    return f", flank pressure up to {row.pressure_mpa:.0f} ± {row.pressure_error_mpa:.0f} MPa away from edges"


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
    transmission = values["transmission"]
    if transmission is None:
        return
    if pair is not None:
        own, teeth = transmission["backlash_um"], pair["backlash_um"]["smallest"]
        if own is not None and abs(own - teeth) > BACKLASH_DIFFERS_UM:
            yield "backlash", f"the dynamics take {own:g} um, the teeth as assembled have {teeth:.1f} um"
    missing = rated(tables).get("power_imbalance", 0.0)
    if abs(missing) > BALANCED:
        yield "power", f"in less out {100 * missing:.3g} %: lever arms as printed are not those of the teeth"
    yield from _open_warnings(tables)
    yield from _sweep_warnings(tables)
    for row in _nominal(tables).itertuples():
        if row.lost_fraction > 0.0:
            yield (
                f"load sharing, {row.group}",
                f"a path is out of contact {100 * row.lost_fraction:.0f} % of the time",
            )
        if not str(row.motion).startswith("period-"):
            yield f"load sharing, {row.group}", f"the motion is {row.motion}: numbers are averages"


def _open_warnings(tables: Mapping[str, pd.DataFrame]) -> Iterator[tuple[str, str]]:
    """Meshes that carry nothing at rest."""
    if "meshes" not in tables:
        return
    open_ones = tables["meshes"].loc[tables["meshes"]["flank"] == "open", "mesh"]
    if len(open_ones):
        yield "meshes at rest", f"no load at {_listed(open_ones)}"


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
        yield "speed sweep", f"open at every speed: {_listed(always)}"
    lost = max_open.index[(max_open > 0.0) & (min_open < 1.0)]
    if lost.size:
        time = f"up to {100 * max_open[lost].max():.2g} % of the time"
        yield "speed sweep", f"contact is lost at some speeds, {time}: {_listed(lost)}"


def _listed(names: Iterable[str]) -> str:
    """Names in a row; of many the first few, and how many more there are."""
    names = list(names)
    more = f" and {len(names) - LISTED} more" if len(names) > LISTED else ""
    return ", ".join(names[:LISTED]) + more


def _contact_warnings(
    values: Mapping[str, Any], tables: Mapping[str, pd.DataFrame]
) -> Iterator[tuple[str, str]]:
    if values["mesh_stiffness"]["source"] == "fem_scaled":
        yield "mesh stiffness", "only its shape is computed; its mean is the config's"
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


def _nominal(tables: Mapping[str, pd.DataFrame]) -> pd.DataFrame:
    summary = tables.get("summary")
    return pd.DataFrame() if summary is None else summary[summary["study"] == "nominal"]
