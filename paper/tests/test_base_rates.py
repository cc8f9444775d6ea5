"""Shares of random inputs that hold a claim, with their intervals, and totals."""

import numpy as np
import pandas as pd
import pytest

from paper.scorecard.base_rates import base_rates, totals
from paper.scorecard.claims import Claim

CLAIMS = [
    Claim(
        id=name, location="text", claim=name, criterion="lost_contact", same_as=same, is_fitted=name == "half"
    )
    for name, same in (("always", None), ("never", None), ("half", None), ("again", "half"))
]


@pytest.fixture
def samples():
    held = {"always": 1.0, "never": 0.0, "half": [1.0, 0.0] * 20, "again": [1.0, 0.0] * 20}
    return pd.DataFrame({"pattern": ["a", "b"] * 20, **held, "error": np.nan}, index=range(40))


def test_claim_that_always_holds_has_a_rate_of_one_and_one_that_never_does_of_zero(samples):
    rates = base_rates(samples, CLAIMS).set_index("id")
    assert rates.loc["always", "share"] == rates.loc["always", "high"] == 1.0
    assert rates.loc["never", "share"] == rates.loc["never", "low"] == 0.0
    assert rates.loc["half", "low"] < rates.loc["half", "share"] == 0.5 < rates.loc["half", "high"]
    assert rates.loc["always", "low"] == pytest.approx(40 / (40 + 1.959964**2), rel=1e-6)  # Wilson


def test_numbers_that_the_paper_repeats_count_once_in_the_totals(samples):
    found = totals(samples, CLAIMS)
    assert found.claims == 3
    assert found.mean == 1.5
    assert (found.share_reaching(2), found.share_reaching(3)) == (0.5, 0.0)


def test_samples_without_a_result_are_left_out(samples):
    samples.loc[0, ["always", "never", "half", "again"]] = np.nan
    samples["error"] = ["no motion"] + [""] * 39
    assert base_rates(samples, CLAIMS)["samples"].tolist() == [39] * 4
    assert totals(samples, CLAIMS).claims_held.size == 39
