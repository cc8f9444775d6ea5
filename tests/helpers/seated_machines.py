"""The small machine of the public casing: three pinions between two gears, on fixed seats and on casings."""

import numpy as np

from facegear.harmonics import Harmonics
from facegear.machine.casing import Casing
from facegear.machine.kinematics import GEOMETRIC
from facegear.machine.layout import Body, FaceGear, Layout, Pinion, Role, Side
from facegear.machine.machine import Damping, Machine, OpenFlanks
from facegear.machine.torques import balanced_torques

STIFFNESS = 4e8
"""Mesh stiffness, N/m."""


def make_small_layout(turned=0.0, **bodies):
    pinion = bodies.get("pinion", Body(1.2, 6e-4, (5e8, 5e8, 1e8)))
    gear = bodies.get("gear", Body(8.0, 0.04, (8e8, 8e8, 1e9)))
    angle = np.radians(25.0)
    radius = 3e-3 * 20 / 2 * np.cos(angle)
    roles = (Role.INPUT, Role.IDLER, Role.IDLER)
    return Layout(
        pinions=tuple(Pinion(f"p{k}", role, 15.0 * k + turned, pinion) for k, role in enumerate(roles)),
        gears=(FaceGear(Side.LOWER, gear), FaceGear(Side.UPPER, gear)),
        pinion_teeth=20,
        gear_teeth=60,
        pressure_angle=angle,
        pinion_radius=radius,
        gear_radius=3.0 * radius,
        kinematics=GEOMETRIC,
    )


def make_small_machine(layout=None, casing=None, **changes):
    layout = layout or make_small_layout()
    values = {
        "layout": layout,
        "torques": balanced_torques(layout, np.array([1000.0, 0.0, 0.0])),
        "stiffness": Harmonics(np.zeros(1), np.array([STIFFNESS])),
        "error": Harmonics(np.zeros(1), np.zeros(1)),
        "half_backlash": np.full(len(layout.meshes), 40e-6),
        "damping": Damping(0.0, 0.0, 0.0, OpenFlanks.CONTACT_ONLY),
        "casing": casing,
    }
    return Machine(**{**values, **changes})


def place_on(mounted, layout=None):
    """Casing of the small machine, each body on the seat with its name."""
    layout = layout or make_small_layout()
    names = ["p0", "p1", "p2", "lower gear", "upper gear"]
    seats = {body: (name,) for body, name in enumerate(names)}
    return Casing(layout, mounted, seats, {}, {})
