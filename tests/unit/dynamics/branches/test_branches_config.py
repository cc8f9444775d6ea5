"""The shipped config that asks for branches."""

from pathlib import Path

import facegear

CONFIG = Path(__file__).parents[4] / "config" / "branches.yaml"


def test_the_shipped_config_finds_the_folds_at_which_its_sweeps_jump():
    """No shipped config asked for branches. Both ends of the range in which two motions exist are folds.

    Random starts begin in coordinates whose basis is the processor's: on some they find further motions, with
    folds of their own.
    """
    gearbox = facegear.load(CONFIG, results=None)
    jumps = gearbox.sweep().jumps().set_index("direction")
    found = gearbox.branches()
    special = found.special_points()
    folds = special.loc[special["kind"] == "fold", "speed_rpm"]
    ends = jumps.loc[["down", "up"], ["speed_before_rpm", "speed_after_rpm"]].mean(axis=1)
    assert all((folds - end).abs().min() < 1.5 for end in ends)
    assert ends["down"] < gearbox.values["dynamics"]["speed_rpm"] < ends["up"]
