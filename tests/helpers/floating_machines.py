"""Two pinions that float and tilt between two gears that tilt, with any teeth."""

from dataclasses import replace
from math import radians

import numpy as np
from wrench_machines import Teeth, make_layout, random_shaft

from facegear.harmonics import Harmonics
from facegear.machine.drive_line import DriveLine, Seat
from facegear.machine.imperfections import perfect
from facegear.machine.layout import Body, FaceGear, Pinion, Role, Side, Tilt
from facegear.machine.machine import Damping, Machine, OpenFlanks
from facegear.machine.torques import balanced_torques

K, SWING, ERROR, MESH_DAMPING = 4e8, 6e7, 4e-6, 800.0
MASS_DAMPING, BEARING_DAMPING = 300.0, 1e-6
PINION, GEAR, TILT, SEAT = (1.2, 0.002), (8.0, 0.5), 0.3, 1.5e-3
KINDS = {
    "helical": Teeth(25, 125, 3.5e-3, (radians(25),) * 2, radians(15), middle=0.228),
    "tapered": Teeth(23, 143, 3.75e-3, (radians(25),) * 2, 0.0, radians(4), middle=0.264),
    "all": Teeth(
        27, 120, 4e-3, (radians(25), radians(21)), radians(-10), radians(2), radians(97), 0.02, 0.235
    ),
}


def make_floating_machine(teeth: Teeth, moving: bool) -> Machine:
    """Two pinions between two gears: one on a shaft that bends, which tilts and turns; the gears tilt."""
    shaft = random_shaft(np.random.default_rng(54))
    across = np.linalg.inv(shaft.compliance[:2, :2])
    held = (across[0, 0], across[1, 1], 1.0 / shaft.compliance[2, 2])
    pinions = [
        Pinion("shaft", Role.INPUT, 0.0, Body(*PINION, held, across[0, 1])),
        Pinion("float", Role.IDLER, 20.5, Body(*PINION, (9e7, 7e7, 6e7))),
    ]
    gears = [
        FaceGear(side, Body(*GEAR, (2e9, 2e9, 1e9), 0.0, Tilt(TILT, 2e7, 0.01)))
        for side in (Side.LOWER, Side.UPPER)
    ]
    layout = make_layout(teeth, pinions, gears)
    flaws = replace(
        perfect(layout), error=5e-6 * np.array([1.0, -1.0, 0.5, 0.3]), outwards=np.array([1e-5, 0])
    )
    return Machine(
        layout=layout,
        torques=balanced_torques(layout, np.array([800.0, 0.0])),
        stiffness=Harmonics(np.array([0.0, SWING]), np.array([K, 0.0])),
        error=Harmonics(np.array([0.0, 0.0]), np.array([0.0, ERROR])),
        half_backlash=np.full(4, 8e-6),
        damping=Damping(MESH_DAMPING, MASS_DAMPING, BEARING_DAMPING, OpenFlanks.CONTACT_ONLY),
        imperfections=flaws,
        drive_line=DriveLine(layout, {0: Seat(shaft, SEAT)}, {}),
        has_phase_shifts=moving,
    )
