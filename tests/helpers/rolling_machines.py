"""Machines whose pinions stand on shafts with rolling bearings: that of the notes, and random ones."""

from dataclasses import replace

import numpy as np
from rolling_bearings import P1, P2, P3, TAPERED

from facegear.bearings.shaft import RollingShaft, Support, find_shaft_equilibrium
from facegear.harmonics import Harmonics
from facegear.machine.drive_line import DriveLine
from facegear.machine.kinematics import GEOMETRIC
from facegear.machine.layout import Body, FaceGear, Layout, Pinion, Role, Side
from facegear.machine.machine import Damping, Machine
from facegear.machine.mean_load import with_states
from facegear.machine.rolling_seats import rolling_seat
from facegear.machine.torques import balanced_torques
from facegear.parts.shafts import Elasticity, Segment

STEEL = Elasticity(206e9, 0.3)
STEPPED = (Segment(0.04, 0.05, 0.02), Segment(0.05, 0.06, 0.02), Segment(0.04, 0.05, 0.02))
MESH_STIFFNESS = 4e8
THRUST = np.array([0.0, 0.0, 1.0, 0.0, 0.0])


def supports_of(*pairs, preload=0.0):
    """Supports from pairs of place and bearing; the first is pressed along +z by half of `preload`, m, the
    second against it.
    """
    offsets = [0.5 * preload * THRUST, -0.5 * preload * THRUST, *(len(pairs) - 2) * [0.0 * THRUST]]
    return tuple(Support(at, made, offset) for (at, made), offset in zip(pairs, offsets, strict=True))


S1 = RollingShaft(STEPPED, STEEL, supports_of((0.01, P1), (0.12, P3)), 0.06)


def public_layout(mesh_radius=None, pinions=((0.0, Role.INPUT), (90.0, Role.IDLER), (180.0, Role.IDLER))):
    """Layout of the notes: 20 and 60 teeth, module 3 mm, three pinions between two face gears."""
    radius = 0.5 * 3e-3 * 20 * np.cos(np.radians(25.0))
    on_springs = Body(1.2, 6e-4, (5e8, 5e8, 1e8))
    return Layout(
        pinions=tuple(
            Pinion(f"pinion {i}", role, angle / 6.0, on_springs) for i, (angle, role) in enumerate(pinions)
        ),
        gears=tuple(FaceGear(side, Body(8.0, 0.04, (8e8, 8e8, 1e9))) for side in (Side.LOWER, Side.UPPER)),
        pinion_teeth=20,
        gear_teeth=60,
        pressure_angle=np.radians(25.0),
        pinion_radius=radius,
        gear_radius=3.0 * radius,
        kinematics=GEOMETRIC,
    )


def constant(value):
    return Harmonics(np.zeros(1), np.array([value]))


def machine_on(shafts, torques=(1000.0, 0.0, 0.0), layout=None, tilt_inertias=None, half_backlash=40e-6):
    """The machine of the notes with shafts by the numbers of their pinions, linearised where a rough load
    puts them.
    """
    layout = layout or public_layout()
    force = np.array([-12_000.0, -4000.0, 0.0, 0.0, 0.0])
    states = {i: find_shaft_equilibrium(shaft, force) for i, shaft in shafts.items()}
    seats = {i: rolling_seat(shaft, states[i], (tilt_inertias or {}).get(i)) for i, shaft in shafts.items()}
    machine = Machine(
        layout=layout,
        torques=balanced_torques(layout, np.array(torques)),
        stiffness=constant(MESH_STIFFNESS),
        error=constant(0.0),
        half_backlash=np.full(len(layout.meshes), half_backlash),
        damping=Damping(0.0, 0.0, 0.0),
        drive_line=DriveLine(layout, seats, {}),
    )
    return with_states(machine, states)


def random_shaft(chance):
    """A shaft on two or three bearings of random kinds that hold it, with a preload or endplay."""
    kinds = [P1, replace(P2, first_element=chance.uniform(0, 1)), replace(TAPERED, speed=0.0)]
    first = kinds[chance.integers(3)]
    clearance = chance.uniform(-3e-6, 25e-6)
    angular = first.contact_angle > 0.0
    first = replace(first, clearance=0.0 if angular else clearance)
    if angular:
        second = replace(first, direction=-1)
    else:
        second = replace([P1, P3][chance.integers(2)], clearance=chance.uniform(-3e-6, 25e-6))
    places = [chance.uniform(0.002, 0.03), chance.uniform(0.09, 0.128)]
    pairs = list(zip(places, (first, second), strict=True))
    if chance.random() < 0.3:
        pairs.append((chance.uniform(0.05, 0.08), np.diag([1e8, 2e8, 0.0, 1e4, 2e4])))
    preload = chance.uniform(2e-6, 10e-6) if angular else 0.0
    return RollingShaft(STEPPED, STEEL, supports_of(*pairs, preload=preload), chance.uniform(0.0, 0.128))


def random_machine(seed):
    """A machine with three or four pinions, most of them on random shafts."""
    chance = np.random.default_rng(seed)
    angles = np.cumsum(chance.uniform(70.0, 90.0, chance.integers(3, 5)))
    roles = [Role.INPUT, *(Role(chance.choice(["input", "idler", "tail"])) for _ in angles[1:])]
    layout = public_layout(pinions=tuple(zip(angles.tolist(), roles, strict=True)))
    by_role = {Role.INPUT: chance.uniform(200, 900), Role.IDLER: 0.0, Role.TAIL: -chance.uniform(50, 200)}
    shafts = {i: random_shaft(chance) for i in range(angles.size) if i == 0 or chance.random() < 0.7}
    inertias = {i: 1.5e-3 for i in shafts if chance.random() < 0.5}
    torques = [by_role[role] for role in roles]
    return machine_on(shafts, torques, layout, inertias, half_backlash=chance.uniform(0.0, 60e-6))
