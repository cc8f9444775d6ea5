"""The csv tables of the branches stage."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from facegear.dynamics.branches.continuation import Branch, End
from facegear.dynamics.branches.explore import Found, lies_on
from facegear.dynamics.branches.loci import Locus
from facegear.dynamics.branches.measures import measures
from facegear.dynamics.branches.survey import Loss, passed_by
from facegear.transmission.layout import Layout

UM = 1e6
SHOWN_MULTIPLIERS = 8
IRREGULAR = "not periodic"
BRANCH_COLUMNS = (
    "branch",
    "point",
    "arc",
    "speed_rpm",
    "period",
    "stable",
    "leading_multiplier_real",
    "leading_multiplier_imaginary",
    "mesh",
    "deflection_ac_rms_um",
    "deflection_rms_um",
    "deflection_least_um",
    "deflection_most_um",
    "peak_force_n",
    "open_share",
    "drive_share",
    "back_share",
)
SPECIAL_COLUMNS = (
    "branch",
    "period",
    "kind",
    "speed_rpm",
    "arc",
    "multiplier_real",
    "multiplier_imaginary",
    "angle_deg",
    "stable_before",
    "stable_after",
    "meshes",
    "edge",
    "proof",
)
JUMP_COLUMNS = (
    "direction",
    "speed_before_rpm",
    "speed_after_rpm",
    "class_before",
    "branch",
    "kind",
    "speed_rpm",
    "note",
)


def branch_table(layout: Layout, branches: Sequence[Branch]) -> pd.DataFrame:
    """BRANCH_COLUMNS: one row for each point and mesh."""
    frames = []
    for number, branch in enumerate(branches):
        for index, (point, arc) in enumerate(zip(branch.points, branch.arc, strict=True)):
            found = measures(branch.flow, point)
            leading = point.multipliers[0] if point.multipliers.size else complex(np.nan)
            meshes = len(layout.mesh_names)
            frames.append(
                pd.DataFrame(
                    {
                        "branch": number,
                        "point": index,
                        "arc": arc,
                        "speed_rpm": point.value,
                        "period": branch.flow.period,
                        "stable": point.stable,
                        "leading_multiplier_real": leading.real,
                        "leading_multiplier_imaginary": leading.imag,
                        "mesh": layout.mesh_names[:meshes],
                        "deflection_ac_rms_um": UM * found.ac_rms,
                        "deflection_rms_um": UM * found.rms,
                        "deflection_least_um": UM * found.least,
                        "deflection_most_um": UM * found.most,
                        "peak_force_n": found.peak_force,
                        "open_share": found.shares[0],
                        "drive_share": found.shares[1],
                        "back_share": found.shares[2],
                    }
                )
            )
    return pd.concat(frames, ignore_index=True)[list(BRANCH_COLUMNS)]


def multiplier_table(branches: Sequence[Branch]) -> pd.DataFrame:
    """Columns branch, point, speed_rpm, real, imaginary: the largest multipliers of each point."""
    rows = [
        (number, index, point.value, value.real, value.imag)
        for number, branch in enumerate(branches)
        for index, point in enumerate(branch.points)
        for value in point.multipliers[:SHOWN_MULTIPLIERS]
    ]
    return pd.DataFrame(rows, columns=["branch", "point", "speed_rpm", "real", "imaginary"])


def special_table(layout: Layout, branches: Sequence[Branch]) -> pd.DataFrame:
    """SPECIAL_COLUMNS: every special point along every branch, what it is and what proves it."""
    rows = []
    for number, branch in enumerate(branches):
        arc = branch.arc
        for special in branch.specials:
            index = int(np.clip(special.after, 0, len(arc) - 2))
            mu = special.multiplier
            rows.append(
                {
                    "branch": number,
                    "period": branch.flow.period,
                    "kind": special.kind.value,
                    "speed_rpm": special.point.value,
                    "arc": float(np.interp(special.after, np.arange(len(arc)), arc)),
                    "multiplier_real": mu.real,
                    "multiplier_imaginary": mu.imag,
                    "angle_deg": float(np.degrees(np.angle(mu))),
                    "stable_before": branch.points[index].stable,
                    "stable_after": branch.points[index + 1].stable,
                    "meshes": " ".join(layout.mesh_names[m].replace(" ", "_") for m in special.meshes),
                    "edge": {1: "upper", -1: "lower"}.get(special.edge, ""),
                    "proof": special.proof,
                }
            )
    return pd.DataFrame(rows, columns=list(SPECIAL_COLUMNS))


def end_table(branches: Sequence[Branch]) -> pd.DataFrame:
    """Columns branch, period, points, from_rpm, to_rpm, first_end, last_end, tried: one row a branch."""
    rows = [
        {
            "branch": number,
            "period": branch.flow.period,
            "points": len(branch.points),
            "from_rpm": branch.values.min(),
            "to_rpm": branch.values.max(),
            "first_end": branch.ends[0].value,
            "last_end": branch.ends[1].value,
            "tried": branch.tried if End.STEP in branch.ends else "",
        }
        for number, branch in enumerate(branches)
    ]
    return pd.DataFrame(rows)


def coexistence_table(
    found: Sequence[tuple[float, Sequence[Found]]], branches: Sequence[Branch]
) -> pd.DataFrame:
    """Columns speed_rpm, motion, branch, share, error, starts: where random starts end.

    branch: its number, `not followed`, or what kind of motion it is that no branch holds.
    """
    rows = []
    for speed, motions in found:
        starts = sum(motion.count for motion in motions)
        for motion in motions:
            rows.append(
                {
                    "speed_rpm": speed,
                    "motion": motion.label,
                    "branch": _branch_of(motion, speed, branches),
                    "share": motion.share,
                    "error": motion.error,
                    "starts": starts,
                }
            )
    return pd.DataFrame(rows, columns=["speed_rpm", "motion", "branch", "share", "error", "starts"])


def _branch_of(motion: Found, speed: float, branches: Sequence[Branch]) -> str:
    if motion.point is None:
        return IRREGULAR
    for number, branch in enumerate(branches):
        if lies_on(branch, motion.point.z, motion.period, speed):
            return str(number)
    return "not followed"


def range_table(ranges: Sequence[tuple[float, float, tuple[int, ...]]]) -> pd.DataFrame:
    """Columns from_rpm, to_rpm, motions, branches: where several stable periodic motions exist."""
    rows = [(low, high, len(numbers), " ".join(map(str, numbers))) for low, high, numbers in ranges]
    return pd.DataFrame(rows, columns=["from_rpm", "to_rpm", "motions", "branches"])


def margin_table(losses: Sequence[Loss]) -> pd.DataFrame:
    """Columns branch, period, parameter, direction, start, kind, value, margin: how far each stable motion
    at the operating speed is from its end or its loss of stability.

    kind `none` where the range ends first; margin is value less start.
    """
    rows = [
        {
            "branch": loss.branch,
            "period": loss.period,
            "parameter": loss.parameter,
            "direction": loss.direction,
            "start": loss.start,
            "kind": "none" if loss.special is None else loss.special.kind.value,
            "value": loss.reached,
            "margin": loss.reached - loss.start,
        }
        for loss in losses
    ]
    columns = ["branch", "period", "parameter", "direction", "start", "kind", "value", "margin"]
    return pd.DataFrame(rows, columns=columns)


def locus_table(loci: Sequence[Locus]) -> pd.DataFrame:
    """Columns locus, kind, parameter, factor, speed_rpm, corner: curves of folds and doublings."""
    columns = ["locus", "kind", "parameter", "factor", "speed_rpm", "corner"]
    rows = []
    for number, locus in enumerate(loci):
        name = locus.plane.names[1].removesuffix("_factor")
        for corner, point in [("", point) for point in locus.points] + [
            (corner.value, point) for corner, point in locus.corners
        ]:
            speed, factor = point.values
            rows.append((number, locus.kind.value, name, factor, speed, corner))
    return pd.DataFrame(rows, columns=columns)


def jump_table(jumps: pd.DataFrame, branches: Sequence[Branch], resolution_rpm: float) -> pd.DataFrame:
    """JUMP_COLUMNS: each jump of the sweep with the special point its motion runs into, or why there is none.

    A point counts within the jump's bracket or up to `resolution_rpm` beside it, since a motion that has just
    ended still holds a run for a while.
    """
    rows = []
    for jump in jumps.itertuples():
        before, after = float(jump.speed_before_rpm), float(jump.speed_after_rpm)
        row = {
            "direction": jump.direction,
            "speed_before_rpm": before,
            "speed_after_rpm": after,
            "class_before": jump.class_before,
            "branch": "",
            "kind": "",
            "speed_rpm": np.nan,
            "note": "",
        }
        rows.append(row | _named(before, after, str(jump.class_before), branches, resolution_rpm))
    return pd.DataFrame(rows, columns=list(JUMP_COLUMNS))


def _named(
    before: float, after: float, label: str, branches: Sequence[Branch], resolution_rpm: float
) -> dict[str, object]:
    if not label.startswith("period-"):
        return {"note": f"the motion before it is {label}: no branch of periodic motions ends there"}
    period = int(label.removeprefix("period-"))
    hits = passed_by(branches, before, after, period, resolution_rpm)
    if not hits:
        followed = any(branch.flow.period == period for branch in branches)
        told = "no followed branch loses stability in the bracket"
        return {"note": told if followed else f"no branch of period {period} was followed"}
    number, special = hits[0]
    low, high = sorted((before, after))
    speed = special.point.value
    inside = low <= speed <= high
    beside = "" if inside else f"{max(low - speed, speed - high):.3g} rpm beside the bracket"
    return {"branch": str(number), "kind": special.kind.value, "speed_rpm": speed, "note": beside}
