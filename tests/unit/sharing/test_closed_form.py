"""Load sharing of inputs and idlers in closed form equals the library's own statics."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import facegear
from facegear.sharing.closed_form import SplitMachine

STIFFNESS, ANGLE = 4.1e8, np.radians(25.0)


@st.composite
def split_machines(draw):
    """Idlers, bearings (N/m) and backlash (um) of a machine whose inputs keep both drive flanks closed."""
    return (
        draw(st.sampled_from([2, 3])),
        10 ** draw(st.floats(7.5, 8.5)),
        10 ** draw(st.floats(8.5, 9.5)),
        draw(st.floats(10.0, 60.0)),
    )


def config_of(idlers, input_bearing, idler_bearing, backlash_um):
    places = [0, 28, 57, 86, 114] if idlers == 3 else [0, 36, 72, 107]
    roles = ["input", "idler", "input", "idler", "idler"] if idlers == 3 else ["input", "idler"] * 2
    pinions = [
        {"name": f"{role} {number}", "role": role, "angle_pitches": place}
        for number, (role, place) in enumerate(zip(roles, places, strict=True))
    ]
    bearings = {
        pinion["name"]: {"bearing_stiffness_n_per_m": dict.fromkeys("xyz", stiffness)}
        for pinion in pinions
        for stiffness in [input_bearing if pinion["role"] == "input" else idler_bearing]
    }
    rigid = dict.fromkeys("xyz", 1e14)
    return {
        "case": "split",
        "tooth_pair": {
            "pinion_teeth": 23,
            "face_gear_teeth": 143,
            "module_mm": 3.75,
            "pressure_angle_deg": 25,
        },
        "mesh_stiffness": {"source": "harmonics", "table": [{"order": 0, "cos_n_per_m": STIFFNESS}]},
        "transmission": {
            "pinions": pinions,
            "face_gears": ["lower", "upper"],
            "pinion": {"mass_kg": 1.2, "inertia_kg_m2": 0.002, "bearing_stiffness_n_per_m": rigid},
            "face_gear": {"mass_kg": 8.0, "inertia_kg_m2": 0.5, "bearing_stiffness_n_per_m": rigid},
            "single_pinions": bearings,
            "damping": {"mesh_n_s_per_m": 1000, "mass_per_s": 0, "bearing_s": 2.0e-6},
            "backlash_um": backlash_um,
            "transmission_error": {"amplitude_um": 0},
            "torque": {"per_input_n_m": 1328, "tail_share": 0},
        },
    }


@settings(max_examples=8, deadline=None)
@given(split_machines())
def test_k_gamma_of_inputs_and_force_of_idlers_are_those_of_the_statics(drawn):
    idlers, input_bearing, idler_bearing, backlash_um = drawn
    force = facegear.load(config_of(*drawn)).statics().table().set_index("mesh")["force_n"].abs()
    arm = 0.5 * 3.75e-3 * 23 * np.cos(ANGLE)
    machine = SplitMachine(2, idlers, 1328 / arm, STIFFNESS, 1e-6 * backlash_um, 2.0 * np.cos(ANGLE))
    inputs = force[[name.startswith("input") and name.endswith("upper") for name in force.index]]
    led = force[[name.startswith("idler") for name in force.index]]
    k_gamma = machine.input_k_gamma(input_bearing, idler_bearing)
    assert inputs.to_numpy() / (0.5 * 1328 / arm) == pytest.approx(k_gamma, rel=1e-4)
    assert led.to_numpy() == pytest.approx(machine.idler_force(input_bearing, idler_bearing), rel=1e-3)


@given(st.floats(1.05, 1.6), st.floats(8.5, 9.5), st.floats(0.0, 200e-6))
def test_the_bearing_chosen_for_a_k_gamma_gives_it(k_gamma, decade, backlash):
    machine = SplitMachine(2, 3, 33e3, STIFFNESS, backlash, 2.0 * np.cos(ANGLE))
    bearing = machine.input_bearing_for(k_gamma, 10**decade)
    if np.isfinite(bearing):
        assert machine.input_k_gamma(bearing, 10**decade) == pytest.approx(min(k_gamma, 2.0), rel=1e-9)
    else:
        assert machine.input_k_gamma(1e16, 10**decade) <= k_gamma + 1e-6
