"""Mistakes in section lubrication are one line each, before any work."""

import copy

import pytest

from facegear.build.lubrication import limits_of, lubrication_request, map_speeds
from facegear.errors import ConfigErrors
from facegear.lubrication.friction import Constant, Schlenk
from facegear.lubrication.request import BorrowedBulk, Cooling, GivenBulk
from facegear.schema.base import parse
from facegear.schema.cards import OIL_CARDS
from facegear.schema.lubrication import LubricationSection

SECTION = {
    "oil": "polyol_ester_5_cst",
    "supply_temperature_c": 90,
    "pinion": {"ra_um": 0.3},
    "face_gear": {"ra_um": 0.4},
    "bulk": {"source": "given", "temperature_c": 110},
}
OIL = {
    "name": "own oil",
    "source": "a data sheet",
    "temperatures_c": [40, 100],
    "viscosities_mm2_s": [30, 6],
    "density_15_c_kg_m3": 900,
    "pressure_coefficient": {"law": "fixed", "per_gpa": 15},
    "conductivity": {"w_per_m_k": 0.14},
    "flash_point_c": 220,
}


def changed(**values):
    section = copy.deepcopy(SECTION)
    for key, value in values.items():
        place, *names = key.split("__")
        if names:
            section[place] = {**section.get(place, {}), names[0]: value}
        else:
            section[place] = value
    return section


@pytest.mark.parametrize(
    ("section", "line"),
    [
        (
            changed(supply_temperature_c=246),
            "supply_temperature_c = 246.0: must be below the oil's flash point, 246",
        ),
        (
            changed(bulk__temperature_c=300),
            "bulk.temperature_c = 300.0: must be below the oil's flash point, 246",
        ),
        (
            changed(oil={**OIL, "viscosities_mm2_s": [6, 30]}),
            'oil = "own oil": must be a card without mistakes: the card: viscosities_mm2_s = [6.0, 30.0]: '
            "must be two viscosities, the larger first",
        ),
        (
            changed(oil={**OIL, "temperatures_c": [100, 40]}),
            "temperatures_c = [100.0, 40.0]: must be two temperatures, the lower first",
        ),
        (
            changed(oil={**OIL, "flash_point_c": 80}),
            "supply_temperature_c = 90.0: must be below the oil's flash",
        ),
        (changed(pinion__ra_um=0), "pinion.ra_um = 0: must be greater than or equal to 0.001"),
        (changed(face_gear__ra_um=6.3), "face_gear.ra_um = 6.3: must be less than or equal to 4"),
        (changed(oil="castor"), 'oil = "castor": must be one of mineral_vg_100, mineral_vg_220, pao_vg_320'),
        (
            changed(friction={"model": "doleschel"}),
            "friction.constants = null: must be given for the model doleschel",
        ),
        (changed(friction={"model": "constant"}), "friction.coefficient = null: must be given for the model"),
        (
            changed(friction={"model": "xu", "coefficient": 0.05}),
            "friction.coefficient = 0.05: must be left out for the model xu",
        ),
        (
            changed(bulk={"source": "cooling"}),
            "bulk.pinion_w_per_k = null: must be given where source is cooling",
        ),
        (
            changed(map_speeds_rpm=[2000, 1000]),
            "map_speeds_rpm = [2000.0, 1000.0]: must be rising speeds",
        ),
        (changed(oils="x"), "oils"),
    ],
)
def test_a_mistake_is_one_line_with_its_key_value_and_what_is_allowed(section, line):
    with pytest.raises(ConfigErrors) as caught:
        parse(LubricationSection, section)
    assert len(caught.value.lines) == 1
    assert line in caught.value.lines[0]


def test_the_request_is_in_si_units_with_defaults_on_the_safe_side():
    found = lubrication_request(parse(LubricationSection, SECTION), 113e9, 0.04)
    assert found.ra == pytest.approx((0.3e-6, 0.4e-6)) and found.rq == pytest.approx((0.375e-6, 0.5e-6))
    assert found.bulk == GivenBulk(110.0) and found.reduced_modulus == 226e9
    assert found.friction == Schlenk(1.0)
    assert found.flanks[0].contact_coefficient == pytest.approx(12427.389, abs=1e-3)


def test_every_way_of_bulk_temperature_and_own_oils_are_taken():
    cooled = {"source": "cooling", "pinion_w_per_k": 60, "face_gear_w_per_k": 200}
    for bulk, supply, expected in (
        (cooled, "jet", Cooling(60.0, 200.0)),
        ({"source": "iso_6336_20"}, "jet", BorrowedBulk(1.2)),
        ({"source": "iso_6336_20"}, "dip", BorrowedBulk(1.0)),
    ):
        section = parse(LubricationSection, changed(bulk=bulk, supply=supply, oil=OIL))
        assert lubrication_request(section, 1e11, 0.04).bulk == expected
    constant = changed(friction={"model": "constant", "coefficient": 0})
    assert lubrication_request(parse(LubricationSection, constant), 1e11, 0.04).friction == Constant(0.0)


def test_limits_are_those_of_the_section_before_those_of_the_oil():
    plain = limits_of(parse(LubricationSection, SECTION))
    assert (plain.contact_temperature, plain.fzg_stage, plain.film_ratio) == (220.0, None, None)
    own = limits_of(parse(LubricationSection, changed(scuffing={"temperature_c": 180, "fzg_stage": 9})))
    assert (own.contact_temperature, own.fzg_stage) == (180.0, 9.0)


def test_the_map_spans_the_nominal_speed_unless_speeds_are_given():
    speeds = map_speeds(parse(LubricationSection, SECTION), 6000.0)
    assert len(speeds) == 12 and speeds[0] == pytest.approx(600) and speeds[-1] == pytest.approx(7500)
    assert map_speeds(parse(LubricationSection, changed(map_speeds_rpm=[100, 200])), 6000.0) == (100.0, 200.0)


@pytest.mark.parametrize("path", sorted(OIL_CARDS.glob("*.yaml")), ids=lambda path: path.stem)
def test_every_oil_of_the_package_can_be_named(path):
    section = parse(LubricationSection, changed(oil=path.stem, bulk__temperature_c=100))
    assert section.oil.source
