"""The shipped config that asks for branches."""

from pathlib import Path

import numpy as np

import facegear

CONFIG = Path(__file__).parents[4] / "config" / "branches.yaml"


def test_the_shipped_config_finds_the_folds_at_which_its_sweeps_jump_and_those_of_two_motions_beside():
    """No shipped config asked for branches. Both ends of the range in which the sweeps differ are folds.

    The other four are those of the two motions that random starts alone meet, as starts drawn in another way
    and moved by 1e-12 found them, too.
    """
    gearbox = facegear.load(CONFIG, results=None)
    jumps = gearbox.sweep().jumps().set_index("direction")
    found = gearbox.branches()
    special, images = found.special_points(), found.images()
    special = special[~special["branch"].isin(images["branch"])]
    folds = np.sort(special.loc[special["kind"] == "fold", "speed_rpm"])
    ends = jumps.loc[["down", "up"], ["speed_before_rpm", "speed_after_rpm"]].mean(axis=1)
    assert len(folds) == 6
    assert (abs(folds[[0, -1]] - ends) < 1.5).all()
    assert abs(folds[1:-1] - [5973.671, 5979.157, 6090.257, 6518.335]).max() < 0.001
    assert ends["down"] < gearbox.values["dynamics"]["speed_rpm"] < ends["up"]
    assert found.content["coexistence"]["branch"].nunique() == 3
    assert images.to_dict("list") == {"branch": [2], "image_of": [1]}
    assert found.ranges()["branches"].tolist()[1] == "0 0 1 2 3"
