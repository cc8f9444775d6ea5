"""One line about what the branches stage found, and its progress."""

import sys
from collections import Counter
from collections.abc import Sequence

import pandas as pd

from facegear.dynamics.branches.loci import Locus
from facegear.dynamics.branches.margins import StabilityLimit
from facegear.dynamics.branches.survey import Survey
from facegear.number_format import count_noun


def tell(text: str) -> None:
    """Print a line of progress to standard error, which a stage copies to its log."""
    print(f"branches: {text}", file=sys.stderr, flush=True)


def survey_summary(
    survey: Survey,
    ranges: Sequence[tuple[float, float, tuple[int, ...]]],
    stability_limits: Sequence[StabilityLimit],
    swept: pd.DataFrame,
    jumps: pd.DataFrame,
) -> str:
    """Branches, special points, coexistence, motions of the sweep, named jumps and margins."""
    followed = [branch for branch in survey.branches if branch.image_of is None]
    counts = Counter(s.kind.value for branch in followed for s in branch.specials)
    points, images = sum(len(branch.points) for branch in followed), len(survey.branches) - len(followed)
    motions = count_noun(len(swept), "periodic motion")
    parts = [
        f"{count_noun(len(followed), 'branch', 'branches')} of {count_noun(points, 'point')}"
        + (f" and {count_noun(images, 'image')}" if images else ""),
        ", ".join(f"{count} {kind}" for kind, count in counts.most_common()),
        f"{count_noun(len(ranges), 'speed range')} with several stable motions",
        f"{count_noun(len(survey.unfollowed), 'motion')} not followed" if survey.unfollowed else "",
        f"{(swept['branch'] != '').sum()} of {motions} of the sweep on a branch",
        f"{(jumps['kind'] != '').sum()} of {count_noun(len(jumps), 'jump')} named",
    ]
    parts += [_margin(loss) for loss in stability_limits]
    return "; ".join(part for part in parts if part)


def _margin(loss: StabilityLimit) -> str:
    if loss.special is None:
        return f"branch {loss.branch}: no loss up to {loss.parameter} = {loss.reached:.6g}"
    kind = loss.special.kind.value
    return f"branch {loss.branch}: {kind} at {loss.parameter} = {loss.reached:.6g}, from {loss.start:.6g}"


def loci_summary(loci: Sequence[Locus], missed: Sequence[str]) -> str:
    """Loci, their points and corners; those that could not be followed."""
    corners = Counter(corner.value for locus in loci for corner, _ in locus.corners)
    points = count_noun(sum(len(locus.points) for locus in loci), "point")
    text = ", ".join(f"{count} {corner}" for corner, count in corners.items())
    lost = f"; not followed: {'; '.join(missed)}" if missed else ""
    return f"{count_noun(len(loci), 'locus', 'loci')} of {points}; {text or 'no corners'}{lost}"
