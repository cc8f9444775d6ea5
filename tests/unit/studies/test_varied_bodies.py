"""Samples and designs of a machine whose face gears bend."""

from dataclasses import replace
from pathlib import Path

import gear_bodies
import numpy as np
import pytest

import facegear
from facegear.build.config import resolved_values
from facegear.build.elastic_bodies import body_key
from facegear.build.load import load_config
from facegear.build.machine import MachineInputs
from facegear.build.tooth_numbers import ToothNumbers
from facegear.build.tooth_pair import ToothPair
from facegear.door.outputs import machine_of
from facegear.errors import ConfigError
from facegear.harmonics import Harmonics
from facegear.machine.static_gears import at_rest
from facegear.parts.reduced_body import ReducedBody
from facegear.pipeline.results.chain import Chain
from facegear.schema.base import parse
from facegear.schema.transmission import Transmission
from facegear.sharing.quantities import quasi_static_quantities
from facegear.studies import tooth_contact
from facegear.studies.machines import Question, judge
from facegear.studies.tooth_contact import PairExcitation, VariedBodies

FLEXIBLE = load_config(Path(__file__).parents[3] / "config" / "flexible.yaml")
K = Harmonics(np.zeros(1), np.array([4.1e8]))
QUESTION = Question("quasi_static", 1, {}, {})


def stiff(times: float) -> ReducedBody:
    body = gear_bodies.small_body()
    return replace(body, frequency=body.frequency * np.sqrt(times), static=body.static / times)


@pytest.fixture(scope="module")
def values():
    """Plain values without runouts: one mesh cycle is all of the hunting cycle."""
    plain = resolved_values(FLEXIBLE)
    for part in ("pinion", "face_gear"):
        plain["transmission"][part]["runout"] = None
    for single in plain["transmission"]["single_pinions"].values():
        single["runout"] = None
    plain["transmission"]["transmission_error"] = {"source": "given", "amplitude_um": 0}
    plain["transmission"]["face_gear"]["mass_kg"] = 45
    return {key: plain[key] for key in ("transmission", "tooth_pair", "dynamics")}


@pytest.fixture
def solved(monkeypatch):
    """Thickness at the rim of every web that is solved; it makes the body stiffer."""
    webs = []

    def solve(section, pair, side):
        webs.append(section.web.rim_thickness_mm)
        return stiff(2e4 * section.web.rim_thickness_mm / 12.0)

    monkeypatch.setattr(tooth_contact, "_solve_body", solve)
    return webs


def bodies_of(values) -> VariedBodies:
    arrays = {**stiff(2e4).arrays("lower"), **stiff(2e4).arrays("upper")}
    return VariedBodies.of_stage(values["transmission"], values["tooth_pair"], arrays)


def with_web(values, thickness, at_hub=18.0):
    web = {**values["transmission"]["face_gear"]["body"]["web"], "rim_thickness_mm": thickness}
    web["hub_thickness_mm"] = at_hub
    body = {**values["transmission"]["face_gear"]["body"], "web": web}
    gear = {**values["transmission"]["face_gear"], "body": body}
    return {**values, "transmission": {**values["transmission"], "face_gear": gear}}


def test_machine_among_many_shares_load_as_the_same_machine_alone(values, solved):
    numbers = ToothNumbers.of_config(values["tooth_pair"])
    judged = judge(QUESTION, lambda pair: PairExcitation(numbers, K, None), "this", bodies_of(values))
    rigid = judge(QUESTION, lambda pair: PairExcitation(numbers, K, None), "this")(values)
    for thickness, times in ((12.0, 2e4), (9.0, 1.5e4)):
        given = with_web(values, thickness)
        arrays = {**stiff(times).arrays("lower"), **stiff(times).arrays("upper")}
        section = parse(Transmission, given["transmission"])
        alone = at_rest(
            MachineInputs(transmission=section, teeth=numbers, harmonics=K, bodies=arrays).build()
        )
        expected, _ = quasi_static_quantities(alone, 1)
        found = judged(given)
        assert found == pytest.approx(expected, rel=1e-12)
        assert max(abs(found[name] - rigid[name]) for name in found) > 1e-3
    assert solved == [9.0]


def test_body_is_solved_once_for_every_section_and_not_for_what_it_does_not_depend_on(values, solved):
    bodies, numbers = bodies_of(values), ToothNumbers.of_config(values["tooth_pair"])
    for thickness in (12.0, 10.0, 12.0, 10.0, 11.0):
        given = with_web(values, thickness)
        given["transmission"]["face_gear"]["mass_kg"] = 40.0 + thickness
        section = parse(Transmission, given["transmission"])
        joined = bodies.add_bodies(
            MachineInputs(transmission=section, teeth=numbers, harmonics=K).build(),
            section,
            given["tooth_pair"],
        )
        assert len(joined.softening) == 10
    assert solved == [10.0, 11.0]


@pytest.mark.parametrize(("key", "value"), [("shaper", {"teeth": 25}), ("pressure_angle_deg", 24.0)])
def test_fitted_body_is_another_where_the_teeth_are_cut_otherwise_and_not_where_they_are_relieved(key, value):
    pair = FLEXIBLE.tooth_pair.model_dump(mode="json")
    changed = {**pair, key: {**pair[key], **value} if isinstance(value, dict) else value}
    relief = {"tip_relief": {"amount_um": 9.0, "start_mm": 0.5, "length_mm": 1.0}}
    relieved = {**pair, "face_gear": {**pair["face_gear"], "modifications": relief}}
    own, other, same = (parse(ToothPair, given) for given in (pair, changed, relieved))
    fitted = FLEXIBLE.transmission.face_gear.body.model_copy(update={"teeth": "fitted"})
    key_of = body_key
    keys = [key_of(fitted, teeth, "upper") for teeth in (own, same, other)]
    assert keys[0] == keys[1] != keys[2]


def test_design_whose_mass_cannot_hold_its_web_is_refused_before_it_is_solved(values, solved):
    given = with_web(values, 12.0, at_hub=30.0)
    given["transmission"]["face_gear"]["mass_kg"] = 32
    section = parse(Transmission, given["transmission"])
    machine = MachineInputs(
        transmission=section, teeth=ToothNumbers.of_config(values["tooth_pair"]), harmonics=K
    ).build()
    with pytest.raises(ConfigError, match=r"transmission\.face_gear\.mass_kg = 32"):
        bodies_of(values).add_bodies(machine, section, given["tooth_pair"])
    assert not solved


def test_machine_that_is_exported_bends_as_the_one_that_is_computed(monkeypatch, values):
    """An FMU was rigid where its gears bend."""
    box = facegear.load("config/flexible.yaml", results=None)
    given = {
        "transmission": parse(Transmission, values["transmission"]),
        "teeth": ToothNumbers.of_config(FLEXIBLE.tooth_pair.model_dump()),
        "harmonics": K,
        "bodies": stiff(2e4).arrays("upper"),
    }
    monkeypatch.setattr(Chain, "arguments", lambda self, stage: given)
    assert machine_of(box).bodies is not None
