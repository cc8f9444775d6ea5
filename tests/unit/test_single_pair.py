"""One pinion and one gear share no load: every answer of the door is empty or one line, and no traceback."""

import pytest

import facegear
from facegear.errors import FacegearError
from facegear.sharing.hunting import GROUP_COLUMNS
from facegear.sharing.running_machine import RUNNING_COLUMNS

BEARING = {"x": 1e9, "y": 1e9, "z": 1e9}
PAIR = {
    "case": "one",
    "tooth_pair": {"pinion_teeth": 23, "face_gear_teeth": 143, "module_mm": 4, "pressure_angle_deg": 25},
    "mesh_stiffness": {"source": "harmonics", "table": [{"order": 0, "cos_n_per_m": 4.1e8}]},
    "transmission": {
        "pinions": [{"name": "in", "role": "input", "angle_deg": 0}],
        "face_gears": ["upper"],
        "pinion": {"mass_kg": 3, "inertia_kg_m2": 4e-3, "bearing_stiffness_n_per_m": BEARING},
        "face_gear": {"mass_kg": 30, "inertia_kg_m2": 1.5, "bearing_stiffness_n_per_m": BEARING},
        "damping": {"mesh_n_s_per_m": 2000, "mass_per_s": 10, "bearing_s": 1e-6},
        "backlash_um": 100,
        "transmission_error": {"amplitude_um": 5},
        "torque": {"per_input_n_m": 300, "tail_share": 0},
    },
}


@pytest.fixture(scope="module")
def pair():
    return facegear.load(PAIR, None)


def test_hunting_and_sensitivity_of_a_single_pair_have_no_group(pair):
    """They ended with KeyError: k_gamma."""
    found = pair.hunting(positions=2)
    assert list(found.table().columns) == list(GROUP_COLUMNS) and found.table().empty
    assert found.meshes()["mesh"].to_list() == ["in/upper"] and found.meshes()["k_gamma"].notna().all()
    assert "no path shares a load" in repr(found)
    assert pair.sensitivity(positions=2).table().empty
    assert pair.sensitivity(positions=2).bearing_stiffness().empty


def test_following_a_single_pair_has_the_columns_of_its_table(pair, tmp_path):
    """Without them the table was stored as an empty file, which no reader takes."""
    found = pair.following(cycles=1)
    assert list(found.table().columns) == list(RUNNING_COLUMNS) and found.table().empty
    found.save(tmp_path)
    assert (tmp_path / "load_sharing/following_groups.csv").read_text().startswith("group,kind,")


@pytest.mark.parametrize("answer", ["hunting", "sensitivity", "load_sharing", "shaft_orders"])
def test_a_plot_without_anything_to_draw_says_so(pair, answer):
    quick = pair.with_values({"load_sharing.cycles": 20, "load_sharing.starts": 1})
    with pytest.raises(FacegearError, match=r"one: no .*, there is nothing to draw"):
        getattr(quick, answer)().plot()


def test_errors_of_single_teeth_are_refused_where_all_teeth_are_alike():
    """All was computed, and the plot of nothing was a ValueError."""
    with pytest.raises(FacegearError, match="given for single teeth of pinion or face_gear: all are alike"):
        facegear.example().tooth_errors()
