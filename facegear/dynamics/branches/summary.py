"""Summary of the branches stage in one line, and its progress."""

import sys
from collections import Counter
from collections.abc import Sequence

import pandas as pd

from facegear.dynamics.branches.loci import Locus
from facegear.dynamics.branches.margins import StabilityLimit
from facegear.dynamics.branches.survey import Survey
from facegear.number_format import count_noun


def tell(text: str) -> None:
    """Print a line of progress to standard error, which a stage copies to its log.

    Parameters
    ----------
    text : str
        Line without its prefix.
    """
    print(f"branches: {text}", file=sys.stderr, flush=True)


def survey_summary(
    survey: Survey,
    ranges: Sequence[tuple[float, float, tuple[int, ...]]],
    stability_limits: Sequence[StabilityLimit],
    sweep_motions: pd.DataFrame,
    jumps: pd.DataFrame,
) -> str:
    """Summarise branches, special points, coexistence, motions of the sweep, named jumps and margins.

    Parameters
    ----------
    survey : Survey
        Branches, and motions that were not followed.
    ranges : sequence of tuple
        Ranges of coexistence_ranges(), in rpm.
    stability_limits : sequence of StabilityLimit
        Limits of stability_limits().
    sweep_motions : DataFrame
        Table of swept_table().
    jumps : DataFrame
        Table of jump_table().

    Returns
    -------
    str
        One line.
    """
    originals = [branch for branch in survey.branches if branch.image_of is None]
    counts = Counter(s.kind.value for branch in originals for s in branch.specials)
    points, images = sum(len(branch.points) for branch in originals), len(survey.branches) - len(originals)
    motions = count_noun(len(sweep_motions), "periodic motion")
    parts = [
        f"{count_noun(len(originals), 'branch', 'branches')} of {count_noun(points, 'point')}"
        + (f" and {count_noun(images, 'image')}" if images else ""),
        ", ".join(f"{count} {kind}" for kind, count in counts.most_common()),
        f"{count_noun(len(ranges), 'speed range')} with several stable motions",
        f"{count_noun(len(survey.unfollowed_motions), 'motion')} not followed"
        if survey.unfollowed_motions
        else "",
        f"{(sweep_motions['branch'] != '').sum()} of {motions} of the sweep on a branch",
        f"{(jumps['kind'] != '').sum()} of {count_noun(len(jumps), 'jump')} named",
    ]
    parts += [_margin(loss) for loss in stability_limits]
    return "; ".join(part for part in parts if part)


def _margin(loss: StabilityLimit) -> str:
    if loss.special is None:
        return f"branch {loss.branch}: no loss up to {loss.parameter} = {loss.end_value:.6g}"
    kind = loss.special.kind.value
    return f"branch {loss.branch}: {kind} at {loss.parameter} = {loss.end_value:.6g}, from {loss.start:.6g}"


def loci_summary(loci: Sequence[Locus], failures: Sequence[str]) -> str:
    """Summarise loci, their points and corners, and the loci that could not be followed.

    Parameters
    ----------
    loci : sequence of Locus
        Loci found.
    failures : sequence of str
        One line for each locus that could not be followed.

    Returns
    -------
    str
        One line.
    """
    corners = Counter(corner.value for locus in loci for corner, _ in locus.corners)
    points = count_noun(sum(len(locus.points) for locus in loci), "point")
    text = ", ".join(f"{count} {corner}" for corner, count in corners.items())
    failure_text = f"; not followed: {'; '.join(failures)}" if failures else ""
    return f"{count_noun(len(loci), 'locus', 'loci')} of {points}; {text or 'no corners'}{failure_text}"
