"""The sections tooth_pair and mesh: units, defaults, and refusals by key."""

from copy import deepcopy
from math import radians
from pathlib import Path

import pytest

from facegear.build.plans import mesh_sizes
from facegear.build.tooth_pair import ToothPair, materials, pair_design
from facegear.errors import ConfigErrors
from facegear.schema.base import parse
from facegear.schema.contact import Mesh
from facegear.schema.yaml_file import read_yaml
from facegear.teeth.design import AssemblyErrors

ROOT = Path(__file__).parents[3]


@pytest.fixture
def section():
    return deepcopy(read_yaml(ROOT / "config" / "paper.yaml")["tooth_pair"])


def test_config_units_become_si(section):
    section["assembly"] = {"offset_um": 10.0, "shaft_angle_error_deg": 0.1, "gear_axial_um": -20.0}
    section["pinion"]["tip_relief"] = {"amount_um": 15.0, "length_mm": 2.0}
    design = pair_design(parse(ToothPair, section))
    assert design.module == pytest.approx(3.75e-3)
    assert design.pressure_angle == pytest.approx(radians(25))
    assert design.pinion_pitch_radius == pytest.approx(43.125e-3)
    assert design.face_gear.inner_radius == pytest.approx(0.250)
    assert design.pinion.tip_relief.amount == pytest.approx(15e-6)
    assert design.assembly == AssemblyErrors(
        pytest.approx(1e-5), pytest.approx(radians(0.1)), pytest.approx(-2e-5)
    )


def test_a_body_may_have_its_own_material(section):
    section["face_gear"]["material"] = {"young_modulus_gpa": 110.0, "poisson_ratio": 0.33}
    pinion, gear = materials(parse(ToothPair, section))
    assert pinion.young_modulus == pytest.approx(206e9)
    assert (gear.young_modulus, gear.poisson_ratio) == (pytest.approx(110e9), 0.33)


@pytest.mark.parametrize(
    ("part", "key", "value", "line"),
    [
        ("face_gear", "inner_radius_mm", 240.0, "face_gear.inner_radius_mm = 240.0: must be between 245.800"),
        (
            "face_gear",
            "outer_radius_mm",
            310.0,
            "and 293.208 (the shaper's tip leaves no fillet further out; a larger shaper.tip_rounding_",
        ),
        ("face_gear", "iner_radius_mm", 250.0, "did you mean 'inner_radius_mm'?"),
        ("pinion", "rack_tip_radius_modules", 0.5, "pinion.rack_tip_radius_modules = 0.5: must be"),
        ("pinion", "width_mm", -1.0, "pinion.width_mm = -1.0: must be greater than or equal to 0.01"),
        ("shaper", "teeth", 30, "shaper.teeth = 30: must be from 23 (line contact) to 26"),
        ("pinion", "width_mm", 1.0, "pinion.width_mm = 1.0: must be at least 12.500, half the gear's face"),
        ("pinion", "width_mm", 600.0, "pinion.width_mm = 600.0: must be less than 525.000"),
        (
            "pinion",
            "tip_relief",
            {"amount_um": 400, "length_mm": 2},
            "um = 400.0: must be at most 187.5",
        ),
    ],
)
def test_a_wrong_value_is_one_line_with_key_and_what_is_allowed(section, part, key, value, line):
    section[part][key] = value
    with pytest.raises(ConfigErrors) as refused:
        parse(ToothPair, section)
    assert any(line in text for text in refused.value.lines)


def test_mesh_sizes_by_level_and_by_number():
    level = mesh_sizes(parse(Mesh, {"resolution": "fine"}), 4e-3)
    assert level.profile == pytest.approx(0.2e-3)
    own = {"profile_mm": 0.3, "width_mm": 1.5, "thickness_mm": 2.0}
    sizes = mesh_sizes(parse(Mesh, {"resolution": own}), 4e-3)
    assert (sizes.profile, sizes.width, sizes.thickness) == pytest.approx((3e-4, 1.5e-3, 2e-3))
    with pytest.raises(ConfigErrors, match="must be 'coarse', 'medium', 'fine' or 'finest'"):
        parse(Mesh, {"resolution": "superb"})


def test_the_gear_has_more_teeth_than_the_pinion(section):
    section |= {"pinion_teeth": 150, "pinion": None, "face_gear": None, "shaper": None}
    with pytest.raises(ConfigErrors, match="face_gear_teeth = 143: must be more than the pinion's 150"):
        parse(ToothPair, section)
