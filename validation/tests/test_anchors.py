"""Configs of public measurements, and the stored scorecard of them."""

import numpy as np
import pandas as pd
import pytest

from facegear.build.load import load_config
from facegear.schema.yaml_file import read_yaml
from validation.anchors import (
    COLUMNS,
    CONFIGS,
    KRANTZ,
    LARGEST_SHARE,
    TABLE,
    clocking_rows,
    clocking_window,
    published_rows,
    shares,
    split_path,
)


def stored():
    return pd.read_csv(TABLE, dtype=str, keep_default_na=False)


@pytest.mark.parametrize("name", sorted(path.stem for path in CONFIGS.glob("*.yaml")))
def test_the_config_of_an_anchor_has_no_mistakes_and_says_what_is_known_and_what_is_not(name):
    path = CONFIGS / f"{name}.yaml"
    assert load_config(path).case == name
    words = path.read_text(encoding="utf-8")
    assert "# Anchor: " in words and ("extends" in read_yaml(path) or "Not known: " in words)


def lengths(section, where=""):
    """Keys in mm and um of a config with their numbers."""
    for key, value in section.items():
        if isinstance(value, dict):
            yield from lengths(value, f"{where}{key}.")
        elif key.endswith(("_mm", "_um")) and isinstance(value, float | int) and key != "offset_um":
            yield f"{where}{key}", float(value)


def test_every_length_of_the_half_scale_gears_is_halved_and_their_torque_is_an_eighth():
    full, half = (load_config(CONFIGS / f"{name}_scale.yaml") for name in ("full", "half"))
    given = [dict(lengths(config.model_dump(include={"tooth_pair", "mesh"}))) for config in (full, half)]
    changed = {key for key, value in given[0].items() if value}
    assert len(changed) >= 12
    assert {key: 2.0 * given[1][key] for key in changed} == {key: given[0][key] for key in changed}
    assert half.contact.torques_n_m == tuple(torque / 8.0 for torque in full.contact.torques_n_m)
    assert half.dynamics.speed_rpm == full.dynamics.speed_rpm


def test_clocking_makes_the_paths_of_the_split_equal_and_its_range_is_the_stored_one():
    machine = split_path()
    even, half = clocking_window(machine)
    for clocking, largest in ((even, 0.5), (even - half, LARGEST_SHARE), (even - 5.0 * half, 0.65)):
        assert shares(machine, np.degrees(clocking)).max() == pytest.approx(largest, abs=1e-4)
    rows = pd.DataFrame(list(clocking_rows()), columns=list(COLUMNS))
    kept = stored()
    pd.testing.assert_frame_equal(rows, kept[kept["source"] == KRANTZ].reset_index(drop=True))


def test_published_spur_gears_in_the_scorecard_are_those_of_the_table_of_references():
    rows = pd.DataFrame(list(published_rows()), columns=list(COLUMNS))
    kept = stored()
    assert len(rows) >= 10 and set(rows["verdict"]) != {"differs"}
    pd.testing.assert_frame_equal(rows, kept[kept["source"].isin(rows["source"])].reset_index(drop=True))
