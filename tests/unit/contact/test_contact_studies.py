"""Cases of a study side by side: shifts from the machine itself, figures with one curve a case."""

import numpy as np
import pandas as pd
from contact_patterns import line_arrays
from references import against, agrees

from facegear.contact.pattern import LTCA_COLUMNS
from facegear.contact.summary import StudiedContact, by_torque, path_by_position, study_table
from facegear.report.figures.contact import contact_study, pattern_study

TORQUES = (100.0, 300.0)


def case(name, moved_mm, torques=TORQUES):
    """Two positions, each with one loaded node on either side of the middle; the path moved outwards."""
    keys = [(torque, position) for torque in torques for position in (0.0, 0.5)]
    radius = 1e-3 * (260.0 + moved_mm + np.array([-1.0, 0.0, 1.0]))
    grid = np.broadcast_to(radius, (3, 3))
    height = 0.001 * np.arange(3)[:, None]
    points = np.stack([0 * grid, grid, 0.04 + height + 0 * grid], axis=-1)
    pressure = {
        "torque_n_m": np.repeat([torque for torque, _ in keys], 2),
        "position": np.repeat([position for _, position in keys], 2),
        "node": np.tile([3, 5], len(keys)),
        "force_n": np.tile([50.0, 50.0, 75.0, 25.0], len(torques)),
        "shape": np.array([3, 3]),
        "point_m": points.reshape(-1, 3),
    } | line_arrays(points, torques, np.full((3, 3), 5e8))
    ltca = pd.DataFrame(1.0, index=range(len(keys)), columns=list(LTCA_COLUMNS))
    ltca[["torque_n_m", "position"]] = keys
    path = {"path_pinion_y_mm": [259.0 + moved_mm, 261.0 + moved_mm]}
    pair = {"unloaded": {"drive": path}, "backlash_um": {"smallest": 100.0 - moved_mm}}
    return StudiedContact("s", name, name, pair, ltca, by_torque(ltca, pressure), pressure)


@against(
    "manufactured",
    "a pattern moved by a known length",
    capability="contact_studies",
    module="facegear.contact.summary",
)
def test_shifts_of_both_paths_are_from_the_machine_itself():
    table = study_table([case("machine", 0.0), case("offset", 1.5), case("tilt", -0.25, TORQUES[:1])])
    assert table["label"].to_list() == ["machine"] * 2 + ["offset"] * 2 + ["tilt"]
    agrees(
        "shift of the loaded path, mm",
        table["path_shift_mm"].to_list(),
        [0.0, 0.0, 1.5, 1.5, -0.25],
        absolute=1e-12,
    )
    agrees(
        "shift of the unloaded path, mm",
        table["unloaded_path_shift_mm"].to_list(),
        [0.0, 0.0, 1.5, 1.5, -0.25],
        relative=1e-6,
    )
    agrees("backlash, um", table["backlash_um"].to_list(), [100.0, 100.0, 98.5, 98.5, 100.25])


def test_a_torque_that_the_machine_was_not_solved_at_has_no_shift():
    table = study_table([case("machine", 0.0, TORQUES[:1]), case("offset", 1.5)])
    assert table["path_shift_mm"].isna().to_list() == [False, False, True]
    assert table["unloaded_path_shift_mm"].notna().all()


@against(
    "manufactured",
    "two forces at known places",
    capability="contact_studies",
    module="facegear.contact.summary",
)
def test_the_path_at_a_position_is_the_centroid_of_its_forces():
    found = path_by_position(case("machine", 0.0).pressure)
    agrees("radius of the path, mm", found["path_radius_mm"].to_list(), [260.0, 259.5] * 2, relative=1e-6)


def test_figures_show_every_case_and_say_where_the_torque_differs():
    cases = [case("machine", 0.0), case("offset", 1.5, (100.0, 250.0))]
    figure, patterns = contact_study(cases, 300.0, "Errors"), pattern_study(cases, 300.0)
    error, stiffness, path = figure.panels
    assert [curve.name for curve in error.marks] == ["machine", "offset (250 N m)"]
    assert len(stiffness.marks) == 2
    np.testing.assert_allclose(path.marks[2].y, [261.5, 261.0, 261.5])
    assert [panel.title for panel in patterns.panels] == ["machine", "offset (250 N m)"]
