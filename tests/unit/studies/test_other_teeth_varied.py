"""Samples and designs of machines with teeth other than spur: each flank has a contact of its own."""

from types import SimpleNamespace

import numpy as np
import pytest
from kinds_of_teeth import public_section

import facegear
from facegear.build.checks import geometric_backlash
from facegear.build.elastic_bodies import body_key
from facegear.build.machine_layout import wired_layout
from facegear.build.tooth_numbers import ToothNumbers
from facegear.build.tooth_pair import ToothPair, pair_design
from facegear.door.outputs import machine_of
from facegear.errors import ConfigError, ConfigErrors, InvalidInput
from facegear.harmonics import Harmonics
from facegear.machine.static_gears import at_rest
from facegear.pipeline.needs import stage_needs
from facegear.schema.base import parse
from facegear.schema.gear_body import BodySection
from facegear.sharing.quantities import FlankLoads, quasi_static_quantities
from facegear.strength.contact_pressure import FlankAnswers, PairAnswers, contact_pressure
from facegear.strength.flank_contacts import normal_arms
from facegear.studies import tooth_contact
from facegear.studies.designs import SearchedMachine, assessor
from facegear.studies.tooth_contact import PairExcitation

COARSE = {
    "mesh": {"resolution": {"profile_mm": 1.4, "width_mm": 6, "thickness_mm": 4}},
    "contact": {
        "torques_n_m": [300, 600],
        "positions_per_pitch": 4,
        "refinement": {"profile": 3, "width": 1, "depth": 1},
        "sector": {"pinion_teeth": 5, "face_gear_teeth": 5},
        "edge_contact": False,
    },
    "mesh_stiffness": {"torque_n_m": 400, "harmonics_kept": 1, "mesh_law": "constant_load"},
}
BODY = {"mass_kg": 1.2, "inertia_kg_m2": 0.002, "bearing_stiffness_n_per_m": {"x": 2e8, "y": 2e8, "z": 2e8}}
MACHINE = {
    "pinions": [
        {"name": "engine", "role": "input", "angle_deg": 0},
        {"name": "idler", "role": "idler", "angle_deg": 180},
    ],
    "pinion": BODY,
    "face_gear": BODY | {"mass_kg": 8, "inertia_kg_m2": 0.4},
    "damping": {"mesh_n_s_per_m": 1500, "mass_per_s": 50, "bearing_s": 2e-6},
    "transmission_error": "from_contact",
    "torque": {"per_input_n_m": 500, "tail_share": 0},
}
DYNAMICS = {"speed_rpm": 6000, "sweep": {"from_rpm": 500, "to_rpm": 9000, "points": 4}}
RIM = {"inner_radius_mm": 200, "back_mm": -12}
KEYS = {
    "helix_angle_deg": 14.0,
    "taper_angle_deg": 1.0,
    "shaft_angle_deg": 89.0,
    "offset_mm": 2.0,
    "pressure_angle_deg.coast": 23.0,
    "pinion.middle_mm": 228.5,
}
"""Keys of section `tooth_pair` that move nodes, and other values than those of `SECTION`."""
SECTION = public_section("P1") | {"pressure_angle_deg": {"drive": 25, "coast": 24}}


def moved(values, key, number):
    """Values with another number at a dotted key."""
    first, _, rest = key.partition(".")
    return {**values, first: moved(values[first], rest, number) if rest else number}


def machine(section, **values):
    """A machine with two gears and an idler between them, on coarse meshes."""
    given = {"case": "kind", "tooth_pair": section, **COARSE, "transmission": MACHINE, "dynamics": DYNAMICS}
    return facegear.load(given | values, results=None)


def searched(**limits):
    """The machine with a search over keys of its teeth."""
    search = {
        "variables": [
            {"name": key, "limits": [low, high], "sets": [f"tooth_pair.{key.replace('__', '.')}"]}
            for key, (low, high) in limits.items()
        ],
        "objectives": [{"name": "pressure", "largest_of": ["pressure"]}],
        "population": 4,
        "generations": 1,
        "hunting_cycles": 1,
        "seeds": [1],
    }
    return machine(SECTION, search=search)


def pair_of(section):
    """Resolved plain values of section `tooth_pair`."""
    return parse(ToothPair, section).model_dump(mode="json")


def test_design_is_the_machine_of_a_config_with_its_values():
    """Helix, offset and coast angle in one design: four flanks with contacts of their own."""
    numbers = {"helix_angle_deg": 14.0, "offset_mm": 2.0, "pressure_angle_deg__coast": 23.0}
    gearbox = searched(**{key: (0.9 * number, 1.1 * number) for key, number in numbers.items()})
    sampled = SearchedMachine.of_stage(**_fields(gearbox))
    goals, found = assessor(sampled, 1, 2)(list(numbers.values()))
    section = SECTION
    for key, number in numbers.items():
        section = moved(section, key.replace("__", "."), number)
    # a config rounds the backlash that it takes from the teeth, a design does not
    own, other = (geometric_backlash(parse(ToothPair, teeth)) for teeth in (SECTION, section))
    backlash = gearbox.values["transmission"]["backlash_um"] + other - own
    alone = machine(section, transmission=MACHINE | {"backlash_um": backlash})
    expected, loads = quasi_static_quantities(at_rest(machine_of(alone)), 1)
    assert {name: found[name] for name in expected} == pytest.approx(expected, rel=1e-9, abs=1e-12)
    by_flank = alone.contact().by_flank()
    arms = normal_arms(pair_design(parse(ToothPair, section)))
    layout = machine_of(alone).layout
    sides = [layout.gears[gear].side.value for _, gear in layout.meshes]
    names = [(side, flank) for flank in ("drive", "back") for side in sides]
    pressures = []
    for (side, flank), force in zip(names, loads.largest, strict=True):
        rows = by_flank[(by_flank["gear"] == side) & (by_flank["flank"] == flank)]
        pressures.append(contact_pressure(rows).at(force * arms[flank]) if force else 0.0)
    assert np.count_nonzero(pressures) == 4, "idlers carry on back flanks"
    assert found["pressure_mpa"] == pytest.approx(1e-6 * max(pressures), rel=1e-9)
    assert goals["pressure"] == found["pressure_mpa"]


def _fields(gearbox):
    """Fields of SearchedMachine as stage search_island is given them."""
    given = gearbox._chain.arguments("search_island")
    return {name: value for name, value in given.items() if name not in ("seed", "partial", "code")}


def test_each_flank_has_its_own_arm_pressure_and_root_stress():
    """Pressure and root stress are the largest of all flanks, not those of the drive flank at the peak."""
    flank = SimpleNamespace

    def answers(arm, factor):
        pressure = flank(at=lambda torque: 1e6 * factor * torque)
        return FlankAnswers(arm, pressure, {"pinion": lambda torque: 2e6 * factor * torque})

    flanks = answers(0.04, 1.0), answers(0.05, 3.0), answers(0.04, 7.0), answers(0.05, 5.0)
    pair = pair_of(SECTION)
    mesh = PairExcitation(
        ToothNumbers.of_config(pair),
        Harmonics(np.zeros(1), np.array([4e8])),
        None,
        answers=PairAnswers(np.zeros(4), flanks, np.array([[0, 1], [2, 3]])),
    )
    layout = wired_layout(machine(SECTION).values["transmission"], pair)
    sides = [layout.gears[gear].side.value for _, gear in layout.meshes]
    force = {("upper", "drive"): 100.0, ("upper", "back"): 60.0, ("lower", "drive"): 20.0}
    largest = np.array([force.get((side, name), 0.0) for name in ("drive", "back") for side in sides])
    found = mesh.quantities(FlankLoads(largest, largest), layout)
    assert found["pressure_mpa"] == pytest.approx(max(100 * 0.04 * 1, 60 * 0.05 * 3, 20 * 0.04 * 7))
    assert found["root_stress_pinion_mpa"] == pytest.approx(2.0 * found["pressure_mpa"])
    idle = mesh.quantities(FlankLoads(0.0 * largest, 0.0 * largest), layout)
    assert idle["pressure_mpa"] == 0.0


@pytest.fixture
def solved(monkeypatch):
    """Designs whose bodies are meshed and whose contact is solved; the contact ends without an answer."""
    lists = SimpleNamespace(meshed=[], solved=[])

    def mesh(design, *_):
        lists.meshed.append(design)
        return [SimpleNamespace(gauges=None)]

    def contact(design, *_):
        lists.solved.append(design)
        raise InvalidInput("contact", 0, "left out")

    monkeypatch.setattr(tooth_contact, "gear_flanks", mesh)
    monkeypatch.setattr(tooth_contact, "contact_analysis", contact)
    return lists


def sections():
    """Sections that samples of the pair take."""
    return dict(stage_needs("search_island", searched(offset_mm=(0.0, 1.0)).values)["pair"])


@pytest.mark.parametrize("key", KEYS)
def test_each_key_of_other_teeth_asks_for_bodies_and_contact_of_its_own(solved, key):
    pair = sections()
    nominal = [SimpleNamespace(gauges=None)]
    mesh = tooth_contact.meshes_in_contact(pair, {"pinion": nominal, "face_gear": nominal}, ["upper"])
    changed = moved(pair["tooth_pair"], key, KEYS[key])
    for values in (pair["tooth_pair"], changed):
        with pytest.raises(InvalidInput):
            mesh(values)
    expected = pair_design(ToothPair.of_config(changed))
    assert solved.meshed == 2 * [expected] and solved.solved[-1] == expected


def test_an_axial_setting_of_the_pinion_asks_for_a_contact_and_no_bodies(solved):
    pair = sections()
    nominal = [SimpleNamespace(gauges=None)]
    mesh = tooth_contact.meshes_in_contact(pair, {"pinion": nominal, "face_gear": nominal}, ["upper"])
    changed = moved(pair["tooth_pair"], "assembly.pinion_axial_um", 20.0)
    with pytest.raises(InvalidInput):
        mesh(changed)
    assert not solved.meshed and solved.solved[-1].assembly.pinion_axial == pytest.approx(2e-5)


@pytest.mark.parametrize("key", KEYS)
def test_a_body_with_fitted_teeth_is_another_for_each_key_of_other_teeth(key):
    body = parse(BodySection, {"teeth": "fitted", "rim": RIM})
    own, other = (parse(ToothPair, values) for values in (SECTION, moved(SECTION, key, KEYS[key])))
    keys = [body_key(body, pair, "upper") for pair in (own, other)]
    assert keys[0] != keys[1]


@pytest.mark.parametrize("key", KEYS)
def test_a_key_that_moves_nodes_is_no_cause(key):
    cause = {
        "name": "teeth",
        "shape": "uniform",
        "limits": [-0.01, 0.01],
        "moves": {f"tooth_pair.{key}": 1.0},
        "source": "drawing",
    }
    with pytest.raises(ConfigErrors, match=r"tolerances\.causes\.moves") as caught:
        machine(SECTION, tolerances={"causes": [cause]})
    line = str(caught.value)
    assert f"tooth_pair.{key}" in line and len(line.splitlines()) == 1


def test_friction_takes_the_contacts_of_all_flanks(monkeypatch):
    pair, nominal = sections(), [SimpleNamespace(gauges=None)]
    analysis = SimpleNamespace(ltca=[None], other_flanks=(), stored_pressure="all", pressure=["drive"])
    curve = SimpleNamespace(series=None, error=None, table=None)
    monkeypatch.setattr(tooth_contact, "gear_flanks", lambda *_: nominal)
    monkeypatch.setattr(tooth_contact, "contact_analysis", lambda *_: analysis)
    monkeypatch.setattr(tooth_contact, "curve_from_contact", lambda *_: curve)
    monkeypatch.setattr(tooth_contact, "_answers", lambda *_: None)
    flanks = {"pinion": nominal, "face_gear": nominal}
    mesh = tooth_contact.meshes_in_contact(pair, flanks, ["upper"], lambda ltca, pressure, teeth: pressure)
    assert mesh(moved(pair["tooth_pair"], "helix_angle_deg", 14.0)).lubricated_teeth == "all"


def test_a_design_whose_lower_gear_cannot_be_is_refused_by_key():
    """An offset of 25 mm leaves no height on the inside of the lower gear."""
    section = moved(public_section("P4") | {"offset_mm": 0.0}, "face_gear.inner_radius_mm", 236)
    search = {
        "variables": [{"name": "offset", "limits": [0, 25], "sets": ["tooth_pair.offset_mm"]}],
        "objectives": [{"name": "pressure", "largest_of": ["pressure"]}],
    }
    values = machine(section, search=search).values
    searched_machine = SearchedMachine(
        harmonics=None,
        **{key: values[key] for key in ("transmission", "tolerances", "tooth_pair", "search")},
        accuracy={},
        speed_rpm=6000.0,
        options={},
        pair={key: values[key] for key in ("tooth_pair", "mesh", "contact", "mesh_stiffness")},
        flanks={key: [SimpleNamespace(gauges=None)] for key in ("pinion", "face_gear")},
    )
    with pytest.raises(ConfigError, match="for the lower gear, which"):
        assessor(searched_machine, 1, 2)([25.0])
