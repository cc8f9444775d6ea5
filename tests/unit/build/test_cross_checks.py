"""Demands of the sections of a config on one another, told before any work."""

from copy import deepcopy
from pathlib import Path

import pytest

from facegear.build.cases import expand_cases
from facegear.build.config import Config, resolved_values
from facegear.build.load import load_config
from facegear.build.notes import notes
from facegear.build.plans import contact_plan, mesh_sizes
from facegear.build.tooth_pair import pair_design
from facegear.contact.resolution import estimated_memory
from facegear.errors import ConfigErrors
from facegear.schema.base import parse

ROOT = Path(__file__).parents[3]
QUICK = load_config(ROOT / "config" / "quick.yaml").model_dump(mode="json")
TWO = load_config(ROOT / "config" / "two_pinion.yaml").model_dump(mode="json")


def changed(values, **keys):
    """The config with dotted keys (two underscores) set."""
    values = deepcopy(values)
    for key, value in keys.items():
        *sections, last = key.split("__")
        inside = values
        for section in sections:
            inside = inside[int(section) if section.isdecimal() else section]
        inside[last] = value
    return values


def message(values):
    with pytest.raises(ConfigErrors) as refused:
        expand_cases(parse(Config, values))
    (line,) = refused.value.lines
    return line


STUDY = {
    "name": "one",
    "title": "One",
    "axes": [{"label": "2b", "key": "transmission.backlash_um", "values": [1]}],
}


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        (
            {"mesh_stiffness__torque_n_m": 2000.0},
            "mesh_stiffness.torque_n_m = 2000.0: must be within contact.torques",
        ),
        ({"dynamics__speed_rpm": 1e-9}, "dynamics.speed_rpm = 1e-09: must be greater than or equal to 1"),
        ({"load_sharing__quasi_static_rpm": 1e-9}, "quasi_static_rpm = 1e-09: must be greater"),
        ({"dynamics__sweep__from_rpm": 1e-9}, "sweep.from_rpm = 1e-09: must be greater"),
        ({"load_sharing__speed_range__from_rpm": 1e-9}, "from_rpm = 1e-09: must be greater"),
        ({"transmission__pinions__1__angle_pitches": 1e18}, "angle_pitches = 1e+18: must be less than"),
        ({"transmission__pinions__1__angle_pitches": 150.0}, "within a turn, -143 to 143"),
        ({"transmission__pinions__1__angle_pitches": 143.0}, "deg apart, not 0: their bodies would overlap"),
        ({"transmission__pinions__1__angle_pitches": 3.0}, "their bodies would overlap"),
        ({"transmission__torque__per_input_n_m": 0.0}, "nothing would be loaded"),
        ({f"transmission__pinions__{i}__torque_n_m": 0.0 for i in (0, 2, 3)}, "not 0 at every input"),
        ({"studies": [STUDY, STUDY]}, 'studies[1].name = "one": must be a name of its own for each study'),
        ({"studies": [{**STUDY, "name": "summary"}]}, 'studies[0].name = "summary"'),
        (
            {"studies": [{**STUDY, "figures": [13, 14]}, {**STUDY, "name": "two", "figures": [14, 15]}]},
            "each number once",
        ),
    ],
)
def test_what_cannot_be_run_is_refused_in_one_line(changes, line):
    assert line in message(changed(QUICK, **changes))


@pytest.mark.parametrize("profile", [1e-3, 1e-6])
def test_a_mesh_that_cannot_fit_into_memory_is_refused_with_an_estimate(profile):
    """One micrometre was accepted without a word."""
    size = {"profile_mm": profile, "width_mm": 0.1, "thickness_mm": 1.0}
    line = message(changed(QUICK, mesh__resolution=size))
    assert line.startswith("mesh.resolution = ")
    assert "an estimate of the memory for factorisation and compliance is" in line
    assert " GB, and this machine has" in line


@pytest.mark.parametrize(
    ("resolution", "cuts", "measured_gb"),
    [
        ("coarse", (1, 1, 1), 0.38),
        ("coarse", (3, 1, 2), 0.59),
        ("coarse", (4, 2, 2), 1.52),
        ("coarse", (8, 1, 3), 1.56),
        ("medium", (2, 1, 2), 2.02),
    ],
)
def test_the_estimate_of_memory_agrees_with_what_was_measured_within_a_fifth(resolution, cuts, measured_gb):
    """The measured ones are from docs/explanation/contact.md, the paper's pair: the face gear's job."""
    refinement = dict(zip(("profile", "width", "depth"), cuts, strict=True))
    values = changed(QUICK, mesh__resolution=resolution, contact__refinement=refinement)
    config = parse(Config, changed(values, contact__torques_n_m=[600, 1000]))
    design = pair_design(config.tooth_pair)
    sizes = mesh_sizes(config.mesh, design.module)
    estimate = estimated_memory(design, sizes, contact_plan(config.contact))
    assert estimate == pytest.approx(1e9 * measured_gb, rel=0.2)


def test_points_of_all_studies_are_counted_before_they_are_made():
    axis = {"label": "2b", "key": "transmission.backlash_um", "values": [float(i) for i in range(1, 1501)]}
    line = message(changed(QUICK, studies=[{**STUDY, "axes": [axis]}]))
    assert line.startswith('studies = "1,500 points": must be at most 200 in all')


def test_a_misaligned_pair_without_backlash_is_refused_with_the_amount_by_which_it_jams():
    values = changed(TWO, tooth_pair__pinion__thinning_um=0.0, tooth_pair__assembly__gear_axial_um=-50.0)
    line = message(values)
    assert "tooth_pair.pinion.thinning_um = 0.0: must be at least " in line
    assert "the pair jams by " in line
    least = float(line.split("at least ")[1].split(":")[0])
    assert parse(Config, changed(values, tooth_pair__pinion__thinning_um=least + 0.1))


def test_another_backlash_than_that_of_the_teeth_is_reported_when_a_run_starts():
    """It was never compared with the geometry's."""
    (line,) = notes(parse(Config, TWO).model_dump(mode="json"))
    assert line.startswith("transmission.backlash_um = 120: the teeth as assembled have 130.5 um")
    for own in (None, 130.0):
        values = changed(TWO, transmission__backlash_um=own, studies=[])
        assert notes(parse(Config, values).model_dump(mode="json")) == []


def test_friction_of_teeth_as_assembled_beside_an_operating_pose_is_reported_when_a_run_starts():
    """Stress, rating, samples and designs stand where their own forces put them, and are not named."""
    for name, count in (("concentric", 0), ("friction", 1)):
        machine = load_config(ROOT / "config" / f"{name}.yaml").model_dump(mode="json")
        before = notes(machine)
        lines = notes(changed(machine, transmission__operating_pose="static"))
        added = [line for line in lines if line not in before]
        assert len(added) == count
        assert all("friction, loss, temperature and film take" in line for line in added)


def test_single_teeth_that_deviate_are_reported_when_a_run_starts():
    grid = {
        "flank": "right",
        "face_mm": [-12, 12],
        "profile_mm": [4, 20],
        "deviation_um": [[0, 0], [0, 0]],
    }
    values = load_config(ROOT / "config" / "concentric.yaml").model_dump(mode="json")
    before = notes(values)
    for teeth, added in (([None], []), ([None, 5], ["tooth_pair.pinion.flanks: deviations of single teeth"])):
        grids = [{**grid, "tooth": tooth} for tooth in teeth]
        flanks = {**values["tooth_pair"]["pinion"]["flanks"], "grids": grids}
        lines = notes(changed(values, tooth_pair__pinion__flanks=flanks))
        assert [line.partition(" enter")[0] for line in lines if line not in before] == added


def test_the_dynamics_take_the_backlash_of_the_teeth_as_assembled():
    """The pair of docs/tutorials/second_machine.md: 120 um of thinning, moved apart by assembly errors."""
    found = resolved_values(parse(Config, changed(TWO, transmission__backlash_um=None, studies=[])))
    assert found["transmission"]["backlash_um"] == pytest.approx(130.518, abs=0.01)
    nominal = resolved_values(parse(Config, changed(QUICK, transmission__backlash_um=None, studies=[])))
    assert nominal["transmission"]["backlash_um"] == 100.0


def test_a_study_of_the_teeth_moves_the_backlash_of_the_dynamics_with_them():
    axis = {"label": "thinning", "key": "tooth_pair.pinion.thinning_um", "values": [80, 90]}
    values = changed(QUICK, transmission__backlash_um=None, studies=[{**STUDY, "axes": [axis]}])
    cases = expand_cases(parse(Config, values))
    assert [case["transmission"]["backlash_um"] for case in cases.values()] == [100.0, 80.0, 90.0]


def test_a_tooth_pair_alone_is_a_config():
    """Whoever wanted tooth contact only had to invent some twenty keys of the transmission."""
    found = resolved_values(parse(Config, {"case": "teeth", "tooth_pair": QUICK["tooth_pair"]}))
    assert found["transmission"] is None
    assert found["mesh_stiffness"]["torque_n_m"] == found["contact"]["torques_n_m"][-1]


@pytest.mark.parametrize("key", ["studies", "reproduction"])
def test_what_needs_a_transmission_says_so(key):
    values = {
        "case": "teeth",
        "tooth_pair": QUICK["tooth_pair"],
        "studies": [STUDY],
        "reproduction": str(ROOT / "config" / "reproduction" / "paper.yaml"),
    }
    other = {"studies": "reproduction", "reproduction": "studies"}[key]
    del values[other]
    assert message(values) == f"transmission = null: must be given, as required by {key}"


def test_a_csv_named_by_a_study_counts_from_the_folder_of_the_config(tmp_path, monkeypatch):
    (tmp_path / "soft.csv").write_text("order,sin_n_per_m,cos_n_per_m\n0,0,3e8\n1,1e7,0\n")
    (tmp_path / "own.yaml").write_text(
        "extends: base.yaml\n"
        "studies:\n"
        "  - name: stiffness\n"
        "    title: Stiffness\n"
        "    axes: [{label: k, points: [{label: soft, set: {mesh_stiffness.csv: soft.csv, "
        "mesh_stiffness.mean_n_per_m: null}}]}]\n"
    )
    for name, target in (("base.yaml", "harmonics_only.yaml"), ("paper.yaml", "paper.yaml")):
        (tmp_path / name).write_bytes((ROOT / "config" / target).read_bytes())
    monkeypatch.chdir(ROOT)
    cases = expand_cases(load_config(tmp_path / "own.yaml"))
    assert [case["mesh_stiffness"]["mean_n_per_m"] for case in cases.values()] == [4.1e8, 3e8]
