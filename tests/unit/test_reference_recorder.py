"""The assertion that compares with references fails where it should, and records what it compared."""

import numpy as np
import pytest
import references
from references import against, agrees

DECLARED = {"capability": "geometry", "module": "facegear.teeth.limits"}


@pytest.mark.parametrize(
    ("computed", "expected", "tolerance"),
    [
        (1.1, 1.0, {"relative": 0.09}),
        (1.0, 0.0, {"relative": 0.5}),
        ([1.0, 2.0], [1.0, 2.1], {"absolute": 0.05}),
        (np.nan, 1.0, {"absolute": 1.0}),
        (1.0, np.nan, {"absolute": 1.0}),
        (1.7, 2.0, {"absolute": 0.2, "at_least": True}),
        (1.0 + 0.1j, 1.0, {"absolute": 0.05}),
        ([], [], {"absolute": 1.0}),
    ],
)
def test_numbers_that_disagree_or_are_missing_are_refused(computed, expected, tolerance):
    with pytest.raises(AssertionError):
        agrees("length, m", computed, expected, **tolerance)


def test_the_kind_of_a_reference_is_one_of_the_known_ones():
    with pytest.raises(ValueError, match="hearsay"):
        against("hearsay", "somebody", **DECLARED)


def test_the_record_holds_the_element_that_agrees_worst(monkeypatch):
    with monkeypatch.context() as patch:
        patch.setattr(references, "_rows", {})
        agrees("length, m", [1.0, 2.02, 3.0], [1.0, 2.0, 3.01], relative=0.1)
        agrees("length, m", 4.1, 4.0, absolute=100.0)
        row = references._rows["length, m"]
    assert (row["expected"], row["computed"], row["tolerance"]) == (2.0, 2.02, 0.2)
