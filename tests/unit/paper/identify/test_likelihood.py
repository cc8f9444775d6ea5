"""Likelihood of inputs over claims, the search by it, and the null of its counts."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

from facegear.paper.identify.claim_judge import ClaimJudge
from facegear.paper.identify.inputs import COORDINATES, Space
from facegear.paper.identify.likelihood import Likelihood
from facegear.paper.identify.motions import LOG_LIKELIHOOD, START
from facegear.paper.identify.null import ANOTHER, INVENTED, THIS, null_counts
from facegear.paper.identify.patterns import READING_PATTERNS, half_turn_patterns
from facegear.paper.identify.random_inputs import Plausible
from facegear.paper.identify.region import candidates, most_likely, never_together
from facegear.paper.identify.search import Budget, going_on, search_pattern, searched_again, start_at
from facegear.paper.scorecard.claims import Claim

STATEMENT = Claim(id="leans", where="a", claim="", criterion="lowest_at", fitted=True)
NUMBER = Claim(id="mean", where="b", claim="", criterion="sharing", paper=1.7, tolerance=0.2, fitted=True)
NEAREST = Claim(id="jump", where="c", claim="", criterion="jump_speed", paper=5e3, tolerance=9.0, fitted=True)
HELD_OUT = Claim(id="other", where="c", claim="", criterion="lowest_at")
CLAIMS = [STATEMENT, NUMBER, NEAREST, HELD_OUT]
SPACE = Space((100.0, 1000.0), (0.0, 0.4), (0.5, 2.5), (1e8, 1e10), (120.0, 450.0), gears=2)


def judged(leans, mean, jump=0.0, other=0.0, spread=0.0, sample=0):
    return {
        "sample": sample,
        "pattern": "none",
        "error": "",
        "leans": leans,
        "jump": jump,
        "other": other,
        "mean": float(abs(mean - 1.7) <= 0.2),
        "mean value": mean,
        "mean spread": spread,
    }


def table(*rows):
    return pd.DataFrame([judged(*row) for row in rows])


RANDOM = table(*[(float(i == 0), 1.0, float(i < 5)) for i in range(10)])
LIKELIHOOD = Likelihood.of(CLAIMS, RANDOM)


def test_a_rare_statement_counts_more_and_one_never_held_by_chance_is_bounded():
    gains = LIKELIHOOD(table((1.0, 1.7), (0.0, 1.7))), LIKELIHOOD(table((0.0, 1.7, 1.0), (0.0, 1.7)))
    assert gains[0][0] - gains[0][1] == pytest.approx(np.log(12 / 2))
    assert gains[1][0] - gains[1][1] == pytest.approx(np.log(12 / 6))
    never = Likelihood.of(CLAIMS, RANDOM.assign(leans=0.0))
    assert never.surprise[0] == pytest.approx(np.log(12))


def test_a_number_is_likelier_the_nearer_it_lies_and_one_that_wavers_is_less_sure():
    found = LIKELIHOOD(table((0.0, 1.7), (0.0, 1.75), (0.0, 2.3), (0.0, float("nan"))))
    assert (np.diff(found) < 0.0).all()
    steady, wavering = LIKELIHOOD(
        pd.DataFrame([judged(0.0, at, spread=s) for at in (1.7, 2.3) for s in (0.0, 0.3)])
    ).reshape(2, 2)
    assert steady[0] > steady[1] and wavering[0] < wavering[1]


def test_inputs_without_a_result_cannot_be_likely_and_held_out_claims_do_not_count():
    failed = table((1.0, 1.7)).assign(error="NotConverged")
    assert LIKELIHOOD(failed)[0] == -np.inf
    with_it, without = LIKELIHOOD(table((1.0, 1.7, 1.0, 1.0), (1.0, 1.7, 1.0, 0.0)))
    assert with_it == without


def test_candidates_are_those_that_claims_on_sweeps_can_still_bring_into_the_region():
    found = pd.DataFrame([SPACE.row([value] * len(COORDINATES), "none") for value in (0.2, 0.4, 0.4, 0.6)])
    found[LOG_LIKELIHOOD] = [0.0, -3.1, -3.1, -4.0]
    unswept = found.assign(**dict.fromkeys(("leans", "mean"), 0.0))
    kept = candidates(unswept, LIKELIHOOD, most=10)
    assert kept[LOG_LIKELIHOOD].tolist() == [0.0, -3.1]  # a jump may add 0.69
    assert most_likely(found, 3.0)[LOG_LIKELIHOOD].tolist() == [0.0]


@given(st.permutations(range(32)), st.permutations(range(32)), st.integers(1, 32), st.integers(1, 32))
def test_patterns_go_on_by_mean_by_upper_and_as_readings_whatever_the_others_hold(
    means, uppers, by_mean, by_upper
):
    names = list(half_turn_patterns())
    rates = pd.DataFrame({"value": names, "mean": means, "upper": uppers})
    found = going_on(rates, by_mean, by_upper, 32)
    wanted = {names[i] for i in range(32) if means[i] >= 32 - by_mean or uppers[i] >= 32 - by_upper}
    assert len(set(found)) == len(found) and set(found) == wanted | set(READING_PATTERNS)


def test_patterns_that_tie_for_the_last_place_all_go_on_while_there_are_places():
    names = [name for name in half_turn_patterns() if name not in READING_PATTERNS]
    rates = pd.DataFrame({"value": names, "mean": [3.0, 2.0, 2.0, 1.0] + [0.0] * 24, "upper": 0.0})
    rates.loc[5, "upper"] = 1.0
    assert going_on(rates, 2, 1, 32) == [*READING_PATTERNS, *names[:3], names[5]]
    assert going_on(rates, 2, 1, 7) == [*READING_PATTERNS, *names[:3]]


def test_patterns_near_the_best_are_searched_again_the_best_first():
    best = {"none": (-5.0, -3.9), "input/lower": (-9.0, -2.0), "input/upper": (-4.1, -30.0)}
    found = pd.DataFrame(
        [(name, at) for name, two in best.items() for at in two], columns=["pattern", LOG_LIKELIHOOD]
    )
    assert searched_again(found, 2.0) == ["input/lower", "none"]
    assert searched_again(found, 2.1) == ["input/lower", "none", "input/upper"]
    assert searched_again(found, 0.0) == ["input/lower"]


BUDGET = Budget(8, generations=15, seed=3, starts=2, by_mean=2, by_upper=2, places=8, again_within=1.0)
PLAUSIBLE = Plausible(SPACE, tuple(half_turn_patterns()), seed=1)


def every_pattern():
    """Two random inputs under each pattern; the statement holds under the two last ones."""
    rows = PLAUSIBLE.rows_by_pattern(range(64))
    last = list(half_turn_patterns())[-2:]
    return pd.DataFrame([judged(float(row["pattern"] in last), 1.0) | row for row in rows])


def test_places_of_the_first_round_start_at_random_and_those_left_over_at_nothing():
    starts = [start_at(place, 0, PLAUSIBLE, LIKELIHOOD, every_pattern(), None, BUDGET) for place in range(8)]
    patterns = [name for name, first in starts if len(first)]
    assert set(patterns) == {*READING_PATTERNS, *list(half_turn_patterns())[-2:]}
    assert all((first == starts[0][1]).all() for _, first in starts[: len(patterns)])
    other = start_at(0, 1, PLAUSIBLE, LIKELIHOOD, every_pattern(), None, BUDGET)
    assert other[0] == starts[0][0] and not np.isin(other[1], starts[0][1]).any()
    assert {name for name, first in starts[len(patterns) :]} == {""} and len(patterns) < 8


def test_the_second_round_starts_from_the_best_points_of_everything_before():
    budget = replace(BUDGET, population=2)
    first_round = every_pattern().head(40).assign(**{LOG_LIKELIHOOD: -np.arange(40.0)})
    near, far = (
        start_at(place, 0, PLAUSIBLE, LIKELIHOOD, every_pattern(), first_round, budget) for place in (1, 2)
    )
    assert near[0] == first_round["pattern"][1] and far[0] == ""
    assert near[1].shape == (2, len(COORDINATES))
    rows = first_round[first_round["pattern"] == near[0]]
    assert near[1][0] == pytest.approx(SPACE.unit(rows.iloc[0]))


def test_a_search_without_points_finds_nothing(tmp_path):
    judge = Known({}, pd.DataFrame(), [STATEMENT, NUMBER])
    none = np.empty((0, len(COORDINATES)))
    found = search_pattern(judge, LIKELIHOOD, SPACE, "", none, BUDGET, 0, tmp_path / "partial", "same")
    assert found.empty and {LOG_LIKELIHOOD, START, "repeat"} <= {*found} and (tmp_path / "partial").exists()


class Known(ClaimJudge):
    """A judge whose one number is known without a run: how far inputs are from 400 N m, and 0.1 more from
    the second start.
    """

    def found(self, row, run=0, start=0):
        value = 1.7 + 0.1 * start + abs(np.log(row["per_input_n_m"] / 400.0))
        return judged(0.0, value)


def search(path, judge_type=Known, repeat=0):
    first = np.random.default_rng(1).random((8, len(COORDINATES)))
    judge = judge_type({}, pd.DataFrame(), [STATEMENT, NUMBER])
    return search_pattern(judge, LIKELIHOOD, SPACE, "input/lower", first, BUDGET, repeat, path, "same")


def test_search_finds_the_likeliest_inputs_and_goes_on_where_it_was_killed(tmp_path):
    found = search(tmp_path / "partial")
    assert len(found) == 8 * 16 * 2 and set(found["pattern"]) == {"input/lower"}
    best = found.loc[found[LOG_LIKELIHOOD].idxmax()]
    first = found.head(16).loc[found.head(16)[LOG_LIKELIHOOD].idxmax()]
    assert abs(best["mean value"] - 1.7) < 0.3 * abs(first["mean value"] - 1.7)
    other = search(tmp_path / "other", repeat=1)
    assert set(other["repeat"]) == {1} and set(found["repeat"]) == {0}
    assert other["per_input_n_m"].tolist() != found["per_input_n_m"].tolist()
    (tmp_path / "half").write_bytes(b"\n".join((tmp_path / "partial").read_bytes().split(b"\n")[:50]) + b"\n")
    again = search(tmp_path / "half")
    pd.testing.assert_frame_equal(again, found)

    class Killed(Known):
        def found(self, row, run=0, start=0):
            raise AssertionError("evaluated again")

    pd.testing.assert_frame_equal(search(tmp_path / "partial", Killed), found)


def test_claims_that_exclude_each_other_are_found_and_rare_ones_are_not_blamed():
    held = pd.DataFrame({"leans": [1.0, 0.0] * 20, "other": [0.0, 1.0] * 20, "jump": [1.0] + 39 * [0.0]})
    pairs = never_together(held.assign(error="", weight=1.0), CLAIMS)
    assert pairs[["first", "second"]].to_numpy().tolist() == [["leans", "other"]]
    assert pairs["expected"][0] == pytest.approx(10.0)
    thrice = pd.concat([held] * 3).assign(error="", weight=1.0 / 3.0)  # from three starts each
    pd.testing.assert_frame_equal(never_together(thrice, CLAIMS), pairs)
    unjudged = pd.concat([held, pd.DataFrame({"leans": 100 * [1.0]})], ignore_index=True)
    again = never_together(unjudged.assign(error="", weight=1.0), CLAIMS)
    assert again["judged"].tolist() == [40] and again["expected"].tolist() == pairs["expected"].tolist()


def test_another_run_that_plays_the_paper_is_met_where_held_out_claims_follow_from_fitted_ones():
    """Of 40 inputs the number decides the held-out claim; in invented papers it decides nothing."""
    rows = []
    for sample in range(40):
        value = 1.0 + 0.05 * sample
        rows.append(judged(float(sample % 2), value, 0.0, float(sample >= 20), sample=sample))
    counts = null_counts(pd.DataFrame(rows), [STATEMENT, NUMBER, HELD_OUT], papers=30, seed=1)
    assert counts["paper"].tolist() == [THIS] + 30 * [ANOTHER] + 30 * [INVENTED]
    held_out = counts.groupby("paper")["held_out"].mean()
    assert held_out[ANOTHER] > held_out[INVENTED] + 0.15
    assert counts.groupby("paper")["fitted"].min()[ANOTHER] >= 1


def test_fewer_random_inputs_than_papers_play_the_paper_once_each():
    rows = [judged(float(sample % 2), 1.0 + 0.1 * sample, sample=sample) for sample in range(8)]
    counts = null_counts(pd.DataFrame(rows), [STATEMENT, NUMBER, HELD_OUT], papers=30, seed=1)
    assert counts["paper"].tolist() == [THIS] + 8 * [ANOTHER] + 30 * [INVENTED]
