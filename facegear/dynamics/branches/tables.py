"""The csv tables of the branches stage."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from facegear.dynamics.branches.columns import BRANCH_COLUMNS, SPECIAL_COLUMNS
from facegear.dynamics.branches.continuation import Branch
from facegear.dynamics.branches.loci import Locus
from facegear.dynamics.branches.measures import measures
from facegear.dynamics.branches.special import Special
from facegear.dynamics.branches.survey import Unfollowed
from facegear.transmission.layout import Layout

UM = 1e6
SHOWN_MULTIPLIERS = 8


def branch_table(layout: Layout, branches: Sequence[Branch]) -> pd.DataFrame:
    """BRANCH_COLUMNS: one row for each point and mesh."""
    frames = []
    for number, branch in enumerate(branches):
        for index, (point, arc) in enumerate(zip(branch.points, branch.arc, strict=True)):
            measured = measures(branch.period_map, point)
            leading = point.multipliers[0] if point.multipliers.size else complex(np.nan)
            meshes = len(layout.mesh_names)
            frames.append(
                pd.DataFrame(
                    {
                        "branch": number,
                        "point": index,
                        "arc": arc,
                        "speed_rpm": point.value,
                        "period": branch.period_map.period,
                        "stable": point.stable,
                        "leading_multiplier_real": leading.real,
                        "leading_multiplier_imaginary": leading.imag,
                        "mesh": layout.mesh_names[:meshes],
                        "deflection_ac_rms_um": UM * measured.ac_rms,
                        "deflection_rms_um": UM * measured.rms,
                        "deflection_minimum_um": UM * measured.minimum,
                        "deflection_maximum_um": UM * measured.maximum,
                        "peak_force_n": measured.peak_force,
                        "open_fraction": measured.fractions[0],
                        "drive_fraction": measured.fractions[1],
                        "back_fraction": measured.fractions[2],
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
    names = [name.replace(" ", "_") for name in layout.mesh_names]
    for number, branch in enumerate(branches):
        arc = branch.arc
        for special in branch.specials:
            index = int(np.clip(special.after, 0, len(arc) - 2))
            mu = special.multiplier
            rows.append(
                {
                    "branch": number,
                    "period": branch.period_map.period,
                    "kind": special.kind.value,
                    "speed_rpm": special.point.value,
                    "arc": float(np.interp(special.after, np.arange(len(arc)), arc)),
                    "multiplier_real": mu.real,
                    "multiplier_imaginary": mu.imag,
                    "angle_deg": float(np.degrees(np.angle(mu))),
                    "stable_before": branch.points[index].stable,
                    "stable_after": branch.points[index + 1].stable,
                    "meshes": " ".join(dict.fromkeys(names[m % len(names)] for m in special.meshes)),
                    "edge": _edge(special, len(names)),
                    "proof": special.proof,
                }
            )
    return pd.DataFrame(rows, columns=list(SPECIAL_COLUMNS))


def _edge(special: Special, meshes: int) -> str:
    """The edge that is grazed; of one-sided flanks upper stands for the drive flank, lower for the back."""
    if not special.meshes:
        return ""
    return "upper" if special.edge > 0 and special.meshes[0] < meshes else "lower"


def end_table(branches: Sequence[Branch]) -> pd.DataFrame:
    """Columns branch, image_of, period, points, from_rpm, to_rpm, first_end, last_end, tried.

    One row a branch. image_of: the branch of which it is the image under a symmetry of the machine, or
    nothing.
    """
    rows = [
        {
            "branch": number,
            "image_of": "" if branch.image_of is None else str(branch.image_of),
            "period": branch.period_map.period,
            "points": len(branch.points),
            "from_rpm": branch.values.min(),
            "to_rpm": branch.values.max(),
            "first_end": branch.ends[0].value,
            "last_end": branch.ends[1].value,
            "tried": branch.tried,
        }
        for number, branch in enumerate(branches)
    ]
    return pd.DataFrame(rows)


def unfollowed_table(unfollowed: Sequence[Unfollowed]) -> pd.DataFrame:
    """Columns period, speed_rpm, origin, reason: motions that were met and not followed."""
    rows = [(row.period, row.value, row.origin, row.reason) for row in unfollowed]
    return pd.DataFrame(rows, columns=["period", "speed_rpm", "origin", "reason"])


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
