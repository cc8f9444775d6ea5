"""Figures of tolerances show what their tables hold."""

import numpy as np
import pandas as pd
import pytest

from facegear.report.figures.description import entries
from facegear.report.figures.marks import Bars, Curve
from facegear.report.figures.tolerances import importance_figure, in_words, load_map_figure, worst_first

WORST, OTHER_MODES = "k_gamma right input/upper", "k_gamma left input/upper"


def table(factors, speeds):
    rows = []
    for factor in factors:
        for speed in speeds:
            for quantity, share in ((WORST, 0.4), (OTHER_MODES, 0.3), ("peak_mesh_force_n", 2e4)):
                for level in (50.0, 95.0, 99.0):
                    value = 1.0 + share / factor + 1e-5 * speed + 1e-4 * level
                    rows.append((factor, speed, quantity, level, value, value - 0.01, value + 0.01, 64, 0))
    columns = [
        "torque_factor",
        "speed_rpm",
        "quantity",
        "percentile",
        "value",
        "low",
        "high",
        "samples",
        "failed",
    ]
    return pd.DataFrame(rows, columns=columns)


@pytest.mark.parametrize(
    ("speeds", "lines", "along"), [((7500.0,), 1, "Torque"), ((1e3, 2e3, 3e3), 2, "speed")]
)
def test_a_map_draws_the_median_and_99th_percentile_of_the_worst_path(speeds, lines, along):
    given = table((0.5, 1.0), speeds)
    figure = load_map_figure(given)
    (panel,) = figure.panels
    own = given[given["quantity"] == WORST]
    curves = [mark for mark in panel.marks if isinstance(mark, Curve)]
    np.testing.assert_array_equal(
        np.sort(np.concatenate([curve.y for curve in curves])),
        np.sort(own[own["percentile"] != 95.0]["value"]),
    )
    assert len(curves) == 2 * lines and along in panel.x.name
    assert panel.y.label == in_words(WORST)
    assert len(entries(figure.panels)) == (lines if lines > 1 else 0), "one line needs no legend"


def test_a_map_of_a_machine_of_one_mesh_shows_its_force():
    given = table((0.5, 1.0), (7500.0,))
    force = given[given["quantity"] == "peak_mesh_force_n"]
    (panel,) = load_map_figure(force).panels
    assert panel.y.label == in_words("peak_mesh_force_n")
    values = np.concatenate([mark.y for mark in panel.marks if isinstance(mark, Curve)])
    np.testing.assert_array_equal(np.sort(values), np.sort(force[force["percentile"] != 95.0]["value"]))


def test_what_comes_once_a_machine_stands_after_the_worst_paths():
    columns = ["te_peak_to_peak_um", "open_fraction", OTHER_MODES, "pressure_mpa", WORST, "peak_mesh_force_n"]
    values = [5.0, 0.0, 1.3, 1500.0, 1.4, 2e4]
    found = worst_first(pd.DataFrame({"quantity": columns, "percentile": 99.0, "value": values}))
    assert found == [WORST, OTHER_MODES, "peak_mesh_force_n", "pressure_mpa", "te_peak_to_peak_um"]


def test_a_machine_of_one_mesh_has_what_decides_its_force_drawn_once():
    force = "peak_mesh_force_n"
    percentiles = pd.DataFrame({"quantity": [force], "percentile": 99.0, "value": 2e4})
    ranks = pd.DataFrame({"quantity": force, "cause": ["clocking", "error"], "rank_correlation": [0.9, -0.2]})
    (panel,) = importance_figure(percentiles, ranks, pd.DataFrame()).panels
    assert [mark.name for mark in panel.marks if isinstance(mark, Bars)] == [in_words(force)]
