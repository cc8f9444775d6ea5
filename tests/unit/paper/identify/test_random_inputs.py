"""Random plausible inputs: by number, within their ranges, patterns that differ."""

import copy
from collections import Counter
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from facegear.config.cases import set_key
from facegear.config.load import load_values
from facegear.config.machines import case_machine
from facegear.harmonics.series import Harmonics
from facegear.paper.identify.claim_judge import QUICK, ClaimJudge
from facegear.paper.identify.inputs import CHOICES, Space
from facegear.paper.identify.patterns import READING_PATTERNS, READINGS, half_turn_patterns
from facegear.paper.identify.random_inputs import Plausible
from facegear.paper.identify.random_verdicts import judged_samples
from facegear.paper.scorecard.claims import Claim, read_claims
from facegear.paper.scorecard.criteria import reads_sweep
from facegear.scenarios.chunks import identity

CONFIG = Path(__file__).parents[4] / "config"
VALUES = load_values([CONFIG / "paper.yaml"], {})
STIFFNESS = Harmonics(np.zeros(2), np.array([4.1e8, 2e7]))
SPACE = Space((80.0, 2000.0), (0.0, 0.45), (0.5, 2.5), (1e8, 1e10), (100.0, 900.0), gears=2)
DRAWN = Plausible(SPACE, tuple(READINGS), seed=1)
PATTERNS = Plausible(SPACE, tuple(half_turn_patterns()), seed=1)


@pytest.mark.parametrize("split", [1, 5, 15])
def test_samples_are_the_same_in_chunks_of_any_size(split):
    for rows in (DRAWN.rows, PATTERNS.rows_by_pattern):
        assert rows(range(split)) + rows(range(split, 16)) == rows(range(16))


def test_inputs_fill_their_ranges_and_every_choice_is_drawn():
    rows = DRAWN.rows(range(64))
    torques = [row["per_input_n_m"] for row in rows]
    assert 80.0 <= min(torques) < 100.0 and 1600.0 < max(torques) <= 2000.0
    assert sum(torque < 400.0 for torque in torques) == pytest.approx(32, abs=2)  # logarithmic
    for name, count in (("pattern", 3), *((name, len(kind)) for name, kind in CHOICES.items())):
        drawn = Counter(row[name] for row in rows)
        assert len(drawn) == count and min(drawn.values()) > 64 / count / 2
    assert all(100.0 <= row["stiffness_torque_n_m"] <= 900.0 for row in rows)


def test_every_pattern_meets_the_same_other_inputs():
    rows = PATTERNS.rows_by_pattern(range(64))
    assert [row["pattern"] for row in rows[:32]] == [row["pattern"] for row in rows[32:]]
    assert len({row["pattern"] for row in rows}) == 32
    others = [{key: value for key, value in row.items() if key != "pattern"} for row in rows]
    assert others[0] == others[31] != others[32] == others[63]


def lags(phasing, convention):
    values = copy.deepcopy(VALUES)
    set_key(values, "transmission.transmission_error.phasing", phasing)
    set_key(values, "transmission.phase_convention", convention)
    found = case_machine(values, STIFFNESS).error_phases
    return tuple(np.round((found - found[5]) % 1.0, 9) % 1.0)  # against the tail idler's upper mesh


def test_patterns_differ_and_every_reading_of_the_paper_is_one_of_them():
    found = {lags(pattern, "geometric") for pattern in half_turn_patterns().values()}
    assert len(found) == 32
    readings = {lags(one, by) for one in READINGS.values() for by in ("geometric", "printed")}
    assert readings == {lags(half_turn_patterns()[name], "geometric") for name in READING_PATTERNS}
    assert readings <= found


def contact_table():
    """Mesh stiffness that grows with the load, made up."""
    torques, positions = np.meshgrid([100.0, 1000.0], np.arange(16) / 16, indexing="ij")
    curve = (3e8 + 1e5 * torques) * (1.0 + 0.08 * np.sin(2.0 * np.pi * positions))
    columns = {
        "torque_n_m": torques,
        "position": positions,
        "ste_um": 0.0 * curve,
        "unloaded_ste_um": 0.0 * curve,
    }
    columns |= {"k_average_n_per_m": curve, "k_local_n_per_m": curve}
    return pd.DataFrame({name: values.ravel() for name, values in columns.items()})


def test_what_was_found_before_a_claim_a_setting_or_an_input_changed_counts_no_more():
    """The text of a claim was no part of it: after an edit a killed chunk went on with old verdicts."""
    claim = Claim(id="mean", where="", claim="", criterion="sharing", paper=1.7, tolerance=0.2)
    judge = ClaimJudge(VALUES, contact_table(), [claim], QUICK)
    others = (
        replace(judge, claims=[claim.model_copy(update={"tolerance": 0.1})]),
        replace(judge, settings={}),
        replace(judge, values={**VALUES, "studies": []}),
        replace(judge, ltca=contact_table().assign(ste_um=1.0)),
    )
    same = identity(judge.deciding)
    assert same == identity(replace(judge).deciding)
    assert same not in [identity(other.deciding) for other in others]


class Undefined(ClaimJudge):
    """A judge of a coefficient that has a value for some inputs only."""

    def outcomes(self, row, run=0, start=0):
        return pd.DataFrame({"id": ["mean"], "holds": [False], "value": [row["value"]], "spread": [0.0]})


def test_a_number_that_is_undefined_is_kept_as_not_a_number():
    claim = Claim(id="mean", where="", claim="", criterion="sharing", paper=1.7, tolerance=0.2)
    judge = Undefined({}, pd.DataFrame(), [claim])
    assert judge.found({"value": 1.5}) == {"mean": 0.0, "mean value": 1.5, "mean spread": 0.0}
    assert np.isnan(judge.found({"value": None})["mean value"])
    assert judge.columns == ["mean", "mean value", "mean spread"]


def test_a_judge_reads_the_motion_from_the_start_that_is_asked_for():
    """With the eighth random inputs the backlash study has other motions from other starts."""
    claims = [
        one for one in read_claims(CONFIG / "claims" / "paper.yaml").claims if one.criterion == "sharing"
    ]
    claims = [one for one in claims if one.args["study"] == "backlash"]
    judge = ClaimJudge(VALUES, contact_table(), claims, QUICK)
    found = [pd.Series(judge.found(DRAWN.rows([7])[0], start=start)) for start in (0, 0, 1)]
    pd.testing.assert_series_equal(found[0], found[1])
    values = [f"{claim.id} value" for claim in claims]
    assert (found[0][values] - found[2][values]).abs().max() > 0.05


def test_random_inputs_are_judged_and_a_chunk_that_was_killed_goes_on(tmp_path):
    claims = [one for one in read_claims(CONFIG / "claims" / "paper.yaml").claims if one.dynamic]
    claims = [one for one in claims if not reads_sweep(one.criterion)]
    judge = ClaimJudge(VALUES, contact_table(), claims, QUICK)
    first = judged_samples(judge, DRAWN.rows([3]), [3], tmp_path / "partial", "same")
    assert first["error"].tolist() == [""]
    assert set(first[judge.names].to_numpy().ravel()) == {0.0, 1.0}
    numbers = [claim for claim in claims if claim.paper is not None]
    for claim in numbers:
        value = first[f"{claim.id} value"][0]
        assert bool(first[claim.id][0]) == (abs(value - claim.paper) <= claim.tolerance * (1.0 + 1e-9))
    kept = ClaimJudge({}, pd.DataFrame(), claims)  # cannot judge anything anew
    again = judged_samples(kept, DRAWN.rows([3]), [3], tmp_path / "partial", "same")
    pd.testing.assert_frame_equal(again, first)
