"""Likely inputs at full accuracy: all of the region, the order of the best, and those that are kept."""

import numpy as np
import pandas as pd
import pytest

from facegear.paper.identify.claim_judge import ClaimJudge
from facegear.paper.identify.confirmed import accurate_region, confirmed_inputs, kept_sets
from facegear.paper.identify.inputs import COORDINATES, Space
from facegear.paper.identify.likelihood import Likelihood
from facegear.paper.identify.motions import LOG_LIKELIHOOD, OF_MOTION, START
from facegear.paper.scorecard.claims import Claim

SPACE = Space((100.0, 1000.0), (0.0, 0.4), (0.5, 2.5), (1e8, 1e10), (120.0, 450.0), gears=2)
CLAIM = Claim(id="leans", where="a", claim="", criterion="lowest_at", fitted=True)
LIKELIHOOD = Likelihood((CLAIM,), np.array([2.0]))
PATTERNS = ("input/lower", "input/lower", "none")


def region():
    """Three inputs, the first the most likely by quick runs."""
    rows = [
        SPACE.row([at] * len(COORDINATES), name) for at, name in zip((0.5, 0.4, 0.3), PATTERNS, strict=True)
    ]
    return pd.DataFrame(rows).assign(**{LOG_LIKELIHOOD: [-1.0, -2.0, -3.0]})


class Wavering(ClaimJudge):
    """A judge whose claim fails from the second start of the inputs with the largest torque."""

    def found(self, row, run=0, start=0):
        return {"leans": float(not (start == 1 and row["per_input_n_m"] > 300.0))}


def test_the_whole_region_is_judged_from_every_start_beside_what_quick_runs_said(tmp_path):
    judge = Wavering({}, pd.DataFrame(), [CLAIM])
    motions = pd.concat([region(), region()])  # as stored: a row a motion
    found = accurate_region(judge, LIKELIHOOD, motions, 2, tmp_path / "partial", "same")
    assert found[START].tolist() == [0, 1, 0, 1, 0, 1]
    assert found["quick_log_likelihood"].tolist() == [-1.0, -1.0, -2.0, -2.0, -3.0, -3.0]
    assert found[OF_MOTION].tolist() == [2.0, 0.0, 2.0, 2.0, 2.0, 2.0]
    assert found["fitted"].tolist() == [1, 0, 1, 1, 1, 1] and not found["held_out"].any()


def test_all_starts_decide_and_the_best_of_each_pattern_is_kept(tmp_path):
    judge = Wavering({}, pd.DataFrame(), [CLAIM])
    found = confirmed_inputs(judge, LIKELIHOOD, region(), 3, tmp_path / "partial", "same")
    wavering = np.log((2.0 * np.exp(2.0) + np.exp(0.0)) / 3.0)
    assert found[LOG_LIKELIHOOD].tolist() == pytest.approx([2.0, 2.0, wavering])
    assert found["least_log_likelihood"].tolist() == [2.0, 2.0, 0.0]
    assert found["tail_share"].is_monotonic_increasing  # of equals the one with the smaller share at the tail
    assert found["quick_log_likelihood"].tolist() == [-3.0, -2.0, -1.0]
    assert all(float(f"{value:.4g}") == value for value in found["per_input_n_m"])
    sets = kept_sets(found, 4)
    assert sets["set"].tolist() == ["a", "b"] and sets["recommended"].tolist() == [True, False]
    assert sets["pattern"].tolist() == ["none", "input/lower"]
