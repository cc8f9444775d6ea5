"""The stored runs of the committed config, which differ by rounding and start."""

import copy
from pathlib import Path

import pandas as pd
import pytest

from facegear.build.load import load_config
from paper.reproduction import read_reproduction
from paper.scorecard.base_rates import RATE_COLUMNS
from paper.scorecard.claims import read_claims
from paper.scorecard.rows import OUTCOME_COLUMNS, RUN_COLUMNS, scorecard
from paper.stored.cases import settings_key
from paper.stored.runs import runs_of_config
from paper.stored.sets import set_cases, stored_sets

ROOT = Path(__file__).parents[2]
VALUES = load_config(ROOT / "config" / "paper.yaml").model_dump(mode="json")
STORED = read_reproduction(ROOT / "config" / "reproduction" / "paper.yaml")


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
    """A changed config or set fails here: docs/explanation/load_sharing.md says how runs are renewed."""
    stored, sets = pd.read_csv(STORED.runs), stored_sets(STORED.sets)
    kept = runs_of_config(stored, VALUES, sets)
    dynamic = {claim.id for claim in read_claims(STORED.claims).claims if claim.dynamic}
    assert set(kept["set"]) == {"config", *sets}
    for _, rows in kept.groupby("set"):
        assert set(rows["id"]) == dynamic
    assert dynamic <= set(pd.read_csv(STORED.random).columns)


def test_the_likely_config_is_the_recommended_set_and_has_its_runs():
    likely = load_config(ROOT / "config" / "paper_likely.yaml").model_dump(mode="json")
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
