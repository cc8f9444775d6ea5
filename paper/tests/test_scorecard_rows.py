import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from facegear.errors import ConfigErrors, FacegearError
from paper.scorecard import rows
from paper.scorecard.base_rates import RATE_COLUMNS, Totals
from paper.scorecard.claims import Claim, read_claims
from paper.scorecard.criteria import CRITERIA
from paper.scorecard.outcome import ClaimOutcome
from paper.scorecard.page import counts, groups, render
from paper.scorecard.rows import CONFIG_SET, RUN_COLUMNS, Verdict, outcome_table, scorecard
from paper.scorecard.starts import START_COLUMNS, start_table

CLAIMS = Path(__file__).parents[2] / "config" / "claims" / "paper.yaml"
NUMBER = Claim(
    id="period",
    location="text",
    claim="mesh period",
    criterion="frequency",
    args={"order": 2},
    paper=100.0,
    tolerance=1.0,
    undisclosed_inputs=("torque per engine",),
    reason="because",
)


def frequencies(value):
    return {"frequencies": pd.DataFrame({"order": [1, 2], "frequency_hz": [0.0, value]})}


NO_STARTS = pd.DataFrame(columns=START_COLUMNS)
NO_RATES = pd.DataFrame(columns=RATE_COLUMNS)


def runs(*rows):
    return pd.DataFrame(list(rows), columns=RUN_COLUMNS)


def others_with(*values):
    """Two runs each of sets a, b ... whose outcome is the given number."""
    holds = [abs(value - 100.0) <= 1.0 for value in values]
    pairs = zip("abcd", values, holds, strict=False)
    return runs(*((name, "period", 2, 2 * held, value, value) for name, value, held in pairs))


def judged(own, *others, claim=NUMBER, stored=None):
    outcomes = outcome_table([claim], frequencies(own))
    found = others_with(*others) if stored is None else stored
    return scorecard([claim], outcomes, found, NO_RATES).iloc[0]


def test_number_within_tolerance_is_reproduced_and_needs_no_reason():
    row = judged(100.9)
    assert row["verdict"] == Verdict.REPRODUCED
    assert row["difference"] == pytest.approx(0.9)
    assert row["reason"] == ""


def test_number_off_with_every_set_differs():
    row = judged(103.0, 90.0, 110.0)
    assert row["verdict"] == Verdict.DIFFERS
    assert (row["sets_low"], row["sets_high"]) == (90.0, 110.0)
    assert row["sets_reproducing"] == "0 of 2"


def test_number_that_another_set_reproduces_depends_on_the_undisclosed_input():
    assert judged(103.0, 90.0, 100.5)["verdict"] == Verdict.DEPENDS


def test_row_that_hangs_on_nothing_undisclosed_cannot_be_excused_by_it():
    firm = NUMBER.model_copy(update={"undisclosed_inputs": ()})
    assert judged(103.0, 100.0, claim=firm)["verdict"] == Verdict.DIFFERS


@pytest.mark.parametrize(("own", "held"), [(100.5, 2), (100.5, 0), (103.0, 1), (103.0, 3)])
def test_row_whose_runs_differ_by_rounding_and_disagree_is_undecided(own, held):
    row = judged(
        own, stored=runs((CONFIG_SET, "period", 3, held, 99.0, 103.0), ("a", "period", 2, 2, 100.0, 100.0))
    )
    assert row["verdict"] == Verdict.INCONCLUSIVE
    assert f"{held} of 3 runs" in row["reason"]
    assert row["runs_holding"] == f"{held} of 3"


@pytest.mark.parametrize(("own", "held"), [(100.5, 3), (103.0, 0)])
def test_row_whose_runs_agree_keeps_its_verdict(own, held):
    row = judged(own, stored=runs((CONFIG_SET, "period", 3, held, own, own)))
    assert row["verdict"] == (Verdict.REPRODUCED if held else Verdict.DIFFERS)


def test_set_that_holds_in_some_runs_only_excuses_nothing():
    assert judged(103.0, stored=runs(("a", "period", 2, 1, 100.0, 105.0)))["verdict"] == Verdict.DIFFERS


@pytest.mark.parametrize(
    ("windows", "undecided"),
    [((99.5, 100.5), False), ((98.0, 100.5), True), ((98.0, 103.0), True), ((101.5, 103.0), False)],
)
def test_number_that_agrees_in_a_part_of_the_windows_is_undecided(monkeypatch, windows, undecided):
    def measured(tables):
        """A number that differs from cycle to cycle."""
        return ClaimOutcome(sum(windows) / 2.0, "some", windows=windows)

    monkeypatch.setattr(rows, "CRITERIA", {"measured": measured})
    claim = NUMBER.model_copy(update={"criterion": "measured", "args": {}})
    table = scorecard([claim], outcome_table([claim], {}), runs(), NO_RATES)
    assert (table["verdict"][0] == Verdict.INCONCLUSIVE) == undecided


def test_row_that_fails_unexplained_stops_the_scorecard():
    silent = NUMBER.model_copy(update={"reason": ""})
    assert judged(100.0, claim=silent)["verdict"] == Verdict.REPRODUCED
    with pytest.raises(FacegearError, match="period"):
        judged(103.0, claim=silent)


def test_missing_result_names_its_row():
    with pytest.raises(FacegearError, match="period"):
        outcome_table([NUMBER], {})


def test_every_claim_of_the_paper_has_a_criterion_and_failing_is_explained():
    claims = read_claims(CLAIMS).claims
    assert len(claims) > 100
    for claim in claims:
        assert claim.criterion in CRITERIA, claim.id
        assert CRITERIA[claim.criterion].__doc__
        assert "@" not in claim.reason, claim.id


def test_table_2_is_covered_completely():
    ids = {claim.id for claim in read_claims(CLAIMS).claims}
    assert {f"frequency_{order}" for order in range(7, 29)} <= ids


def test_claims_file_with_a_misspelt_key_is_refused(tmp_path):
    file = tmp_path / "claims.yaml"
    file.write_text("source: x\nclaims:\n- {id: a, where: b, clam: c, criterion: d}\n")
    with pytest.raises(ConfigErrors, match="claim"):
        read_claims(file)


def test_page_shows_every_row_and_escapes_text():
    claim = NUMBER.model_copy(update={"claim": "a < b"})
    frame = scorecard([claim], outcome_table([claim], frequencies(103.0)), runs(), NO_RATES)
    page = render(frame, "source", ["torque per engine 1 N m"], pd.DataFrame(), NO_STARTS)
    assert "a &lt; b" in page
    assert "differs" in page
    assert counts(frame)[Verdict.DIFFERS] == 1


def test_page_shows_what_random_inputs_hold_beside_each_verdict_and_against_the_total():
    rates = pd.DataFrame([("period", 64, 40, 0.625, 0.5, 0.733)], columns=RATE_COLUMNS)
    frame = scorecard([NUMBER], outcome_table([NUMBER], frequencies(100.5)), runs(), rates)
    for held, message in (([1.0] * 64, "no better than chance; 100 %"), ([0.0] * 64, "than 95 % of random")):
        page = render(frame, "source", [], pd.DataFrame(), NO_STARTS, Totals(1, np.array(held)))
        assert ">62 % (50 … 73)</td>" in page
        assert message.split(";")[0] in page
    assert "random plausible" not in render(frame, "source", [], pd.DataFrame(), NO_STARTS)


def test_the_page_has_differences_first_and_counts_that_add_up_to_all_rows():
    again = NUMBER.model_copy(update={"id": "again", "same_as": "period"})
    other = NUMBER.model_copy(update={"id": "other", "claim": "another number"})
    claims = [other, NUMBER, again]
    own = outcome_table(claims, frequencies(103.0))
    own.loc[own["id"] == "other", ["holds", "difference"]] = [True, 0.0]
    frame = scorecard(claims, own, runs(), NO_RATES)
    found = groups(frame)
    assert [group["words"] for group in found] == [
        "differs",
        "undecided",
        "depends on an undisclosed input",
        "reproduced",
        "not counted",
    ]
    assert [group["rows"] for group in found] == [1, 0, 0, 1, 1]
    page = render(frame, "source", [], pd.DataFrame(), NO_STARTS)
    assert "1 + 0 + 0 + 1 + 1 = 3 rows." in page
    assert (
        page.index("<h2>Differs (1)") < page.index("<h2>Reproduced (1)") < page.index("<h2>Not counted (1)")
    )
    for group in found:
        assert f'id="show-{group["name"]}"' in page


def test_repeated_numbers_and_remarks_on_other_studies_are_left_out_of_totals():
    again = NUMBER.model_copy(update={"id": "again", "same_as": "period"})
    remark = NUMBER.model_copy(update={"id": "remark", "about": "other studies"})
    claims = [NUMBER, again, remark]
    frame = scorecard(claims, outcome_table(claims, frequencies(103.0)), runs(), NO_RATES)
    assert len(frame) == 3
    assert counts(frame)[Verdict.DIFFERS] == 1


def test_claim_that_repeats_an_unknown_row_is_refused(tmp_path):
    file = tmp_path / "claims.yaml"
    file.write_text("source: x\nclaims:\n- {id: a, where: b, claim: c, criterion: d, same_as: z}\n")
    with pytest.raises(ConfigErrors, match="same_as"):
        read_claims(file)


def test_the_pages_count_the_claims_that_are_judged():
    """A row a claim: the README's number of them, and those that hang on the dynamics' inputs."""
    claims = read_claims(CLAIMS).claims
    root = CLAIMS.parents[2]
    (rows,) = re.findall(r"scorecard \| (\d+) rows", (root / "README.md").read_text())
    (dynamic,) = re.findall(
        r"Of the (\d+) rows that depend on these inputs two are",
        (root / "docs" / "explanation" / "validation.md").read_text(),
    )
    assert int(rows) == len(claims)
    assert int(dynamic) - 2 == sum(claim.dynamic for claim in claims)


def test_page_says_of_each_set_what_holds_from_rest_and_what_from_every_start():
    """Sets were compared by their motion from rest alone, though others coexist with it."""
    again = NUMBER.model_copy(update={"id": "again", "same_as": "period"})
    other = NUMBER.model_copy(update={"id": "other"})
    nan = float("nan")
    stored = pd.DataFrame(
        [
            (CONFIG_SET, "period", 20, 20, 99.5, 100.5, True),
            (CONFIG_SET, "other", 20, 5, 99.5, 140.0, True),
            (CONFIG_SET, "again", 20, 20, 99.5, 100.5, True),
            ("a", "period", 20, 15, 99.5, 120.0, False),
            ("a", "other", 20, 0, nan, nan, False),
        ],
        columns=[*RUN_COLUMNS, "at_rest"],
    )
    found = start_table(stored, [NUMBER, again, other])
    assert found.to_dict("records") == [
        dict(zip(START_COLUMNS, (CONFIG_SET, 2, 2, 1, 2, 0), strict=True)),
        dict(zip(START_COLUMNS, ("a", 2, 0, 0, 1, 1), strict=True)),
    ]
    frame = scorecard([NUMBER], outcome_table([NUMBER], frequencies(100.5)), runs(), NO_RATES)
    page = render(frame, "source", [], pd.DataFrame(), found)
    assert "From rest and from every start" in page and "<td>a</td><td>2</td><td>0</td>" in page
    assert "From rest and from every start" not in render(frame, "source", [], pd.DataFrame(), NO_STARTS)
