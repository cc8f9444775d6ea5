"""A machine to start from with helical, tapered, offset or asymmetric teeth: limits and forces."""

from types import SimpleNamespace

import numpy as np
import pytest

from facegear.build.config import resolved_values
from facegear.build.early_checks import machine_findings
from facegear.build.load import config_of
from facegear.build.tooth_numbers import ToothNumbers
from facegear.build.tooth_pair import pair_design
from facegear.errors import ConfigError, FacegearError
from facegear.new_machine.draft import Draft
from facegear.new_machine.first_machine import first_machine
from facegear.new_machine.wishes import MachineWishes
from facegear.schema.yaml_file import read_yaml
from facegear.teeth.bounded_contact import contact_path
from facegear.teeth.family_contact import contact_line
from facegear.teeth.family_limits import family_limits
from facegear.teeth.pitch_line import pitch_line_y
from facegear.teeth.tooth_family import SIDES

KINDS = (
    {"helix_angle_deg": 15.0},
    {"taper_angle_deg": 4.0},
    {"shaft_angle_deg": 100.0, "coast_pressure_angle_deg": 20.0},
    {"offset_mm": 25.0, "helix_angle_deg": -10.0},
    {"taper_angle_deg": -3.0, "shaft_angle_deg": 80.0},
    {"taper_angle_deg": 4.0, "pinions": 2, "idlers": 3},
)


def make_wishes(**others):
    """Return the wishes of the paper's numbers of teeth, with others."""
    numbers = {"pinion_teeth": 23, "face_gear_teeth": 143, "module_mm": 3.75}
    return MachineWishes(case="own", torque_n_m=500.0, speed_rpm=6000.0, **numbers, **others)


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: ",".join(kind))
def test_the_face_lies_within_the_limits_of_both_flanks_and_holds_their_paths(kind, tmp_path):
    path = tmp_path / "own.yaml"
    path.write_text(first_machine(make_wishes(**kind)).text)
    design = pair_design(config_of(read_yaml(path)).tooth_pair)
    family, limits = design.family, family_limits(design.family)
    assert family.inner_radius > max(start.limit[0] for start in limits.starts)
    assert family.outer_radius < limits.pointing or np.isnan(limits.pointing)
    ends = pitch_line_y(family, np.array([family.inner_radius, family.outer_radius]))
    assert family.middle == pytest.approx(ends.mean(), abs=1e-7)
    assert family.width == pytest.approx(np.ptp(ends) + 2 * design.module, abs=4e-7)
    for side in SIDES:
        part = contact_path(family, contact_line(family, side))
        assert part.contact_ratio > 1.05
        assert {part.first_edge, part.last_edge} <= {"gear tip", "pinion tip", "pinion root", "gear root"}


def test_what_to_expect_names_the_axial_force_of_each_flank():
    """Closed form: T tan(helix) / pitch radius, inwards on the drive flank of a right-hand pinion."""
    lines = first_machine(make_wishes(helix_angle_deg=15.0)).expectations
    axial = 500.0 * np.tan(np.radians(15)) / (23 * 3.75e-3 / 2 / np.cos(np.radians(15)))
    assert f"-{axial:.0f} N outwards" in lines[1] and f" {axial:.0f} N outwards" in lines[2]


@pytest.mark.parametrize("kind", KINDS[:5], ids=lambda kind: ",".join(kind))
def test_load_sharing_of_the_draft_counts_the_forces_of_its_own_teeth(kind, tmp_path):
    """Along the tangent both flanks of an idler push as its torque over the pitch radius does."""
    path = tmp_path / "own.yaml"
    path.write_text(first_machine(make_wishes(**kind)).text)
    design = pair_design(config_of(read_yaml(path)).tooth_pair)
    teeth = SimpleNamespace(design=design)
    wishes = SimpleNamespace(pinions=2, idlers=3, torque_n_m=500.0)
    form = Draft.closed_form(SimpleNamespace(teeth=teeth, wishes=wishes, stiffness=4e8))
    lines = [contact_line(design.family, side) for side in SIDES]
    arms = ToothNumbers.of_design(design).kind.normal_arms
    tangential = [abs(line.normal[0]) * arms[0] / arm for line, arm in zip(lines, arms, strict=True)]
    assert form.input_force == pytest.approx(500.0 / arms[0], rel=1e-12)
    assert form.idler_push == pytest.approx(sum(tangential), rel=1e-12)


def test_spur_values_of_the_new_keys_change_nothing():
    plain = first_machine(make_wishes())
    given = make_wishes(
        helix_angle_deg=0.0, taper_angle_deg=0.0, shaft_angle_deg=90.0, coast_pressure_angle_deg=25.0
    )
    assert first_machine(given) == plain


@pytest.mark.parametrize(
    ("kind", "line"),
    [
        ({"helix_angle_deg": 50.0}, "helix_angle_deg = 50.0: must be from -45 to 45"),
        ({"taper_angle_deg": -30.0}, "taper_angle_deg = -30.0: must be from -20 to 20"),
        ({"shaft_angle_deg": 170.0}, "shaft_angle_deg = 170.0: must be from 20 to 160"),
        ({"offset_mm": 2e4}, "offset_mm = 20000.0: must be from -10000 to 10000"),
        ({"coast_pressure_angle_deg": 41.0}, "coast_pressure_angle_deg = 41.0: must be from 10 to 40"),
    ],
)
def test_a_wish_beyond_its_limits_is_one_line(kind, line):
    with pytest.raises(ConfigError) as refused:
        first_machine(make_wishes(**kind))
    assert str(refused.value) == line


@pytest.mark.parametrize("kind", [{"offset_mm": 250.0}, {"taper_angle_deg": 19.0}])
def test_teeth_that_have_no_face_are_refused_in_one_line(kind):
    with pytest.raises(FacegearError) as refused:
        first_machine(make_wishes(**kind))
    assert "\n" not in str(refused.value) and str(refused.value).startswith("no teeth for 23/143")


@pytest.mark.parametrize("kind", [{"helix_angle_deg": 15.0}, {"taper_angle_deg": 4.0}])
def test_a_split_torque_machine_of_other_teeth_splits_its_torque(kind, tmp_path):
    """Its bearings were stiff, so that at rest no load reached the lower gear and the idlers."""
    wishes = make_wishes(pinions=2, idlers=2, **kind)
    made = first_machine(wishes)
    path = tmp_path / "own.yaml"
    path.write_text(made.text)
    values = resolved_values(config_of(read_yaml(path)))
    springs = values["transmission"]["pinion"]["bearing_stiffness_n_per_m"]
    assert springs["z"] > 10.0 * springs["x"]  # holds the axial force of the teeth
    assert not [line for line in machine_findings(values).remarks if "no load" in line or "torques" in line]
    assert any(line.startswith("K_gamma 1.") for line in made.expectations)
