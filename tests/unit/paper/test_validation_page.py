"""The counts on the page about residuals are those of the stored results."""

from pathlib import Path

import pandas as pd

from facegear.paper.config.reproduction import read_reproduction
from facegear.paper.scorecard.base_rates import totals
from facegear.paper.scorecard.claims import read_claims

ROOT = Path(__file__).parents[3]
STORED = read_reproduction(ROOT / "config" / "reproduction" / "paper.yaml")
PAGE = (ROOT / "docs" / "validation.md").read_text()
CLAIMS = read_claims(STORED.claims).claims


def chance_row():
    found = totals(pd.read_csv(STORED.random), CLAIMS)
    low, high = found.spread
    return (
        f"| {found.held.size} random plausible sets | {found.mean:.1f} on average; the middle 90 % {low:.0f} "
        f"to {high:.0f}, at most {found.held.max():.0f} | |"
    )


def run_rows():
    """Claims that hold in every stored run of a set, and those that hold in some."""
    distinct = {claim.id for claim in CLAIMS if claim.counts}
    stored = pd.read_csv(STORED.runs)
    stored = stored[stored["id"].isin(distinct)]
    rows = []
    for name, found in stored.groupby("set", sort=False):
        always = int((found["held"] == found["runs"]).sum())
        some = int(((found["held"] > 0) & (found["held"] < found["runs"])).sum())
        told = "the config's own" if name == "config" else f"set {name}"
        runs = int(found["runs"].max())
        rows.append(f"| {told}, {runs} run{'s' * (runs > 1)} | {always} in every run | {some} |")
    return rows


def test_what_chance_holds_is_told_as_stored():
    distinct = sum(claim.dynamic and claim.counts for claim in CLAIMS)
    assert f"| inputs | distinct claims held, of {distinct} |" in PAGE
    assert chance_row() in PAGE


def test_what_repeated_runs_hold_is_told_as_stored():
    for row in run_rows():
        assert row in PAGE
