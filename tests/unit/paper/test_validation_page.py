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
SHOWN = 3
INPUT_MESHES = ("input/lower", "input/upper")


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


def pattern_rows():
    """The best and the worst patterns, and the readings of the paper."""
    frame = pd.read_csv(Path(STORED.runs).with_name("structures.csv"))
    shown = pd.concat([frame.head(SHOWN), frame.tail(SHOWN)])
    shown["pattern"] = shown["pattern"].str.replace("+", ", ")
    told = "| {0.pattern} | {0.samples} | {0.mean:.1f} | {0.upper:.1f} | {0.most:.0f} |"
    return [told.format(row) for row in shown.itertuples()]


def both_meshes_row():
    """Mean where the two meshes of an input are half a turn apart in e(t), and where they are together."""
    frame = pd.read_csv(Path(STORED.runs).with_name("structures.csv"))
    turned = [frame["pattern"].str.split("+").map(lambda names, of=of: of in names) for of in INPUT_MESHES]
    means = frame.groupby(turned[0] != turned[1])["mean"].mean()
    apart, together = means[True], means[False]
    return f"half a turn apart hold {apart:.1f} on average, those that leave them together {together:.1f}"


def test_what_chance_holds_is_told_as_stored():
    distinct = sum(claim.dynamic and claim.counts for claim in CLAIMS)
    assert f"| inputs | distinct claims held, of {distinct} |" in PAGE
    assert chance_row() in PAGE


def test_what_repeated_runs_hold_is_told_as_stored():
    for row in run_rows():
        assert row in PAGE


def test_patterns_of_e_are_told_as_stored():
    for row in pattern_rows():
        assert row in PAGE
    assert both_meshes_row() in PAGE
