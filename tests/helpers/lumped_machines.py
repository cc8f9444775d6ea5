"""The paper's lumped model for unit tests, with stated placeholders for what the paper leaves out."""

import numpy as np

from facegear.harmonics import Harmonics
from facegear.machine.kinematics import PRINTED_KINEMATICS
from facegear.machine.layout import Body, FaceGear, Layout, Pinion, Role, Side
from facegear.machine.machine import Damping, Machine, OpenFlanks
from facegear.machine.torques import balanced_torques, pinion_torques

PLACES = (
    ("tail idler", Role.TAIL, 0.0),
    ("right idler", Role.IDLER, 22.5),
    ("right input", Role.INPUT, 45.5),
    ("left input", Role.INPUT, 97.5),
    ("left idler", Role.IDLER, 120.5),
)


def make_layout(
    places=PLACES,
    sides=(Side.LOWER, Side.UPPER),
    pinion_bearing=6.5e7,
    gear_bearing=8.7e9,
    kinematics=PRINTED_KINEMATICS,
) -> Layout:
    pinion = Body(1.199, 0.002, (pinion_bearing, pinion_bearing, 0.0))
    gear = Body(7.795, 0.54, (gear_bearing,) * 3)
    angle = np.radians(25.0)
    return Layout(
        pinions=tuple(Pinion(name, role, pitches, pinion) for name, role, pitches in places),
        gears=tuple(FaceGear(side, gear) for side in sides),
        pinion_teeth=23,
        gear_teeth=143,
        pressure_angle=angle,
        pinion_radius=3.75e-3 * 23 / 2 * np.cos(angle),
        gear_radius=0.2625 if kinematics is PRINTED_KINEMATICS else 3.75e-3 * 143 / 2 * np.cos(angle),
        kinematics=kinematics,
    )


def make_machine(
    layout=None,
    torque=800.0,
    tail_share=0.1,
    backlash=100e-6,
    error=50e-6,
    stiffness=None,
    mesh_damping=1200.0,
    mass_damping=800.0,
    bearing_damping=2e-6,
    open_flanks=OpenFlanks.ALWAYS,
    imperfections=None,
) -> Machine:
    layout = layout or make_layout()
    stiffness = stiffness or Harmonics(np.array([0.0, 2e7, 6e6]), np.array([4.1e8, 3e7, -8e6]))
    return Machine(
        layout=layout,
        torques=balanced_torques(layout, pinion_torques(layout, torque, tail_share)),
        stiffness=stiffness,
        error=Harmonics(np.zeros(2), np.array([0.0, error])),
        half_backlash=np.full(len(layout.meshes), backlash / 2),
        damping=Damping(mesh_damping, mass_damping, bearing_damping, open_flanks),
        imperfections=imperfections,
    )


def drive_rows(layout):
    """Rows of the drive flanks alone, (meshes, dof)."""
    return layout.kinematics.flank_rows(layout)[: len(layout.meshes)]


def mesh_parts(layout):
    """Tangential and separating part of the flanks' rows of spur teeth, (meshes, dof) each."""
    drive, back = np.split(layout.kinematics.flank_rows(layout), 2)
    return 0.5 * (drive - back), 0.5 * (drive + back)
