"""Machines whose numbers other people have published, put into a config as they stand there.

Gunter and Chen 2001, example 8.1: two turbines drive a ship's propeller through two reductions each. The
second reductions are referred to the speed of the intermediate gears, and all meshes are stiff (1e12 N/m at a
gear of 16 m), as the book has rigid ones. It cannot see mesh stiffness, and nothing of errors.
"""

from dataclasses import replace

import numpy as np
import pytest
from references import against, agrees

import facegear
from facegear.door.outputs import machine_of
from facegear.machine.shaft_orders import loaded_machine

TO_SI = 0.11298
"""Inertia in lb in s2, stiffness in lb in/rad and torque in lb in, to kg m2, N m/rad and N m."""
PINION_TEETH, GEAR_TEETH = 17, 160
FIRST_RATIO, HIGH_RATIO, LOW_RATIO = 9.4094, 78.2365, 40.0424
"""Speeds of the intermediate gears, of the high- and the low-pressure turbine, over the propeller's."""
PROPELLER_TORQUE, PROPELLER_RPM, BLADES = 22.24e6 * TO_SI, 85.0, 5
CYCLES_PER_MINUTE = [177.7, 220.2, 1282.6]
BY_OPENTORSION = {15.0: 8802.979996, 25.0: 39765.5267, 60.0: 62413.06353, 85.0: 48938.08878}
"""Vibratory torque (N m) of the propeller's shaft by its speed (rpm): openTorsion 0.3.2, the assembly of its
own example marine_steam_turbine_forced_response.py, `vibratory_torque` with a damping matrix of zeros.
"""
FIGURE = {
    15.0: 8629.8,
    25.0: 39628.0,
    30.0: 100033.0,
    60.0: 60776.0,
    70.0: 52538.0,
    85.0: 47455.0,
    97.0: 46274.0,
}
"""Values of figure 8.10-5 of the book, as the authors of openTorsion read it, off its resonance."""


def make_marine_drive():
    """Build the ship's drive; its ratio of 160/17 is that of the book but for a scale of inertias."""
    scale = (FIRST_RATIO * PINION_TEETH / GEAR_TEETH) ** 2
    held = dict.fromkeys("xyz", 1e14)

    def masses(ratio, shafts, inertias):
        squared = scale * np.array([1.0, (ratio / FIRST_RATIO) ** 2]) * TO_SI
        names = "intermediate", "turbine"
        stiffness, inertia = squared * shafts, squared * inertias
        return [
            {"name": name, "stiffness_n_m_per_rad": k, "inertia_kg_m2": i, "damping_ratio": 0.0}
            for name, k, i in zip(names, stiffness.tolist(), inertia.tolist(), strict=True)
        ]

    values = {
        "case": "marine",
        "tooth_pair": {
            "pinion_teeth": PINION_TEETH,
            "face_gear_teeth": GEAR_TEETH,
            "module_mm": 100,
            "pressure_angle_deg": 25,
        },
        "mesh_stiffness": {"source": "harmonics", "table": [{"order": 0, "cos_n_per_m": 1e12}]},
        "transmission": {
            "pinions": [
                {"name": "high", "role": "input", "angle_deg": 0},
                {"name": "low", "role": "input", "angle_deg": 180},
            ],
            "face_gears": ["upper"],
            "pinion": {"mass_kg": 100, "inertia_kg_m2": 1e-3, "bearing_stiffness_n_per_m": held},
            "face_gear": {
                "mass_kg": 1000,
                "inertia_kg_m2": 0.826e6 * TO_SI,
                "bearing_stiffness_n_per_m": held,
            },
            "torsion": {
                "high": masses(HIGH_RATIO, np.array([24.17e6, 14.26e6]), np.array([2.723e4, 2.612e2])),
                "low": masses(LOW_RATIO, np.array([203.94e6, 30.51e6]), np.array([1.283e4, 1.509e4])),
                "output": [
                    {
                        "name": "propeller",
                        "stiffness_n_m_per_rad": 826e6 * TO_SI,
                        "inertia_kg_m2": 2.454e6 * TO_SI,
                        "damping_ratio": 0.0,
                    }
                ],
            },
            "excitations": [{"body": "upper", "order": BLADES, "torque_n_m": 0.1 * PROPELLER_TORQUE}],
            "damping": {"mesh_n_s_per_m": 0, "mass_per_s": 0, "bearing_s": 0},
            "backlash_um": 0,
            "transmission_error": {"amplitude_um": 0},
            "torque": {
                "per_input_n_m": 0.5 * PROPELLER_TORQUE * PINION_TEETH / GEAR_TEETH,
                "tail_share": 0,
            },
        },
    }
    return facegear.load(values, None)


def vibratory_torques(speeds_rpm):
    """Torque in the propeller's shaft (N m), whose excitation grows with the square of the speed."""
    gearbox = make_marine_drive()
    rows = [
        gearbox.with_values(
            {"dynamics.speed_rpm": speed * GEAR_TEETH / PINION_TEETH, "dynamics.sweep.points": 2}
        )
        .shaft_orders()
        .excited()
        for speed in speeds_rpm
    ]
    torques = [
        table.loc[table["part"] == "upper face gear:propeller", "torque_n_m"].iloc[0] for table in rows
    ]
    return np.array(torques) * (np.array(speeds_rpm) / PROPELLER_RPM) ** 2


@against(
    "external source",
    "Gunter and Chen 2001, example 8.1: two turbines on a ship's gear",
    capability="modal",
    module="facegear.machine.drive_line",
)
def test_two_turbines_on_a_ships_gear_have_the_printed_frequencies():
    frequencies = 60.0 * make_marine_drive().modes().table()["frequency_hz"].to_numpy()
    agrees("natural frequency, cycles a minute", frequencies[1:4], CYCLES_PER_MINUTE, absolute=0.05)


@against(
    "external source",
    "Gunter and Chen 2001, figure 8.10-5 as read by the authors of openTorsion",
    capability="shaft_orders",
    module="facegear.machine.shaft_orders",
)
def test_the_propellers_shaft_carries_the_torque_of_the_published_figure():
    """Away from the resonance, where the damping of the book's propeller takes off less than 3 %."""
    found = vibratory_torques(list(FIGURE))
    agrees("vibratory torque of the propeller's shaft, N m", found, list(FIGURE.values()), relative=0.07)


@against(
    "third-party program",
    "openTorsion 0.3.2, its own example of that machine without damping",
    capability="shaft_orders",
    module="facegear.machine.shaft_orders",
)
def test_the_propellers_shaft_carries_the_torque_that_opentorsion_finds():
    found = vibratory_torques(list(BY_OPENTORSION))
    expected = list(BY_OPENTORSION.values())
    agrees("vibratory torque of the propeller's shaft, N m", found, expected, relative=1e-5)


def test_torque_and_inertia_of_the_propeller_balance_at_every_frequency():
    """The spring's torque and the excitation turn the propeller's mass, in the whole motion of all bodies."""
    machine = machine_of(make_marine_drive())
    excitation = replace(machine.excitations[0], amplitude=1000.0, phase=0.7)
    loaded, spring = loaded_machine(machine), machine.drive_line.springs()[-1]
    motion = loaded.excited_motion(machine, excitation, 500.0)
    omega = 500.0 * np.pi / 30.0 * PINION_TEETH * excitation.of_mesh
    left = spring.stiffness * (motion[spring.first] - motion[spring.second])
    mass = machine.linear.mass[spring.second, spring.second]
    force = 1000.0 * np.exp(0.7j) * machine.straining_torque(excitation.body)[spring.second]
    assert left + force == pytest.approx(-(omega**2) * mass * motion[spring.second], rel=1e-9)
