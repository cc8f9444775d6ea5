"""Runs that differ by rounding and start, and the stored ones of the committed config."""

import copy
import math
from pathlib import Path

import pandas as pd
import pytest

from facegear.config.load import load_values
from facegear.paper.config.reproduction import read_reproduction
from facegear.paper.identify.cases import settings_key
from facegear.paper.identify.claim_judge import ClaimJudge
from facegear.paper.identify.perturbed import SIZE, perturbed
from facegear.paper.identify.repeated import one_run, run_columns, run_table, runs_of_config
from facegear.paper.identify.sets import set_cases, stored_sets
from facegear.paper.scorecard.base_rates import RATE_COLUMNS
from facegear.paper.scorecard.claims import Claim, read_claims
from facegear.paper.scorecard.rows import OUTCOME_COLUMNS, RUN_COLUMNS, scorecard

ROOT = Path(__file__).parents[4]
VALUES = load_values([ROOT / "config" / "paper.yaml"], {})
STORED = read_reproduction(ROOT / "config" / "reproduction" / "paper.yaml")


def changes(before, after, place=""):
    """Relative change of every number, by its place; what is no number must be equal."""
    if isinstance(before, dict):
        assert before.keys() == after.keys()
        return {
            at: by for key in before for at, by in changes(before[key], after[key], f"{place}.{key}").items()
        }
    if isinstance(before, list | tuple):
        return {
            at: by
            for row in range(len(before))
            for at, by in changes(before[row], after[row], f"{place}.{row}").items()
        }
    if isinstance(before, float) and before:
        return {place: after / before - 1.0}
    assert before == after
    return {}


def test_a_perturbed_run_moves_every_number_of_the_machine_by_rounding_and_nothing_else():
    assert perturbed(VALUES, 0) == VALUES
    by = changes(VALUES, perturbed(VALUES, 1))
    moved = {place for place, change in by.items() if change}
    assert {".transmission.torque.per_input_n_m", ".transmission.backlash_um"} <= moved
    assert {place.split(".")[1] for place in moved} == {"transmission", "mesh_stiffness"}
    machine = [place for place in by if place.startswith(".transmission")]
    assert moved.issuperset(machine)
    assert all(abs(by[place]) == pytest.approx(SIZE, rel=1e-3) for place in moved)
    assert by != changes(VALUES, perturbed(VALUES, 2))


def test_run_table_counts_the_runs_that_judged_a_claim_and_those_that_hold_it():
    nan = float("nan")
    runs = pd.DataFrame([[1.0, 1.7, 0.0, 2.0], [0.0, 1.9, nan, nan]], columns=run_columns(["one", "two"]))
    table = run_table("a", runs, ["one", "two"], "key").set_index("id")
    assert table["held"].tolist() == [1, 0]
    assert table["runs"].tolist() == [2, 1]
    assert (table.loc["one", "low"], table.loc["one", "high"]) == (1.7, 1.9)
    assert table["at_rest"].tolist() == [True, False]


class Counted(ClaimJudge):
    """A judge that tells which run it made, from which start, and for which claims."""

    def outcomes(self, row, run=0, start=0):
        value = run + 0.1 * start
        return pd.DataFrame({"id": self.names, "holds": True, "value": [value] * len(self.names)})


def test_runs_without_a_sweep_judge_the_other_claims_alone():
    claims = [Claim(id=name, where="", claim="", criterion=name) for name in ("jump_leans", "lowest_at")]
    evaluate = one_run(Counted({}, pd.DataFrame(), claims), None, swept=1, starts=1)
    assert evaluate(0)["jump_leans value"] == evaluate(0)["lowest_at value"] == 0.0
    assert evaluate(1)["lowest_at value"] == 1.0 and evaluate(1)["lowest_at holds"] == 1.0
    assert math.isnan(evaluate(1)["jump_leans value"]) and math.isnan(evaluate(1)["jump_leans holds"])


def test_runs_take_the_starts_in_turn():
    claims = [Claim(id="lowest_at", where="", claim="", criterion="lowest_at")]
    evaluate = one_run(Counted({}, pd.DataFrame(), claims), None, swept=9, starts=3)
    assert [evaluate(run)["lowest_at value"] for run in range(5)] == [0.0, 1.1, 2.2, 3.0, 4.1]


@pytest.mark.parametrize(
    ("section", "key", "value", "same"),
    [
        ("dynamics", "sweep", {**VALUES["dynamics"]["sweep"], "chunks": 2}, True),
        ("mesh", "thin_fillet", False, True),
        ("transmission", "backlash_um", 100.0 + 1e-9, False),
        ("load_sharing", "cycles", 300, False),
    ],
)
def test_stored_runs_count_only_for_the_settings_that_decide_them(section, key, value, same):
    other = copy.deepcopy(VALUES)
    other[section][key] = value
    keys = [settings_key(*set_cases(values, None)) for values in (VALUES, other)]
    assert (keys[0] == keys[1]) == same


def test_stored_runs_are_those_of_the_committed_config_and_of_every_set():
    """Where this fails the config or a set was changed: renew the runs with `snakemake identify`."""
    stored, sets = pd.read_csv(STORED.runs), stored_sets(STORED.sets)
    kept = runs_of_config(stored, VALUES, sets)
    dynamic = {claim.id for claim in read_claims(STORED.claims).claims if claim.dynamic}
    assert set(kept["set"]) == {"config", *sets}
    for _, rows in kept.groupby("set"):
        assert set(rows["id"]) == dynamic
    assert dynamic <= set(pd.read_csv(STORED.random).columns)


def test_the_likely_config_is_the_recommended_set_and_has_its_runs():
    likely = load_values([ROOT / "config" / "paper_likely.yaml"], {})
    sets = pd.read_csv(STORED.sets).set_index("set")
    (recommended,) = sets.index[sets["recommended"]]
    kept = runs_of_config(pd.read_csv(STORED.runs), likely, stored_sets(STORED.sets))
    assert set(kept["set"]) == {"config", *sets.index} - {recommended}
    stored = pd.read_csv(STORED.runs).query("set == @recommended")
    own = kept[kept["set"] == "config"]
    assert own["held"].tolist() == stored["held"].tolist()


def test_runs_that_differ_by_rounding_agree_or_the_row_is_undecided():
    """Whichever stored run is the own one, the verdicts are the same: where runs differ it is undecided."""
    claims = [claim for claim in read_claims(STORED.claims).claims if claim.dynamic]
    stored = pd.read_csv(STORED.runs)
    own = stored[stored["set"] == "config"].set_index("id")
    assert (own["runs"] >= 3).all()
    rates = pd.DataFrame(columns=list(RATE_COLUMNS))
    verdicts = []
    for holds in (own["held"] > 0, own["held"] == own["runs"]):  # the runs that say yes most, and least often
        found = [
            (
                one.id,
                None if one.paper is None else float(own["low"][one.id]),
                "",
                bool(holds[one.id]),
                None,
                "",
                0.0,
            )
            for one in claims
        ]
        outcomes = pd.DataFrame(found, columns=list(OUTCOME_COLUMNS))
        frame = scorecard(claims, outcomes, stored[list(RUN_COLUMNS)], rates)
        verdicts.append(frame["verdict"].tolist())
    assert verdicts[0] == verdicts[1]
    split = (own["held"] > 0) & (own["held"] < own["runs"])
    undecided = {one.id for one, verdict in zip(claims, verdicts[0], strict=True) if verdict == "undecided"}
    assert undecided == set(own.index[split])


def test_stored_runs_from_rest_are_among_the_stored_runs_of_each_claim():
    stored = pd.read_csv(STORED.runs)
    at_rest = stored["at_rest"].astype(bool)
    assert (stored.loc[at_rest, "held"] > 0).all()
    assert (stored.loc[~at_rest, "held"] < stored.loc[~at_rest, "runs"]).all()
