"""From config keys to the machine and its settings."""

import numpy as np
import pytest

from facegear.build.lumped_model import machine
from facegear.build.machine_layout import layout
from facegear.build.plans import settings, sweep_plan
from facegear.build.tooth_numbers import ToothNumbers
from facegear.errors import ConfigErrors
from facegear.harmonics import Harmonics
from facegear.schema.base import parse
from facegear.schema.motion import Dynamics
from facegear.schema.transmission import Transmission

TEETH = ToothNumbers.of_teeth(23, 143, 3.75, 25)
STIFFNESS = Harmonics(np.array([0.0, 1e7]), np.array([4.1e8, 2e7]))


def section(**changes):
    body = {"mass_kg": 1.2, "inertia_kg_m2": 0.002}
    values = {
        "pinions": [
            {"name": "tail", "role": "tail", "angle_pitches": 0},
            {"name": "one", "role": "input", "angle_pitches": 45.5},
            {"name": "two", "role": "input", "angle_deg": 245.0},
        ],
        "pinion": {**body, "bearing_stiffness_n_per_m": {"x": 6.5e7, "y": 6.5e7, "z": 0}},
        "face_gear": {
            "mass_kg": 7.8,
            "inertia_kg_m2": 0.54,
            "bearing_stiffness_n_per_m": {"x": 8.7e9, "y": 8.7e9, "z": 8.7e9},
        },
        "damping": {"mesh_n_s_per_m": 1200, "mass_per_s": 800, "bearing_s": 2e-6},
        "backlash_um": 100,
        "transmission_error": {"amplitude_um": 50},
        "torque": {"per_input_n_m": 800, "tail_share": 0.1},
    }
    return {**values, **changes}


def test_units_of_the_config_become_si():
    built = machine(parse(Transmission, section()), TEETH, STIFFNESS)
    assert built.half_backlash == pytest.approx(np.full(len(built.layout.meshes), 50e-6))
    assert built.error.amplitudes == pytest.approx([0.0, 50e-6])
    assert built.layout.pinion_radius == pytest.approx(39.0845e-3, abs=5e-8)
    assert built.layout.pinions[2].pitches == pytest.approx(245 / 360 * 143)


def test_torques_follow_roles_shares_and_overrides_and_balance():
    built = machine(parse(Transmission, section()), TEETH, STIFFNESS)
    ratio = built.layout.gear_radius / built.layout.pinion_radius
    np.testing.assert_allclose(built.torques, [-160, 800, 800, 0, -1440 * ratio])
    places = section()["pinions"]
    places[2] = {**places[2], "torque_n_m": 0}
    out = machine(parse(Transmission, section(pinions=places)), TEETH, STIFFNESS)
    np.testing.assert_allclose(out.torques[:3], [-160, 800, 0])


def test_range_of_the_error_is_twice_its_amplitude_and_phase_shifts_it():
    error = {"amplitude_um": 50, "meaning": "range", "phase_deg": 90}
    series = machine(parse(Transmission, section(transmission_error=error)), TEETH, STIFFNESS).error
    assert series(0.25) == pytest.approx(-25e-6)


def test_a_single_face_gear_is_a_layout():
    shape = layout(parse(Transmission, section(face_gears=["upper"])), TEETH)
    assert shape.body_names == ("tail", "one", "two", "upper face gear")
    assert len(shape.meshes) == 3


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        ({"pinions": []}, "pinions"),
        ({"backlash_um": -1}, "backlash_um"),
        ({"face_gears": ["upper", "upper"]}, "face_gears"),
        ({"pinions": [{"name": "a", "role": "input"}]}, "angle_pitches"),
        ({"pinions": [{"name": "a", "role": "input", "angle_pitches": 0}]}, "tail_share"),
        ({"torque": {"per_input_n_m": 800, "tail_shar": 0.1}}, "tail_share"),
    ],
)
def test_impossible_values_are_refused_by_key(changes, line):
    with pytest.raises(ConfigErrors, match=line):
        parse(Transmission, section(**changes))


def test_defaults_make_a_sweep_of_400_speeds_both_ways():
    plan = sweep_plan(Dynamics().sweep)
    assert plan.points == 400 and plan.directions == ("up", "down")
    runs = [plan.chunk("down", k)[1] for k in range(plan.chunks)]
    np.testing.assert_array_equal(np.concatenate(runs), plan.speeds[::-1])
    assert settings(Dynamics().accuracy).tolerance == 1e-6


def test_an_empty_sweep_range_is_refused():
    with pytest.raises(ConfigErrors, match=r"sweep\.to_rpm"):
        parse(Dynamics, {"sweep": {"from_rpm": 500, "to_rpm": 400}})
