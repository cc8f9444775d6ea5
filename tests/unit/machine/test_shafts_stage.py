"""Results of stage shafts: stiffness, bearing loads and twist of a machine under its mean torques."""

from pathlib import Path

import numpy as np
import pytest
from references import against, agrees
from ruamel.yaml import YAML

import facegear
from facegear.build.machine import MachineInputs
from facegear.build.tooth_numbers import ToothNumbers
from facegear.errors import ConfigError
from facegear.harmonics import Harmonics
from facegear.pipeline.stages.machine import shafts
from facegear.schema.base import parse
from facegear.schema.transmission import Transmission

TEETH = ToothNumbers.of_teeth(23, 143, 3.75, 25)
TEXT = """
pinions:
  - {name: one, role: input, angle_pitches: 0}
  - {name: two, role: input, angle_pitches: 71.5}
pinion: {mass_kg: 1.2, inertia_kg_m2: 0.002}
face_gears: [upper]
face_gear: {mass_kg: 7.8, inertia_kg_m2: 0.54, bearing_stiffness_n_per_m: {x: 8.7e9, y: 8.7e9, z: 8.7e9}}
damping: {mesh_n_s_per_m: 1200, mass_per_s: 800, bearing_s: 2.0e-6}
backlash_um: 100
transmission_error: {amplitude_um: 10}
torque: {per_input_n_m: 800, tail_share: 0}
shafts:
  input:
    segments: [{length_mm: 120, diameter_mm: 40}]
    pinion_mm: 50
    bearings:
      - {at_mm: 0, radial_n_per_m: 1.5e8, axial_n_per_m: 1.0e8}
      - {at_mm: 120, radial_n_per_m: 2.5e8}
torsion:
  input:
    - {name: coupling, inertia_kg_m2: 0.002, stiffness_n_m_per_rad: 6.0e5}
    - {name: engine, inertia_kg_m2: 0.08, stiffness_n_m_per_rad: 2.5e4}
"""
EXAMPLE = Path(__file__).parents[3] / "config" / "shafts.yaml"
STIFFNESS = Harmonics(np.zeros(1), np.array([4.1e8]))


def outcome(**changes):
    section = parse(Transmission, {**YAML(typ="safe").load(TEXT), **changes})
    return shafts(MachineInputs(transmission=section, teeth=TEETH, harmonics=STIFFNESS))


@against(
    "analytic",
    "two equal pinions opposite each other: lever rule and compliance of bodies.md 6",
    capability="shafts",
    module="facegear.pipeline.stages.machine",
)
def test_two_equal_pinions_load_their_bearings_by_the_lever_rule():
    found = outcome().content
    force = 800.0 / (3.75e-3 * 11.5)
    tangential, separating = -force, -force * np.tan(np.radians(25.0))
    loads = found["bearings"].set_index(["pinion", "bearing"])
    for bearing, part in (("A", 7 / 12), ("B", 5 / 12)):
        own = loads.loc[("one", bearing)]
        agrees("load along x, N", own["x_n"], part * tangential, relative=1e-9)
        agrees("load along y, N", own["y_n"], part * separating, relative=1e-9)
    seat = found["seats"].set_index("pinion").loc["two"]
    agrees("displacement along x, um", seat["x_um"], 1e6 * 4.60795e-9 * tangential, relative=5e-7)
    agrees("slope in x, urad", seat["tilt_y_urad"], -1e6 * 1.10072e-8 * tangential, relative=5e-6)
    agrees("slope in y, urad", seat["tilt_x_urad"], 1e6 * 1.10072e-8 * separating, relative=5e-6)
    stiffness = found["stiffness"].set_index(["pinion", "motion"])
    agrees("K_x,ty, N/rad", stiffness.loc[("one", "x"), "tilt_y"], 1.946227e6, relative=5e-7)


@against(
    "analytic",
    "a chain of torsional springs under one torque",
    capability="shafts",
    module="facegear.pipeline.stages.machine",
)
def test_torque_winds_every_spring_of_a_chain_up():
    torsion = outcome().content["torsion"].set_index(["body", "mass"]).loc["one"]
    twist = np.degrees(800.0 / np.array([6e5, 2.5e4]))
    agrees("twist, deg", torsion["twist_deg"], twist, relative=1e-12)
    agrees("wind-up, deg", torsion["windup_deg"], np.cumsum(twist), relative=1e-12)
    first, second, third = 1 / 0.002, 1 / 0.002, 1 / 0.08
    s = 6e5 * (first + second) + 2.5e4 * (second + third)
    p = 6e5 * 2.5e4 * (0.002 + 0.002 + 0.08) * first * second * third
    exact = np.sqrt(s / 2 + np.array([-1, 1]) * np.sqrt(s**2 / 4 - p)) / (2 * np.pi)
    agrees("frequencies of the chain, Hz", torsion["frequency_hz"], exact, relative=1e-9)


def test_a_machine_without_shafts_or_torsion_has_no_such_answer():
    bare = {"mass_kg": 1.2, "inertia_kg_m2": 0.002, "bearing_stiffness_n_per_m": {"x": 1e8, "y": 1e8, "z": 0}}
    with pytest.raises(ConfigError, match=r"transmission\.shafts = \{\}: must be given"):
        outcome(pinion=bare, shafts={}, torsion={})
    only = outcome(pinion=bare, shafts={}).content
    assert only["seats"].empty and len(only["torsion"]) == 4


def test_the_front_door_answers_with_the_shafts_of_the_example_config():
    found = facegear.load(EXAMPLE).shafts()
    assert found.bearings()["pinion"].nunique() == len(found.table()) == 5
    assert set(found.torsion()["mass"]) == {"engine", "tail_rotor", "rotor"}
    assert (found.torsion()["windup_deg"].abs() > 0.0).all() and len(found.stiffness()) == 25
