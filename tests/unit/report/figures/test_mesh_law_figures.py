"""Figures of the load-dependent law show its table, and what lies past it in words."""

import numpy as np
import pandas as pd
from force_tables import power_table

from facegear.meshing.fitted_law import law_arrays
from facegear.report.figures.marks import Text
from facegear.report.figures.stiffness import law_load_figures, mesh_law_figures

LOADS = pd.DataFrame(
    {
        "mesh": ["input/lower", "idler/lower", "input/upper", "idler/upper"],
        "last_level_n": 30e3,
        "smallest_n": [20e3, 6e3, 22e3, 6e3],
        "mean_n": [21e3, 7e3, 24e3, 7e3],
        "largest_n": [22e3, 8e3, 26e3, 8e3],
        "past_fraction": 0.0,
        "sweep_largest_n": [25e3, 9e3, 33e3, 9e3],
        "sweep_past_fraction": [0.0, 0.0, 0.125, 0.0],
    }
)


def sweep(size):
    rows = [
        (direction, speed, "deflection_ac_rms_um", mesh, size)
        for direction in ("up", "down")
        for speed in (1000.0, 2000.0)
        for mesh in LOADS["mesh"]
    ]
    return pd.DataFrame(rows, columns=["direction", "speed_rpm", "quantity", "body_or_mesh", "value"])


def test_lines_over_a_pitch_are_the_forces_of_the_table_at_the_deflections_beside_them():
    table = power_table(20, 0.2, 1e-6, 6e-5, 5e10)
    lines, surface = mesh_law_figures(law_arrays([table], np.zeros((2, 2), dtype=int)))
    (panel,) = lines.panels
    assert panel.marks[-1].text == panel.marks[-2].name == "60 µm"
    phases, forces = panel.marks[-2].x, panel.marks[-2].y
    wanted = (1.0 + 0.2 * np.cos(2.0 * np.pi * phases)) * 5e10 * 6e-5**1.5 / 1e3
    np.testing.assert_allclose(forces, wanted, rtol=1e-9)
    assert surface.panels[0].z.label == "Mesh force (kN)"


def test_a_mesh_that_goes_past_its_table_says_for_how_much_of_the_time():
    (figure,) = law_load_figures(LOADS, sweep(1.0), [], ["load-dependent"])
    texts = [mark.text for mark in figure.panels[0].marks if isinstance(mark, Text)]
    assert texts == ["12 % of the time past it"]


def test_sweeps_of_both_laws_lie_over_each_other_in_a_panel_for_each_mesh_of_one_gear():
    laws = ["load-dependent", "constant stiffness"]
    _, figure = law_load_figures(LOADS, sweep(1.0), [sweep(2.0)], laws)
    assert [panel.title for panel in figure.panels] == ["input/upper", "idler/upper"]
    shown = {curve.name: curve.y.iloc[0] for curve in figure.panels[0].marks}
    assert shown == {
        f"{law}, {way}": size for law, size in zip(laws, (1.0, 2.0), strict=True) for way in ("up", "down")
    }
