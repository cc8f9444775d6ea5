"""A transmission of three pinions as a config has it, for tests of its sections."""

import numpy as np

from facegear.build.tooth_numbers import ToothNumbers
from facegear.harmonics import Harmonics

TEETH = ToothNumbers.of_teeth(23, 143, 3.75, 25)
STIFFNESS = Harmonics(np.array([0.0, 1e7]), np.array([4.1e8, 2e7]))
TEXT = """
pinions:
  - {name: one, role: input, angle_pitches: 0}
  - {name: two, role: input, angle_pitches: 45.5}
  - {name: tail, role: tail, angle_deg: 125.874}
pinion: {mass_kg: 1.2, inertia_kg_m2: 0.002, bearing_stiffness_n_per_m: {x: 6.5e7, y: 6.5e7, z: 0}}
face_gear: {mass_kg: 7.8, inertia_kg_m2: 0.54, bearing_stiffness_n_per_m: {x: 8.7e9, y: 8.7e9, z: 8.7e9}}
damping: {mesh_n_s_per_m: 1200, mass_per_s: 800, bearing_s: 2.0e-6}
backlash_um: 100
transmission_error: {amplitude_um: 10}
torque: {per_input_n_m: 800, tail_share: 0.1}
"""
