"""Inputs judged from several starts."""

import numpy as np
import pandas as pd
from hypothesis import given
from hypothesis import strategies as st

from facegear.paper.identify.claim_judge import ClaimJudge
from facegear.paper.identify.inputs import COORDINATES, Space
from facegear.paper.identify.likelihood import Likelihood
from facegear.paper.identify.motions import (
    LOG_LIKELIHOOD,
    OF_MOTION,
    START,
    distinct_inputs,
    judged_motions,
    over_motions,
)
from facegear.paper.scorecard.claims import Claim
from facegear.paper.scorecard.rows import OUTCOME_COLUMNS

SPACE = Space((100.0, 1000.0), (0.0, 0.4), (0.5, 2.5), (1e8, 1e10), (120.0, 450.0), gears=2)
LEANS = Claim(id="leans", where="a", claim="", criterion="lowest_at", fitted=True)
JUMP = Claim(id="jump", where="b", claim="", criterion="jump_leans", fitted=True)
LIKELIHOOD = Likelihood((LEANS, JUMP), np.array([2.0, 1.0]))
ROWS = [SPACE.row([at] * len(COORDINATES), "none") for at in (0.4, 0.6)]


class TwoMotions(ClaimJudge):
    """A judge whose statement holds from rest alone; the claim on the sweep holds for all inputs."""

    def outcomes(self, row, run=0, start=0):
        holds = {"leans": start == 0, "jump": True}
        told = [{**dict.fromkeys(OUTCOME_COLUMNS), "id": one, "holds": holds[one]} for one in self.names]
        return pd.DataFrame(told).assign(value=np.nan, spread=np.nan)


def test_inputs_whose_claims_hold_from_one_start_alone_are_less_likely(tmp_path):
    """They were judged from rest alone: the recommended set lost 12 log units from another start."""
    judge = TwoMotions({}, pd.DataFrame(), [LEANS, JUMP])
    found = judged_motions(judge, LIKELIHOOD, ROWS, 2, tmp_path / "partial", "same")
    assert found[START].tolist() == [0, 1, 0, 1] and len(distinct_inputs(found)) == 2
    assert found["leans"].tolist() == [1.0, 0.0, 1.0, 0.0]
    assert found["jump"].tolist() == [1.0, 1.0, 1.0, 1.0]  # a sweep begins at rest: one for all starts
    assert found[OF_MOTION].tolist() == [3.0, 1.0, 3.0, 1.0]
    np.testing.assert_allclose(found[LOG_LIKELIHOOD], np.log((np.exp(3.0) + np.exp(1.0)) / 2.0))


@given(st.lists(st.floats(-50.0, 5.0), min_size=1, max_size=6))
def test_inputs_are_as_likely_as_their_motions_on_average(of_motions):
    found = over_motions(np.array([of_motions, [float("-inf")] * len(of_motions)]))
    np.testing.assert_allclose(np.exp(found[0]), np.mean(np.exp(of_motions)))
    assert found[1] == float("-inf")  # no motion has a result
