"""A gear unit goes to REXS and comes back, and files of others are read."""

from pathlib import Path
from xml.etree import ElementTree as Xml

import pytest
from hypothesis import given
from hypothesis import strategies as st

import facegear
from facegear.errors import FacegearError
from facegear.exchange.rexs import (
    LOST_CONTENT,
    CylindricalGear,
    Shaft,
    Unit,
    gear_unit,
    read_rexs,
    write_rexs,
)
from facegear.exchange.rexs_pinions import known_of_rexs

CONFIG = Path(__file__).parents[3] / "config" / "paper.yaml"
KNOWN = {
    "shaft": {"mass_of_component": "kg"},
    "concept_bearing": {"radial_stiffness": "N / m", "axial_stiffness": "N / m"},
    "material": {"elastic_modulus": "MPa", "poisson_ratio": "none"},
    "cylindrical_gear": {
        "number_of_teeth": "none",
        "normal_module": "mm",
        "helix_angle_reference_diameter": "deg",
        "face_width": "mm",
        "inner_diameter": "mm",
    },
    "cylindrical_gear_flank": {"normal_pressure_angle": "deg"},
    "gear_unit": {},
    "gear_casing": {},
}
"""Components, attributes and units as rexs_schema_2.0.0.xml of FVA's rexs-api-java names them."""
ROLES = {
    "assembly": {"assembly", "part"},
    "side": {"assembly", "inner_part", "outer_part"},
    "reference": {"origin", "referenced"},
    "flank": {"gear", "left", "right"},
}
"""Relations and their roles, from the same."""
SIZES = st.none() | st.floats(min_value=1e-3, max_value=1e12, allow_nan=False)
ANGLES = st.tuples(SIZES, SIZES).filter(lambda angles: (angles[0] is None) == (angles[1] is None))
GEARS = st.builds(
    lambda teeth, module, width, angles, bore, helix: CylindricalGear(
        teeth, module, width, *angles, bore, helix
    ),
    st.integers(5, 500),
    st.floats(0.1, 100),
    SIZES,
    ANGLES,
    SIZES,
    st.none() | st.floats(-45, 45),
)
NAMES = st.text(
    st.characters(categories=("L", "N", "Zs"), include_characters="<&\"'"), min_size=1, max_size=9
)
SHAFTS = st.builds(Shaft, NAMES, mass=SIZES, radial=SIZES, axial=SIZES, gear=st.none() | GEARS)
UNITS = st.builds(Unit, st.lists(SHAFTS, max_size=4).map(tuple), young=SIZES, poisson=SIZES)


@given(unit=UNITS)
def test_a_unit_comes_back_as_it_went(tmp_path_factory, unit):
    path = tmp_path_factory.getbasetemp() / "unit.rexs"
    assert read_rexs(write_rexs(path, unit, "2026-01-01T00:00:00+00:00", "1.0")) == unit


@pytest.fixture(scope="module")
def machine(tmp_path_factory):
    return facegear.load(CONFIG, None).export(tmp_path_factory.mktemp("rexs") / "paper.rexs")


def test_the_papers_machine_keeps_its_pinions_and_bearings(machine):
    found = read_rexs(machine)
    assert found == gear_unit(facegear.load(CONFIG, None).config)
    pinion, gear = found.shafts[0], found.shafts[-1]
    assert (pinion.name, pinion.mass, pinion.radial, pinion.axial) == ("tail idler", 1.199, 6.5e7, 0.0)
    assert pinion.gear == CylindricalGear(23, 3.75, 30, right_angle=25, left_angle=25, bore=25, helix_angle=0)
    assert (gear.name, gear.radial, gear.gear) == ("upper face gear", 8.7e9, None)
    assert len(found.shafts) == 7 and found.young == 206e3


def test_only_parts_and_units_of_rexs_are_written_and_every_reference_leads_somewhere(machine):
    root = Xml.parse(machine).getroot()
    kinds = {part.attrib["id"]: part.attrib["type"] for part in root.iter("component")}
    assert len(kinds) == len(list(root.iter("component")))
    for part in root.iter("component"):
        units = {one.attrib["id"]: one.attrib["unit"] for one in part.iter("attribute")}
        assert units.items() <= KNOWN[part.attrib["type"]].items()
    for relation in root.iter("relation"):
        assert {one.attrib["role"] for one in relation} == ROLES[relation.attrib["type"]]
        assert all(kinds[one.attrib["id"]] == one.attrib["hint"] for one in relation)


def test_what_is_lost_stands_in_the_file(machine):
    text = machine.read_text()
    assert all(lost in text for lost in LOST_CONTENT)


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("<model", "not a readable REXS file"),
        ("<other/>", "begins with model, not other"),
        (
            '<model><relations><relation id="1" type="assembly"><ref id="1" role="assembly"/>'
            '<ref id="2" role="part"/></relation></relations><components><component id="1" type="shaft"/>'
            '<component id="2" type="cylindrical_gear"/></components></model>',
            "gear 2 has no number of teeth",
        ),
    ],
)
def test_a_file_that_cannot_be_read_is_named_in_one_line(tmp_path, text, line):
    path = tmp_path / "own.rexs"
    path.write_text(text)
    with pytest.raises(FacegearError, match=line) as caught:
        read_rexs(path)
    assert "\n" not in str(caught.value)


def test_a_file_that_is_not_there_is_said_without_a_number_of_the_system(tmp_path):
    with pytest.raises(
        FacegearError, match=r"none\.rexs: not a readable REXS file \(no such file or directory\)$"
    ):
        read_rexs(tmp_path / "none.rexs")


TWO_SHAFTS = (
    '<model><relations><relation id="1" type="assembly"><ref id="1" role="assembly"/>'
    '<ref id="2" role="part"/></relation></relations><components><component id="1" type="shaft" name="s">'
    '<attribute id="mass_of_component">1.5</attribute></component>'
    '<component id="2" type="cylindrical_gear"><attribute id="number_of_teeth">25</attribute>'
    '<attribute id="normal_module">4</attribute></component></components></model>'
)
REPLACED = [
    (">1.5<", ">heavy<", "component 1: mass_of_component = 'heavy': must be a finite number"),
    (">1.5<", ">1e999<", "component 1: mass_of_component = '1e999': must be a finite number"),
    (">25<", ">nan<", "component 2: number_of_teeth = 'nan': must be a finite number"),
    (">25<", ">24.6<", "gear 2: number_of_teeth = 24.6: must be a whole number"),
    (">4<", ">4,5<", "component 2: normal_module = '4,5': must be a finite number"),
    ('<component id="2"', "<component", "an element component (type='cylindrical_gear') has no attribute id"),
    (' type="shaft"', "", "has no attribute type"),
    (' role="part"', "", "an element ref (id='2') has no attribute role"),
    ('<ref id="2"', '<ref id="7"', "names component '7', which is absent"),
    ('<component id="2"', '<component id="1"', "component id '1' stands twice: must be unique"),
    ('"normal_module"', '"normal_module" unit="inch"', "unit of normal_module = 'inch': must be 'mm'"),
    (
        '"normal_module"',
        '"normal_module">4</attribute><attribute id="normal_module"',
        "normal_module stands twice",
    ),
]


@pytest.mark.parametrize(("old", "new", "line"), REPLACED)
def test_a_fault_inside_a_file_is_named_in_one_line(tmp_path, old, new, line):
    """A value that was no number ended in a ValueError, a missing attribute in a KeyError."""
    path = tmp_path / "own.rexs"
    path.write_text(TWO_SHAFTS)
    assert read_rexs(path).shafts[0].mass == 1.5
    assert old in TWO_SHAFTS
    path.write_text(TWO_SHAFTS.replace(old, new))
    with pytest.raises(FacegearError) as caught:
        read_rexs(path)
    assert line in str(caught.value) and "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("content", "form"), [(b"PK\x03\x04rest", "zipped (.rexsz)"), (b' {"model": {}}', "JSON (.rexsj)")]
)
def test_other_forms_of_rexs_are_named(tmp_path, content, form):
    path = tmp_path / "own.rexs"
    path.write_bytes(content)
    with pytest.raises(FacegearError) as caught:
        read_rexs(path)
    assert str(caught.value) == f"{path}: this is the {form} form of REXS; save it as XML (.rexs)"


def test_axial_stiffness_is_taken_over_and_a_rigid_bearing_is_noted(tmp_path):
    """A bearing of 1e20 N/m was refused without a word on what is allowed, and axial stiffness was lost."""
    gear = CylindricalGear(25, 4.0, 30.0, right_angle=20.0, left_angle=20.0, bore=20.0)
    unit = Unit((Shaft("one", mass=2.0, radial=1e20, axial=3e8, gear=gear),), None, None)
    path = write_rexs(tmp_path / "own.rexs", unit, "2026-01-01T00:00:00+00:00", "1.0")
    found = known_of_rexs(path)
    assert found.values["axial_bearing_n_per_m"] == 3e8
    assert found.values["input_bearing_n_per_m"] == 1e12
    assert found.notes == (f"{path}: input_bearing_n_per_m = 1e+20: taken as rigid, 1e+12 N/m",)


UNLIKE_FLANKS = (
    '<model version="1.0"><relations><relation id="1" type="assembly"><ref id="1" role="assembly"/>'
    '<ref id="2" role="part"/></relation><relation id="2" type="flank"><ref id="2" role="gear"/>'
    '<ref id="3" role="left"/><ref id="4" role="right"/></relation></relations><components>'
    '<component id="1" type="shaft" name="s"/><component id="2" type="cylindrical_gear">'
    '<attribute id="number_of_teeth" unit="none">13</attribute>'
    '<attribute id="normal_module" unit="mm">1.25</attribute>'
    '<attribute id="helix_angle_reference_diameter" unit="°">-10.0</attribute></component>'
    '<component id="3" type="cylindrical_gear_flank">'
    '<attribute id="normal_pressure_angle" unit="°">20.0</attribute></component>'
    '<component id="4" type="cylindrical_gear_flank">'
    '<attribute id="normal_pressure_angle" unit="°">25.0</attribute></component></components></model>'
)
"""Helical gear as FVA's example of a three-stage gearbox in REXS 1.0 gives it, but with unlike flanks."""


def test_a_helical_gear_with_unlike_flanks_is_read_with_its_hand(tmp_path):
    """The attribute was looked for under a name that REXS does not have: the gear was read as spur."""
    path = tmp_path / "helical.rexs"
    path.write_text(UNLIKE_FLANKS, "utf-8")
    (shaft,) = read_rexs(path).shafts
    assert shaft.gear == CylindricalGear(
        13, 1.25, None, right_angle=25.0, left_angle=20.0, bore=None, helix_angle=-10.0
    )
    values = known_of_rexs(path).values
    assert (values["helix_angle_deg"], values["pressure_angle_deg"]) == (-10.0, 25.0)
    assert values["coast_pressure_angle_deg"] == 20.0
