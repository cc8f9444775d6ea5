"""Assign the claims of the paper to its figures."""

from collections.abc import Iterable

from paper.scorecard.claims import Claim

NUMBERS = tuple(range(6, 21))
"""Numbers of the figures."""
STUDIES = {"backlash": 13, "pinion_bearings": 15, "gear_bearings": 17, "angles": 19}
"""Number of the figure of the inputs' coefficient in each study; the idlers' is the next."""
KINDS = {"inputs": 0, "idlers": 1}
"""Offset of the figure's number from the first of its study, by kind of group."""
PARTS = {
    **dict.fromkeys(("Table 2", "section 3.1"), (6,)),
    "Table 1": (7,),
    "figures 7 and 8": (7, 8),
    "figure 9": (9,),
    "figure 12": (12,),
}
"""Figures of all claims of a part of the paper."""
CONCLUSIONS = {"conclusion_classes": (6,), "conclusion_coupled": (6,), "conclusion_lost_contact": (9,)}
"""Figures of the claims that stand in the conclusions."""
GEARS, PINIONS = 11, 10
"""Numbers of the figures of the sweep of the face gears and of the pinions."""


def figures_of(claim: Claim) -> tuple[int, ...]:
    """Return the figures that show the subject of a claim; a claim on both groups stands beside both.

    Parameters
    ----------
    claim : Claim
        The claim.

    Returns
    -------
    tuple[int, ...]
        Numbers of the figures.
    """
    if claim.id in CONCLUSIONS:
        return CONCLUSIONS[claim.id]
    if claim.location in PARTS:
        return PARTS[claim.location]
    if claim.location == "figures 10 and 11":
        return _of_sweep(claim)
    if claim.criterion == "mesh_period":
        return (9,)
    first = STUDIES[claim.args.get("study", "angles" if claim.id == "conclusion_angles" else "backlash")]
    kind = claim.args.get("kind")
    return (first, first + 1) if kind is None else (first + KINDS[kind],)


def _of_sweep(claim: Claim) -> tuple[int, ...]:
    """A resonance that a mode explains is drawn in both figures."""
    if "parts" not in claim.args:
        return PINIONS, GEARS
    return (GEARS,) if any("gear" in part for part in claim.args["parts"]) else (PINIONS,)


def claims_of(number: int, claims: Iterable[Claim]) -> list[Claim]:
    """Return the claims beside a figure, in the order of the scorecard.

    Parameters
    ----------
    number : int
        Number of the figure.
    claims : Iterable[Claim]
        All claims.

    Returns
    -------
    list[Claim]
        Those of the figure.
    """
    return [claim for claim in claims if number in figures_of(claim)]
