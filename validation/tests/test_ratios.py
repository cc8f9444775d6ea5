"""Ratios of processor time against an earlier commit, and what they say of the answers."""

from pathlib import Path

import numpy as np
import pytest

import facegear
from facegear.pipeline.table import STAGES
from validation.ratios.points import POINTS, Point
from validation.ratios.run import COLUMNS, changes, ratio

MOTIONS = np.array(["period-1", "chaotic", "period-2", "period-1"])


def test_code_is_measured_beside_itself_with_the_same_answers(tmp_path):
    point = Point("config/harmonics_only.yaml", "modal", "s", "docs/theory.md", amount=2)
    here = np.ones(80_000_000)  # 640 MB that are not the job's
    row = ratio("modal", point, (Path.cwd(), Path.cwd()), tmp_path, turns=1)
    assert 50.0 < row["memory_now_mb"] < 600.0 < here.nbytes / 2**20
    assert tuple(row) == COLUMNS
    assert row["change"] == 0.0 and row["labels_changed"] == 0
    assert row["before"] > 0.0 and row["ratio"] == pytest.approx(row["now"] / row["before"])


def test_numbers_of_irregular_motions_and_of_changed_labels_do_not_count_as_changes():
    value = np.array([[1.0], [2.0], [3.0], [4.0]])
    moved = value * np.array([[1.0], [1.5], [1.0 + 1e-7], [2.0]])
    now = np.where(np.arange(4) == 3, "irregular", MOTIONS)
    change, equal, labels_changed, labels = changes(
        {"motion": MOTIONS, "rms": value}, {"motion": now, "rms": moved}
    )
    assert equal == 0.5
    assert change == pytest.approx(1e-7, rel=1e-6)
    assert (labels_changed, labels) == (1, 4)


def test_a_motion_of_another_period_counts_by_its_label_and_residuals_of_solved_contacts_do_not():
    before = {
        "motion": np.array(["periodic", "periodic"]),
        "period": np.array([1, 2]),
        "rms": np.array([1.0, 2.0]),
    }
    now = {**before, "period": np.array([1, 4]), "rms": np.array([1.0, 3.0])}
    assert changes(before, now)[0] == 0.0
    assert changes({"kkt_residual": np.array([1e-16])}, {"kkt_residual": np.array([5e-16])})[0] == 0.0
    assert changes({"kkt_residual": np.array([1e-16])}, {"kkt_residual": np.array([1e-9])})[0] > 0.0


def test_differences_of_like_numbers_are_compared_down_to_rounding():
    before, now, other = ({"0/k_gamma_missed": np.array([number])} for number in (1e-15, -4e-16, 1e-9))
    assert changes(before, now)[0] == 0.0
    assert changes(before, other)[0] > 0.0


def test_arrays_of_another_shape_are_no_small_change():
    assert changes({"k": np.ones(3)}, {"k": np.ones(4)})[0] == np.inf


def test_every_point_is_a_job_of_the_workflow_and_says_where_its_error_stands():
    for point in POINTS.values():
        facegear.load(point.config, results=None).with_values(point.changes)
        assert set(STAGES[point.stage].wildcards) == set(point.wildcards)
        assert Path(point.error.partition(",")[0]).is_file()
