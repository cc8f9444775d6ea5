"""The blind protocol: a sealed prediction, its intervals and its verdict are those that are stored."""

import shutil
import subprocess

import numpy as np
import pandas as pd
import pytest

import facegear
from facegear.errors import FacegearError
from validation.blind import (
    MEASUREMENT,
    PREDICTION,
    PROTOCOL,
    SEAL,
    VERDICT,
    compare,
    judge,
    predict,
    quantities_of,
    read_protocol,
    seal_of,
)
from validation.blind.__main__ import main
from validation.references import ROOT

EXAMPLE, TEMPLATE = (ROOT / "validation" / "blind" / name for name in ("example", "template"))
NOISE_SEED = 5
"""Seed of the noise of 1 % on the made-up measurement, which hidden.yaml stands for."""


@pytest.fixture
def copy(tmp_path):
    """A copy of the example that a test may spoil."""
    return shutil.copytree(EXAMPLE, tmp_path / "example")


def test_the_examples_seal_is_that_of_its_files():
    assert (EXAMPLE / SEAL).read_text().split() == [seal_of(EXAMPLE), "SHA-256"]
    commit = read_protocol(EXAMPLE)["commit"]
    assert len(commit) == 40 and int(commit, 16)


def test_the_examples_intervals_are_computed_again():
    stored, anew = pd.read_csv(EXAMPLE / PREDICTION), predict(EXAMPLE)
    pd.testing.assert_frame_equal(stored, anew, rtol=1e-5)


def test_the_examples_measurement_is_that_of_the_hidden_machine():
    hidden = quantities_of(facegear.load(EXAMPLE / "hidden.yaml", None), read_protocol(EXAMPLE))
    noise = np.random.default_rng(NOISE_SEED).standard_normal(len(hidden))
    stored = pd.read_csv(EXAMPLE / MEASUREMENT)
    np.testing.assert_allclose(stored["value"], np.array(hidden) * (1.0 + 0.01 * noise), rtol=1e-4)


def test_the_examples_verdict_is_that_of_its_intervals():
    pd.testing.assert_frame_equal(pd.read_csv(EXAMPLE / VERDICT), compare(EXAMPLE))


@pytest.mark.parametrize("name", ["machine.yaml", PROTOCOL, PREDICTION])
def test_a_file_that_changed_after_it_was_sealed_is_refused(copy, name):
    (copy / name).write_text((copy / name).read_text() + "\n")
    with pytest.raises(FacegearError, match="not those that seal"):
        compare(copy)


def test_a_quantity_that_was_not_predicted_is_refused(copy):
    table = pd.read_csv(copy / MEASUREMENT)
    table.loc[0, "quantity"] = "noise"
    table.to_csv(copy / MEASUREMENT, index=False)
    with pytest.raises(FacegearError, match="'noise' was not predicted"):
        compare(copy)


def test_no_prediction_is_made_beside_its_measurement(copy, capsys):
    assert main(["predict", str(copy)]) == 1
    assert "a prediction comes before its measurement" in capsys.readouterr().err


def test_the_template_is_refused_until_it_is_filled_in():
    with pytest.raises(FacegearError, match="question must be given"):
        read_protocol(TEMPLATE)


@pytest.mark.parametrize(
    ("value", "reach", "verdict"),
    [
        (5.0, 1.0, "inside"),
        (4.0, 1.0, "inside"),
        (3.5, 1.0, "undecided"),
        (2.5, 1.0, "undecided"),
        (1.9, 1.0, "outside"),
        (9.0, 0.5, "outside"),
        (5.0, 9.0, "undecided"),
    ],
)
def test_a_measurement_across_an_end_of_the_interval_is_undecided(value, reach, verdict):
    assert judge(3.0, 8.0, value, reach) == verdict


def test_the_commit_that_the_example_names_is_part_of_the_history():
    commit = read_protocol(EXAMPLE)["commit"]
    shallow = subprocess.run(
        ["git", "-C", str(ROOT), "rev-parse", "--is-shallow-repository"], capture_output=True
    )
    if shallow.returncode or shallow.stdout.strip() == b"true":
        pytest.skip("no whole history")
    found = subprocess.run(
        ["git", "-C", str(ROOT), "cat-file", "-e", f"{commit}^{{commit}}"], capture_output=True
    )
    assert found.returncode == 0
