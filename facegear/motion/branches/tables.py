"""The csv tables of the branches stage, and what a periodic motion means for the machine."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.machine.layout import Layout
from facegear.motion.branches.continuation import Branch
from facegear.motion.branches.loci import Locus
from facegear.motion.branches.period_map import PeriodMap
from facegear.motion.branches.points import BranchPoint
from facegear.motion.branches.special import Special
from facegear.motion.branches.survey import UnfollowedMotion
from facegear.motion.steady_state.mesh_samples import each_deflection, largest_mesh_forces, mesh_fractions
from facegear.motion.steady_state.window import run_window

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
    "deflection_minimum_um",
    "deflection_maximum_um",
    "peak_force_n",
    "open_fraction",
    "drive_fraction",
    "back_fraction",
)
"""Columns of table `branches`, a row for each point and mesh; units stand in the names."""
BRANCH_FINITE = tuple(name for name in BRANCH_COLUMNS if "multiplier" not in name)
"""Columns whose numbers are finite in every row."""
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
"""Columns of table `special`: folds, doublings and other special points."""
SWEPT_COLUMNS = (
    "direction",
    "speed_rpm",
    "class",
    "period",
    "branch",
    "distance",
    "sweep_error",
    "note",
)
"""Columns of table `swept`: the branch of each periodic row of a sweep."""
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
"""Columns of table `jumps`: the branch that ends at each jump of a sweep."""

SAMPLES = 64
"""Minimum number of samples in each mesh period."""


@dataclass(frozen=True, eq=False)
class Measures:
    """Deflections, force and contact times of each mesh in a periodic motion.

    Attributes
    ----------
    ac_rms, rms : (meshes,) array
        RMS of the deflection without and with its mean, m.
    minimum, maximum : (meshes,) array
        Smallest and largest deflection, m.
    peak_force : (meshes,) array
        Largest elastic force, N.
    fractions : (3, meshes) array
        Fraction of the time open, on the drive flank, and on the back flank.
    """

    ac_rms: Array
    rms: Array
    minimum: Array
    maximum: Array
    peak_force: Array
    fractions: Array


def measures(period_map: PeriodMap, point: BranchPoint) -> Measures:
    """Compute the measures of an orbit by a run over its period, by the same sums as those of a sweep.

    Parameters
    ----------
    period_map : PeriodMap
        Map over whole mesh periods.
    point : BranchPoint
        The orbit.

    Returns
    -------
    Measures
        Measures of each mesh.
    """
    integrator = period_map.integrator(point.u)
    system = integrator.system
    state = integrator.by_phase(period_map.state(point.z, point.u))
    window = run_window(integrator, state, period_map.period, SAMPLES)
    deflections = each_deflection(system, window.samples, window.per_period)
    moments = window.averages.meshes(True)
    return Measures(
        ac_rms=moments.ac_rms,
        rms=moments.rms,
        minimum=moments.minimum,
        maximum=moments.maximum,
        peak_force=largest_mesh_forces(system, deflections, window.per_period, wraps=True),
        fractions=mesh_fractions(system, window.fractions[:, : system.contacts], deflections),
    )


UM = 1e6
"""Micrometres in a metre."""
SHOWN_MULTIPLIERS = 8
"""Number of the largest multipliers that the table shows for each point."""


def branch_table(layout: Layout, branches: Sequence[Branch]) -> pd.DataFrame:
    """Tabulate each point of each branch, one row for each mesh.

    Parameters
    ----------
    layout : Layout
        Names of the meshes.
    branches : sequence of Branch
        Branches followed.

    Returns
    -------
    DataFrame
        BRANCH_COLUMNS. `arc` is Branch.arc; `peak_force_n` is the largest elastic force; fractions are of
        the time.
    """
    frames = []
    for number, branch in enumerate(branches):
        for index, (point, arc) in enumerate(zip(branch.points, branch.arc, strict=True)):
            mesh_measures = measures(branch.period_map, point)
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
                        "deflection_ac_rms_um": UM * mesh_measures.ac_rms,
                        "deflection_rms_um": UM * mesh_measures.rms,
                        "deflection_minimum_um": UM * mesh_measures.minimum,
                        "deflection_maximum_um": UM * mesh_measures.maximum,
                        "peak_force_n": mesh_measures.peak_force,
                        "open_fraction": mesh_measures.fractions[0],
                        "drive_fraction": mesh_measures.fractions[1],
                        "back_fraction": mesh_measures.fractions[2],
                    }
                )
            )
    return pd.concat(frames, ignore_index=True)[list(BRANCH_COLUMNS)]


def multiplier_table(branches: Sequence[Branch]) -> pd.DataFrame:
    """Tabulate the SHOWN_MULTIPLIERS largest multipliers of each point, one row for each multiplier.

    Parameters
    ----------
    branches : sequence of Branch
        Branches followed.

    Returns
    -------
    DataFrame
        Columns branch, point, speed_rpm, real, imaginary.
    """
    rows = [
        (number, index, point.value, value.real, value.imag)
        for number, branch in enumerate(branches)
        for index, point in enumerate(branch.points)
        for value in point.multipliers[:SHOWN_MULTIPLIERS]
    ]
    return pd.DataFrame(rows, columns=["branch", "point", "speed_rpm", "real", "imaginary"])


def special_table(layout: Layout, branches: Sequence[Branch]) -> pd.DataFrame:
    """Tabulate every special point along every branch, with its kind and the evidence for it.

    Parameters
    ----------
    layout : Layout
        Names of the meshes.
    branches : sequence of Branch
        Branches followed.

    Returns
    -------
    DataFrame
        SPECIAL_COLUMNS. `arc` is Branch.arc at the point, `angle_deg` the angle of the multiplier;
        `stable_before` and `stable_after` are those of the branch's points on both sides; `meshes` and
        `edge` are set at grazes.
    """
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
    """Return which edge a graze touches, "upper" or "lower", and "" for other special points.

    With one-sided flanks, whose indices run over 2 `meshes` contacts, "upper" is the drive flank and
    "lower" the back flank.
    """
    if not special.meshes:
        return ""
    return "upper" if special.edge > 0 and special.meshes[0] < meshes else "lower"


def end_table(branches: Sequence[Branch]) -> pd.DataFrame:
    """Tabulate each branch with its range and ends, one row a branch.

    Parameters
    ----------
    branches : sequence of Branch
        Branches followed.

    Returns
    -------
    DataFrame
        Columns branch, image_of, period, points (their number), from_rpm, to_rpm (extremes of speed),
        first_end, last_end (reasons, see BranchEnd), tried (Branch.failed_attempts). `image_of` is
        the branch of which it is the image under a symmetry of the machine, or empty.
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
            "tried": branch.failed_attempts,
        }
        for number, branch in enumerate(branches)
    ]
    return pd.DataFrame(rows)


def unfollowed_table(motions: Sequence[UnfollowedMotion]) -> pd.DataFrame:
    """Tabulate motions that were met and not followed.

    Parameters
    ----------
    motions : sequence of UnfollowedMotion
        The motions.

    Returns
    -------
    DataFrame
        Columns period, speed_rpm, origin, reason, see UnfollowedMotion.
    """
    rows = [(row.period, row.value, row.origin, row.reason) for row in motions]
    return pd.DataFrame(rows, columns=["period", "speed_rpm", "origin", "reason"])


def locus_table(loci: Sequence[Locus]) -> pd.DataFrame:
    """Tabulate the curves of folds and period doublings.

    Parameters
    ----------
    loci : sequence of Locus
        Loci found.

    Returns
    -------
    DataFrame
        Columns locus (number), kind, parameter, factor (on the parameter), speed_rpm, corner. One row for
        each point, then one for each corner; `corner` is empty for points.
    """
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
