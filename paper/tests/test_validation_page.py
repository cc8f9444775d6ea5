"""The numbers on the page about residuals are those of the stored results."""

import re
from pathlib import Path

import pandas as pd
import pytest

from paper.reproduction import read_reproduction
from paper.scorecard.base_rates import totals
from paper.scorecard.claims import read_claims

ROOT = Path(__file__).parents[2]
STORED = read_reproduction(ROOT / "config" / "reproduction" / "paper.yaml")
PAGE = (ROOT / "docs" / "explanation" / "validation.md").read_text()
TEXT = " ".join(PAGE.split())
"""The page without its line breaks."""
CLAIMS = read_claims(STORED.claims).claims
SHOWN = 4
INPUT_COLUMNS = (
    *("pattern", "per_input_n_m", "tail_share", "error_phase_deg", "stiffness_variation"),
    *("mid_bearing_n_per_m", "stiff_bearing_n_per_m", "meaning", "phase_convention", "waveform"),
    *("open_flanks", "stiffness_torque_n_m"),
)
OF_MOTION, LOG_LIKELIHOOD = "log_likelihood_of_motion", "log_likelihood"
LOG_UNITS = 3.0
"""The region holds the inputs within so many log units of the most likely ones."""
ANNOUNCED = ("gear_peak_5772", "jump_5772_hardening", "dominates_5772_gears")
OPTIMUM = ("gear_bearings_best_inputs", "gear_bearings_best_idlers")
ORDER = ("pinion_bearings_worse", "pinion_bearings_lost", "pinion_bearings_lowest_inputs")


def table(name):
    return pd.read_csv(Path(STORED.runs).with_name(f"{name}.csv"))


def distinct_inputs(judged):
    """The first row of each of the inputs."""
    return judged.drop_duplicates(list(INPUT_COLUMNS))


def percent(value):
    return f"{100 * value:.0f} %"


def message(pattern):
    return pattern.replace("+", ", ")


def chance_row():
    found = totals(pd.read_csv(STORED.random), CLAIMS)
    low, high = found.spread
    return (
        f"| {found.claims_held.size} random plausible sets | {found.mean:.1f} on average; "
        f"the middle 90 % {low:.0f} to {high:.0f}, at most {found.claims_held.max():.0f} | |"
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
        who = "the config's own" if name == "config" else f"set {name}"
        runs = int(found["runs"].max())
        rows.append(f"| {who}, {runs} run{'s' * (runs > 1)} | {always} in every run | {some} |")
    return rows


def pattern_rows():
    """The best patterns, and the worst."""
    frame = table("structures")
    row = (
        "| {name} | {0.samples} | {0.mean:.1f} ± {0.mean_error:.1f} | {0.upper:.1f} ± {0.upper_error:.1f} | "
        "{0.most} | {0.all_mean:.1f} |"
    )
    shown = pd.concat([frame.head(SHOWN), frame.tail(SHOWN)])
    return [row.format(one, name=message(one.value)) for one in shown.itertuples()]


def null_rows():
    row = (
        "| {0.paper} | {0.papers} | {0.fitted_mean:.1f} | {0.fitted_low:.0f} to {0.fitted_high:.0f} | "
        "{0.held_out_mean:.1f} | {0.held_out_low:.0f} to {0.held_out_high:.0f} |"
    )
    return [row.format(one) for one in table("null").itertuples()]


def search_rows():
    frame = table("searches")
    each = frame.filter(regex=r"log_likelihood_\d").to_numpy(float)
    row = "| {name} | {0.evaluations} | {each} | {0.held} of {0.claims} | {0.most} |"
    return [
        row.format(one, name=message(one.pattern), each=", ".join(f"{best:.1f}" for best in repeated))
        for one, repeated in zip(frame.itertuples(), each, strict=True)
    ]


def count_rows():
    row = (
        "| {0.value} | {0.samples} | {0.mean:.1f}, at most {0.most} of {0.claims} | "
        "{0.all_mean:.1f}, at most {0.all_most} of {0.all_claims} |"
    )
    return [row.format(one) for one in table("held_counts").itertuples()]


def share_rows(ids):
    """Shares of a claim among the region's motions, quick and at full accuracy, and of random inputs."""
    frame, accurate = table("claim_shares").set_index("id"), table("accurate")
    return [
        f"| `{one}` | {percent(frame['region_share'][one])} | "
        f"{percent(accurate[one].mean()) if one in accurate else 'not judged'} | "
        f"{percent(frame['random_share'][one])} |"
        for one in ids
    ]


def accurate_text():
    """Count of the region's inputs that are likely at full accuracy, too, and from every start, as text."""
    inputs = distinct_inputs(table("accurate"))
    found = inputs[LOG_LIKELIHOOD]
    kept, best = inputs[found >= found.max() - LOG_UNITS], inputs.loc[found.idxmax()]
    worst = table("accurate").groupby(list(INPUT_COLUMNS))[OF_MOTION].min()
    always = int((worst >= found.max() - LOG_UNITS).sum())
    return (
        f"{len(kept)} of the {len(inputs)} stay within {LOG_UNITS:g} log units of the best of them "
        f"({best[LOG_LIKELIHOOD]:.1f}, {best['per_input_n_m']:.0f} N m), the median lies at "
        f"{found.median():.1f}; {always} do so from each of their starts"
    )


def region_rows():
    """Ranges of the region's inputs, by what is chosen."""
    rows, chosen = [], ["pattern", "meaning", "waveform", "phase_convention", "open_flanks"]
    for (pattern, *choices), found in distinct_inputs(table("region")).groupby(chosen):
        low, high = found.min(numeric_only=True), found.max(numeric_only=True)
        rows.append(
            f"| {len(found)} | {message(pattern)} | {' | '.join(choices).replace('_', ' ')} | "
            f"{low['per_input_n_m']:.0f} to {high['per_input_n_m']:.0f} | "
            f"{100 * low['tail_share']:.0f} to {100 * high['tail_share']:.0f} % | "
            f"{low['error_phase_deg']:.0f} to {high['error_phase_deg']:.0f} | "
            f"{low['stiffness_variation']:.2f} to {high['stiffness_variation']:.2f} | "
            f"{high['log_likelihood']:.1f} |"
        )
    return rows


def recommended_texts():
    found = pd.read_csv(STORED.sets).iloc[0]
    return (
        f"Set a: {found['per_input_n_m']:.1f} N m per engine",
        f"{100 * found['tail_share']:.1f} % of the power at the tail",
        f"{found['waveform']} of 50 um {found['meaning']} with phase {found['error_phase_deg']:.1f} deg",
        f"{found['stiffness_variation']:.2f} times our variation",
        f"the log-likelihood {found['log_likelihood']:.1f} without jumps",
        f"the least of them {found['least_log_likelihood']:.1f}",
    )


def confirmed_text():
    """Return how likely the confirmed inputs are over their runs, and in the worst of them."""
    found = table("confirmed")
    likely, worst = found[LOG_LIKELIHOOD], found["least_log_likelihood"]
    near = int((likely >= likely.max() - LOG_UNITS).sum())
    return (
        f"{near} of the {len(found)} confirmed lie within {LOG_UNITS:g} log units of the best "
        f"({likely.max():.1f}); each of them has a start from which it falls to {worst.max():.1f} or below"
    )


def near_5772_texts():
    """Inputs that hold what the paper says of 5772 rpm, and how the recommended set holds it."""
    judged = pd.concat([table("likely"), pd.read_csv(STORED.random)], ignore_index=True)
    near = judged[judged[["jump_5772", "jump_5772_hardening", "dominates_5772_gears"]].min(axis=1) > 0]
    assert set(near["pattern"]) == {"idler/upper+input/upper"} and set(near["waveform"]) == {"arcs"}
    assert not near[["backlash_80_idlers", "backlash_100_idlers", "backlash_120_idlers"]].any().any()
    region = distinct_inputs(table("region"))
    jumps = region[region["jump_5772"] > 0]
    return (
        f"{len(distinct_inputs(near))} of the {len(distinct_inputs(judged))} inputs judged with a sweep hold "
        "all three claims",
        f"{near['per_input_n_m'].min():.0f} to {near['per_input_n_m'].max():.0f} N m",
        f"{len(jumps)} of its {len(region)} inputs have a jump near 5772 rpm",
        f"{int(jumps['jump_5772_hardening'].sum())} of them one that hardens",
        f"{int(region['dominates_5772_gears'].sum())} the dominance",
    )


def pair_rows():
    row = (
        "| `{0.first}`, {0.first_held:.1f} | `{0.second}`, {0.second_held:.1f} | {0.judged:.0f} | "
        "{0.expected:.1f} |"
    )
    return [row.format(one) for one in table("never_together").itertuples()]


def kinematics_rows(ids):
    frame = table("kinematics").set_index("id")
    return [
        f"| `{one}` | {percent(frame['printed_share'][one])} | {percent(frame['geometric_share'][one])} |"
        for one in ids
    ]


def moved_by_kinematics():
    """Claims whose shares of random inputs differ beyond both intervals, the most moved first."""
    frame = table("kinematics").set_index("id")
    fewer = frame["geometric_high"] < frame["printed_low"]
    more = frame["geometric_low"] > frame["printed_high"]
    change = (frame["geometric_share"] - frame["printed_share"]).abs()
    return change[fewer | more].sort_values(ascending=False, kind="stable").index.tolist()


def test_what_the_region_does_at_full_accuracy_is_reported_as_stored():
    assert accurate_text() in TEXT and confirmed_text() in TEXT


def test_the_recommended_set_and_what_holds_near_5772_rpm_are_reported_as_stored():
    for message in (*recommended_texts(), *near_5772_texts()):
        assert message in TEXT


def test_means_of_the_backlash_study_lie_within_the_runs_of_the_recommended_set():
    runs = pd.read_csv(STORED.runs).query("set == 'a'").set_index("id")
    for group, name in (
        ("inputs' mean", "inputs"),
        ("idlers' mean", "idlers"),
        ("idlers' minimum", "idlers_minimum"),
    ):
        row = re.search(rf"^\| {group}, paper / likely / default \|(.*)\|$", PAGE, flags=re.MULTILINE)[1]
        for backlash, cell in zip((80, 100, 120), row.split("|"), strict=True):
            found, claim = float(cell.split("/")[1]), f"backlash_{backlash}_{name}"
            assert runs["low"][claim] - 0.005 <= found <= runs["high"][claim] + 0.005


def test_whether_the_set_is_found_is_reported_by_the_stored_null():
    """More held-out claims than the rule reaches for 95 % of the invented papers."""
    edge = table("null").set_index("paper").loc["invented", "held_out_high"]
    runs = pd.read_csv(STORED.runs).query("set == 'a'").set_index("id")
    held_out = [one.id for one in CLAIMS if one.dynamic and one.counts and not one.is_fitted]
    judged = [
        name for name in held_out if name in table("kinematics")["id"].tolist()
    ]  # those without a sweep
    held = int((runs.loc[judged, "held"] == runs.loc[judged, "runs"]).sum())
    assert f"holds {held} of the {len(judged)} held-out rows" in PAGE
    assert f"95 % of the invented papers ({edge:.2f})" in PAGE
    assert ("it does not count as found" in PAGE) == (held <= edge)


def test_what_chance_holds_is_reported_as_stored():
    distinct = sum(claim.dynamic and claim.counts for claim in CLAIMS)
    assert f"| inputs | distinct claims held, of {distinct} |" in PAGE
    assert chance_row() in PAGE


@pytest.mark.parametrize(
    "rows",
    [run_rows, pattern_rows, null_rows, search_rows, count_rows, region_rows, pair_rows],
    ids=lambda rows: rows.__name__,
)
def test_tables_of_the_page_are_those_stored(rows):
    for row in rows():
        assert row in PAGE


@pytest.mark.parametrize("ids", [ANNOUNCED, OPTIMUM, ORDER])
def test_shares_of_claims_are_reported_as_stored(ids):
    for row in share_rows(ids):
        assert row in PAGE


def test_every_claim_that_the_kinematics_move_is_reported():
    for row in kinematics_rows(moved_by_kinematics()):
        assert row in PAGE
