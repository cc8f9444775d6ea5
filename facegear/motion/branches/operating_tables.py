"""Tables of the machine's operation: coexistence, margins, the sweep's motions and its jumps."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from facegear.motion.branches.continuation import Branch
from facegear.motion.branches.explore import SettledMotion, lies_on
from facegear.motion.branches.margins import StabilityLimit, passed_by
from facegear.motion.branches.motion_arrays import SweptMotion, nearest_branch
from facegear.motion.branches.tables import JUMP_COLUMNS, SWEPT_COLUMNS
from facegear.motion.plan import Motion

IRREGULAR = "not periodic"
"""Entry of `branch` for motions that no branch of periodic motions can contain."""
NEUTRAL = "on it but for the place of a body that touches nothing, which is free"
"""Note on a row that lies on its branch but for the free position of a body without contact."""


def coexistence_table(
    motions_by_speed: Sequence[tuple[float, Sequence[SettledMotion]]], branches: Sequence[Branch]
) -> pd.DataFrame:
    """Tabulate the motions on which random starts end.

    Parameters
    ----------
    motions_by_speed : sequence of tuple
        Speed in rpm, and its motions.
    branches : sequence of Branch
        Branches followed.

    Returns
    -------
    DataFrame
        Columns speed_rpm, motion (class), branch, fraction (of the starts that end on it), error (its
        standard error), starts (in all). `branch` is a number, `not followed`, or `not periodic`.
    """
    rows = []
    for speed, motions in motions_by_speed:
        starts = sum(motion.count for motion in motions)
        for motion in motions:
            rows.append(
                {
                    "speed_rpm": speed,
                    "motion": motion.label,
                    "branch": _branch_of(motion, branches),
                    "fraction": motion.fraction,
                    "error": motion.error,
                    "starts": starts,
                }
            )
    return pd.DataFrame(rows, columns=["speed_rpm", "motion", "branch", "fraction", "error", "starts"])


def _branch_of(motion: SettledMotion, branches: Sequence[Branch]) -> str:
    """Return the number of the first branch on which a motion lies, as text; else `not periodic` or `not
    followed`.
    """
    if motion.point is None:
        return IRREGULAR
    for number, branch in enumerate(branches):
        if lies_on(branch, motion.point, motion.period):
            return str(number)
    return "not followed"


def range_table(ranges: Sequence[tuple[float, float, tuple[int, ...]]]) -> pd.DataFrame:
    """Tabulate the ranges in which several stable periodic motions exist.

    Parameters
    ----------
    ranges : sequence of tuple
        Both ends in rpm and the numbers of the branches, see coexistence_ranges().

    Returns
    -------
    DataFrame
        Columns from_rpm, to_rpm, motions (their number), branches (numbers separated by spaces, one a
        motion).
    """
    rows = [(low, high, len(numbers), " ".join(map(str, numbers))) for low, high, numbers in ranges]
    return pd.DataFrame(rows, columns=["from_rpm", "to_rpm", "motions", "branches"])


def margin_table(stability_limits: Sequence[StabilityLimit]) -> pd.DataFrame:
    """Tabulate how far each stable motion at the operating speed is from its end or its loss of stability.

    Parameters
    ----------
    stability_limits : sequence of StabilityLimit
        Limits of stability_limits().

    Returns
    -------
    DataFrame
        Columns branch, period, parameter, direction, start, kind, value, margin. `kind` is `none` where the
        range ends first; `margin` is value less start, in the parameter's unit.
    """
    rows = [
        {
            "branch": loss.branch,
            "period": loss.period,
            "parameter": loss.parameter,
            "direction": loss.direction,
            "start": loss.start,
            "kind": "none" if loss.special is None else loss.special.kind.value,
            "value": loss.end_value,
            "margin": loss.end_value - loss.start,
        }
        for loss in stability_limits
    ]
    columns = ["branch", "period", "parameter", "direction", "start", "kind", "value", "margin"]
    return pd.DataFrame(rows, columns=columns)


def swept_table(
    sweep_motions: Sequence[SweptMotion], branches: Sequence[Branch], longest: int
) -> pd.DataFrame:
    """Tabulate every periodic motion of the sweep with the branch that it lies on, or why it lies on none.

    Parameters
    ----------
    sweep_motions : sequence of SweptMotion
        Periodic motions of the sweep.
    branches : sequence of Branch
        Branches followed.
    longest : int
        Longest period from which branches are started, in mesh periods.

    Returns
    -------
    DataFrame
        SWEPT_COLUMNS. `sweep_error` is the distance of the sweep's state from the exact orbit next to it;
        `distance` is that of this orbit from the branch's at the same speed; both in length scales.
    """
    rows = []
    for motion in sweep_motions:
        number, distance = nearest_branch(motion, branches)
        note = motion.reason
        if number is None and not note:
            note = _not_followed(motion.period, longest)
        elif number is not None and motion.point is not None and motion.point.linear.neutral.size:
            note = NEUTRAL
        branch = "" if number is None else str(number)
        rows.append(
            (
                motion.direction,
                motion.speed_rpm,
                motion.label,
                motion.period,
                branch,
                distance,
                motion.error,
                note,
            )
        )
    return pd.DataFrame(rows, columns=list(SWEPT_COLUMNS))


def _not_followed(period: int, longest: int) -> str:
    """Return the note on an orbit that lies on no branch: its period, or merely that it was not followed."""
    if period > longest:
        return f"the orbit is found; periods above longest_start_period = {longest} are not followed"
    return "not followed"


def jump_table(
    jumps: pd.DataFrame,
    sweep_motions: Sequence[SweptMotion],
    branches: Sequence[Branch],
    resolution_rpm: float,
    spacing_rpm: float,
) -> pd.DataFrame:
    """Tabulate each jump of the sweep with the special point into which its motion runs, or why there is
    none.

    A point counts within the jump's bracket or up to `resolution_rpm` beside it. Else it counts up to
    `spacing_rpm` before it in the direction of running: a run stays on a motion that has just lost its
    stability until disturbances have grown. A motion that has not settled there is taken for that of the
    sweep's last speed, if it was periodic.

    Parameters
    ----------
    jumps : DataFrame
        Columns direction, speed_before_rpm, speed_after_rpm, class_before.
    sweep_motions : sequence of SweptMotion
        Periodic motions of the sweep.
    branches : sequence of Branch
        Branches followed.
    resolution_rpm : float
        Width by which the bracket is widened, rpm.
    spacing_rpm : float
        Step of the sweep, rpm.

    Returns
    -------
    DataFrame
        JUMP_COLUMNS.
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
        label = str(jump.class_before)
        if label == Motion.NOT_SETTLED:
            label = _last_class(str(jump.direction), before, after, sweep_motions, spacing_rpm) or label
        rows.append(row | _explain_jump(before, after, label, branches, resolution_rpm, spacing_rpm))
    return pd.DataFrame(rows, columns=list(JUMP_COLUMNS))


def _last_class(
    direction: str, before: float, after: float, sweep_motions: Sequence[SweptMotion], spacing: float
) -> str | None:
    """Return the label of the sweep's periodic motion nearest before a jump in the direction of running,
    or None.

    It lies at most `spacing` (rpm) before the bracket's first end.
    """
    onward = np.sign(after - before)
    behind = {
        onward * (before - row.speed_rpm): row.label
        for row in sweep_motions
        if row.direction == direction and 0.0 <= onward * (before - row.speed_rpm) <= spacing
    }
    return behind[min(behind)] if behind else None


def _explain_jump(
    before: float, after: float, label: str, branches: Sequence[Branch], resolution: float, spacing: float
) -> dict[str, object]:
    """Return the columns branch, kind, speed_rpm and note of a jump: the special point that explains it,
    or why there is none.

    `before` and `after` are the ends of its bracket, `resolution` and `spacing` as in jump_table(), all
    in rpm; `label` is the class of the motion before it.
    """
    if not label.startswith("period-"):
        return {"note": f"the motion before it is {label}: no branch of periodic motions ends there"}
    period = int(label.removeprefix("period-"))
    hits = passed_by(branches, before, after, period, resolution)
    if not hits:
        earlier_hits = passed_by(branches, before - np.copysign(spacing, after - before), before, period, 0.0)
        hits = sorted(earlier_hits, key=lambda hit: abs(hit[1].point.value - before))
    if not hits:
        is_followed = any(branch.period_map.period == period for branch in branches)
        note = "no followed branch loses stability in the bracket"
        return {"note": note if is_followed else f"no branch of period {period} was followed"}
    number, special = hits[0]
    low, high = sorted((before, after))
    speed = special.point.value
    inside = low <= speed <= high
    beside = "" if inside else f"{max(low - speed, speed - high):.3g} rpm beside the bracket"
    return {"branch": str(number), "kind": special.kind.value, "speed_rpm": speed, "note": beside}
