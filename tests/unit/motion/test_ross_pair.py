"""A spur pair that loses contact under a periodic torque, beside ROSS's pair with backlash.

ROSS 3.0.0 (package index, Python 3.12): MultiRotor of two rotors with one light shaft element each, gears of
25 and 60 teeth of 4 mm and 25 degrees, 1 kg, 0.002 and 0.02 kg m2, bearings of 1e11 N/m, gear_mesh_stiffness
1e7 N/m, backlash initial_value 1e-4 m without error_amp, its damping ratio of 0.07; torque of 1000 N and
300 N cos(w t) at the base radius of the driving gear, w 0.95 of sqrt(k / M_eq), from rest; deflection of the
mesh over the last of 30 periods by run_time_response, method newmark. Its distance from our motion falls in
proportion to the step: 400, 800 and 1600 steps a period.
"""

import numpy as np
import pytest
from references import against, agrees

import facegear
from facegear.door.outputs import machine_of
from facegear.motion.plan import Motion, Settings
from facegear.motion.steady_state.simulate import build_model, simulate

BY_STEPS = {
    400: (3.5033771207843175e-4, 3.523567958351671e-5, 1.858242123141256e-4),
    800: (3.479168805738341e-4, 3.90400823276108e-5, 1.86992888839051e-4),
    1600: (3.464892356856115e-4, 4.127910355085238e-5, 1.8766011445874584e-4),
}
"""Largest, smallest and mean deflection of the mesh, m, by steps of a period."""
TEETH, MODULE_MM, ANGLE = (25, 60), 4.0, np.radians(25.0)
STIFFNESS, INERTIAS, HALF_BACKLASH = 1e7, (0.002, 0.02), 1e-4


@pytest.fixture(scope="module")
def deflection():
    """Deflection of the mesh over a period in our motion, m."""
    first, second = (0.5e-3 * MODULE_MM * teeth * np.cos(ANGLE) for teeth in TEETH)
    mass = 1.0 / (first**2 / INERTIAS[0] + second**2 / INERTIAS[1])
    held = dict.fromkeys("xyz", 1e11)
    values = {
        "case": "pair",
        "tooth_pair": {
            "pinion_teeth": TEETH[0],
            "face_gear_teeth": TEETH[1],
            "module_mm": MODULE_MM,
            "pressure_angle_deg": 25,
        },
        "mesh_stiffness": {"source": "harmonics", "table": [{"order": 0, "cos_n_per_m": STIFFNESS}]},
        "transmission": {
            "pinions": [{"name": "pinion", "role": "input", "angle_deg": 0}],
            "face_gears": ["upper"],
            "pinion": {"mass_kg": 1, "inertia_kg_m2": INERTIAS[0], "bearing_stiffness_n_per_m": held},
            "face_gear": {"mass_kg": 1, "inertia_kg_m2": INERTIAS[1], "bearing_stiffness_n_per_m": held},
            "excitations": [{"body": "pinion", "order": TEETH[0], "torque_n_m": 300.0 * first}],
            "damping": {
                "mesh_n_s_per_m": 2.0 * 0.07 * np.sqrt(STIFFNESS * mass),
                "mass_per_s": 0,
                "bearing_s": 2e-6,
            },
            "backlash_um": 2e6 * HALF_BACKLASH,
            "transmission_error": {"amplitude_um": 0},
            "torque": {"per_input_n_m": 1000.0 * first, "tail_share": 0},
        },
    }
    machine = machine_of(facegear.load(values, None))
    model, omega = build_model(machine), 0.95 * np.sqrt(STIFFNESS / mass)
    response = simulate(model, omega / TEETH[0] * 30.0 / np.pi, Settings(tolerance=1e-10, samples=1024))
    assert (response.motion, response.period) == (Motion.PERIODIC, 1)
    return response.coordinates @ model.reduction.basis.T @ machine.linear.rows[0]


@against(
    "third-party program",
    "ROSS 3.0.0, its spur pair with backlash under a periodic torque, its time step going to zero",
    capability="dynamics_response",
    module="facegear.machine.disturbances",
)
def test_a_pair_with_backlash_moves_as_in_ross_as_its_step_goes_to_zero(deflection):
    found = np.array([deflection.max(), deflection.min(), deflection.mean()])
    assert found[1] < HALF_BACKLASH < found[0], "the flanks part"
    by_steps = np.array(list(BY_STEPS.values()))
    expected = 2.0 * by_steps[2] - by_steps[1]
    agrees("largest, smallest and mean deflection of a mesh, m", found, expected, absolute=5e-7)
    errors = np.abs(by_steps - found)
    assert (errors[1:] < 0.7 * errors[:-1]).all()
