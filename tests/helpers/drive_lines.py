"""Machines whose pinions sit on shafts and whose torques turn masses behind torsional springs."""

from dataclasses import replace

import numpy as np
from lumped_machines import make_layout, make_machine

from facegear.machine.drive_line import DriveLine, Seat, TurningMass
from facegear.machine.kinematics import GEOMETRIC
from facegear.parts.shafts import Bearing, Elasticity, Segment, Shaft, condense_shaft

TILT_INERTIA = 1.5e-3
CHAINS = {
    2: (TurningMass("coupling", 6e5, 0.002, 0.02), TurningMass("engine", 2.5e4, 0.08, 0.01)),
    3: (TurningMass("engine", 2.5e4, 0.08),),
    6: (TurningMass("rotor", 5e6, 30.0, 0.005),),
}


def on_bearings(first, second, young=1.0, coupled=0.0):
    """A pinion between two bearings; coupled (N/rad): z with tilt_y in the first."""
    matrix = np.diag([first, first, 1e8, 2e5, 2e5])
    matrix[2, 4] = matrix[4, 2] = coupled
    bearings = (Bearing(0.0, matrix), Bearing(0.12, np.diag([second, second, 0.0, 0.0, 0.0])))
    return condense_shaft(Shaft((Segment(0.12, 0.04),), Elasticity(young * 206e9, 0.3), bearings, 0.05))


def seated(shaft, layout, tilting=True, masses=None):
    """A layout whose pinions all sit on a shaft, and its drive line."""
    across = np.linalg.inv(shaft.compliance[:2, :2])
    bearing = (across[0, 0], across[1, 1], 1.0 / shaft.compliance[2, 2])
    pinions = tuple(replace(p, body=replace(p.body, bearing=bearing)) for p in layout.pinions)
    placed = replace(layout, pinions=pinions)
    seat = Seat(shaft, TILT_INERTIA if tilting else None)
    return placed, DriveLine(placed, dict.fromkeys(range(len(pinions)), seat), masses or {})


def driven(shaft=None, tilting=True, masses=None, layout=None, **more):
    """The paper's layout, or another, with a shaft for every pinion and masses by bodies."""
    layout = layout or make_layout(kinematics=GEOMETRIC)
    line = DriveLine(layout, {}, masses or {})
    if shaft is not None:
        layout, line = seated(shaft, layout, tilting, masses)
    return replace(make_machine(layout, **more), drive_line=line if shaft or masses else None)
