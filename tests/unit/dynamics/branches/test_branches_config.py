"""The shipped config that asks for branches."""

from pathlib import Path

import facegear

CONFIG = Path(__file__).parents[4] / "config" / "branches.yaml"


def test_the_shipped_config_finds_the_folds_at_which_its_sweeps_jump():
    """No shipped config asked for branches. Both ends of the range in which two motions exist are folds."""
    gearbox = facegear.load(CONFIG, results=None)
    jumps = gearbox.sweep().jumps().set_index("direction")
    found = gearbox.branches()
    special = found.special_points()
    folds = sorted(special.loc[special["kind"] == "fold", "speed_rpm"])
    ends = jumps.loc[["down", "up"], ["speed_before_rpm", "speed_after_rpm"]].mean(axis=1)
    assert len(folds) == 2
    assert all(abs(fold - end) < 1.5 for fold, end in zip(folds, ends, strict=True))
    assert folds[0] < gearbox.values["dynamics"]["speed_rpm"] < folds[1]
