"""The report's first screen: machine drawing, key numbers, verdicts and warnings."""

from collections.abc import Iterator, Mapping, Sequence
from math import nan
from typing import Any, NamedTuple

import pandas as pd

from facegear.report.machine import key_numbers, nominal
from facegear.report.page import Chapter, Picture, Table, scientific
from facegear.report.warnings import warnings

GREEN, AMBER, RED = "green", "amber", "red"
IRREGULAR = "irregular"
"""Kind of the rows of table `jumps` at which irregular motion begins or ends."""


class Finding(NamedTuple):
    """What was found about a subject; `light`: its verdict, where there is a limit to judge it by."""

    about: str
    finding: str
    light: str = ""


def glance_chapter(
    values: Mapping[str, Any],
    tables: Mapping[str, pd.DataFrame],
    drawing: Sequence[Picture],
    pair: Mapping[str, Any] | None,
    notes: Sequence[str] = (),
) -> Chapter:
    """What is read first, from the same inputs as the whole report; `drawing` shows the machine.

    notes: what a run says of its config when it starts, `key: words`.
    """
    rows = list(findings(tables, pair))
    lights = (RED, AMBER, GREEN)
    judged = [(row.light, row.about, row.finding) for light in lights for row in rows if row.light == light]
    others = [(row.about, row.finding) for row in rows if not row.light]
    said = [tuple(note.split(": ", 1)) for note in notes]
    warned = [*warnings(values, tables, pair), *said]
    listed = [
        Table(_counted(judged), pd.DataFrame(judged, columns=["verdict", "about", "result"])),
        Table("Warnings", pd.DataFrame(warned, columns=["about", "what to keep in mind"])),
        Table("Key numbers", key_numbers(tables, pair)),
        Table("Results in short", pd.DataFrame(others, columns=["about", "result"])),
    ]
    return Chapter(
        "At a glance", "", drawing, [table for table in listed if len(table.frame) or table is listed[1]]
    )


def _counted(judged: Sequence[tuple[str, str, str]]) -> str:
    """The caption of the verdicts: how many there are of each colour, the worst first."""
    counts = {light: sum(row[0] == light for row in judged) for light in (RED, AMBER, GREEN)}
    return "Verdicts: " + ", ".join(f"{count} {light}" for light, count in counts.items() if count)


def findings(tables: Mapping[str, pd.DataFrame], pair: Mapping[str, Any] | None) -> Iterator[Finding]:
    """What was found, in the order of computation."""
    if pair is not None:
        gap = pair["interference"] or pair["smallest_gap"]
        parts = f"gear {gap['gear_part']} against pinion {gap['pinion_part']}"
        where = f"{parts}, radius {gap['gear_radius_mm']:.1f} mm"
        state = "interference" if pair["interference"] else "free; smallest gap beside the contact"
        light = RED if pair["interference"] else GREEN
        yield Finding("teeth", f"{state} {gap['gap_um']:.1f} um ({where})", light)
    for row in tables.get("by_torque", pd.DataFrame()).itertuples():
        mean = row.k_average_mean_n_per_m
        known = f"mean stiffness {scientific(mean, 4)} N/m" if mean == mean else "no mean stiffness"
        error = f"peak-to-peak transmission error {row.ste_peak_to_peak_um:.2f} um"
        yield Finding(f"contact at {row.torque_n_m:g} N m", f"{known}, {error}{_pressure(row)}")
    for row in _nearest(tables.get("rating")).itertuples():
        yield Finding(
            f"{row.body.replace('_', ' ')}, {row.flank} flank, {row.failure} ({row.method})",
            f"safety {row.safety:.2f} where {row.required:g} is required"
            f"{'; ' + row.reason if row.reason else ''}"
            f"{'' if row.within_torques_solved else '; outside the torques of the contact analysis'}",
            row.verdict,
        )
    yield from _lubricated(tables.get("mesh_losses"))
    for row in nominal(tables).itertuples():
        width = f" ± {row.half_width:.2f}" if row.half_width > 0.005 else ""
        yield Finding(f"load sharing, {row.group}", f"mean coefficient {row.mean:.3f}{width}, {row.motion}")
    for row in tables.get("following_groups", pd.DataFrame()).itertuples():
        yield Finding(
            f"K_gamma, {row.group}",
            f"{row.k_gamma:.3f} (K_v {row.k_v:.3f}) at {row.speed_rpm:.0f} rpm and {row.torque_n_m:g} N m, "
            f"{row.k_gamma_static:.3f} at rest, over "
            f"{row.mesh_cycles} mesh cycles while the runouts turn; {_meaning_of_k_gamma(row.k_gamma)}",
        )
    if "jumps" in tables:
        irregular = tables["jumps"]["kind"] == IRREGULAR
        yield Finding("jumps in the sweep", _counted_speeds(tables["jumps"][~irregular]))
        if irregular.any():
            about = "irregular motion begins or ends abruptly in the sweep"
            yield Finding(about, _counted_speeds(tables["jumps"][irregular]))
    if "scorecard" in tables:
        counted = tables["scorecard"][tables["scorecard"]["counted"]]["verdict"].value_counts(sort=False)
        yield Finding("claims of the paper", ", ".join(f"{name} {rows}" for name, rows in counted.items()))


def _meaning_of_k_gamma(k_gamma: float) -> str:
    """Definition of K_gamma in words, and why it can be below 1."""
    meaning = "largest mean load of a mesh over its nominal even share"
    if k_gamma < 1.0:
        meaning += "; below 1, less load takes this path than an even split would send through it"
    return meaning


def _counted_speeds(jumps: pd.DataFrame) -> str:
    """The number of jumps in each direction with the range of their speeds."""
    speeds = jumps.groupby("direction")["speed_after_rpm"].unique()
    counts = [f"{len(at)} {name} ({_range(at.min(), at.max())} rpm)" for name, at in speeds.items()]
    return ", ".join(counts) or "none"


def _nearest(rating: pd.DataFrame | None) -> pd.DataFrame:
    """Of each kind of gear and each failure the row nearest to its limit."""
    if rating is None:
        return pd.DataFrame()
    spare = rating["safety"] / rating["required"]
    return rating.loc[spare.groupby([rating["gear"], rating["failure"]], sort=False).idxmin()]


def _lubricated(losses: pd.DataFrame | None) -> Iterator[Finding]:
    """Scuffing, film and micropitting of the mesh that is nearest to each limit, in any bin.

    A safety below 1 is red; one that was not solved for, beyond the torques of the contact analysis, amber.
    """
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
            yield Finding(about, f"{row[column]:.2f} times the roughness of both flanks ({where})")
            continue
        margin = f", {row['scuffing_margin_k']:.0f} K to the limit" if about == "scuffing" else ""
        light = RED if row[column] < 1.0 else GREEN if row["within_torques_solved"] else AMBER
        yield Finding(about, f"safety {row[column]:.2f}{margin} ({where})", light)


def _range(first: float, last: float) -> str:
    """Both ends of a range, or the one number they are when rounded."""
    ends = dict.fromkeys((f"{first:.0f}", f"{last:.0f}"))
    return " to ".join(ends)


def _pressure(row: Any) -> str:
    """The largest pressure with its error, where one is known."""
    if not getattr(row, "pressure_mpa", nan) > 0.0:
        return ""
    return f", flank pressure up to {row.pressure_mpa:.0f} ± {row.pressure_error_mpa:.0f} MPa away from edges"
