"""Random machines on rolling bearings and a casing, and their statics and tangent modes written once more.

One Newton iteration runs over the energy of everything: bodies, beams of the shafts by finite elements,
bearings by the formulas in NumPy, and the casing. Flanks, seats and axes are written by vectors of space.
"""

from dataclasses import replace

import numpy as np
from rolling_machines import MESH_STIFFNESS, machine_on, public_layout, random_shaft
from whole_energy import WholeMachine, beam_stiffness, mesh_of

from facegear.casing.mounted import mount
from facegear.casing.reduction import Interface, Reduction
from facegear.machine.casing import Casing
from facegear.machine.layout import Role

PINION_RADIUS, GEAR_RADIUS = 0.03, 0.09
ANGLE = np.radians(25.0)
Z = np.array([0.0, 0.0, 1.0])


def random_casing(chance, places):
    """A casing of coupled springs and masses below seats at places (k, 3), m."""
    size = 6 * len(places)
    springs = np.tile([6e8, 6e8, 6e8, 3e6, 3e6, 3e6], len(places)) * np.exp(chance.normal(0.0, 0.5, size))
    masses = np.tile([1.5, 1.5, 1.5, 2e-3, 2e-3, 2e-3], len(places)) * np.exp(chance.normal(0.0, 0.3, size))
    matrices = []
    for diagonal, part in ((springs, 0.5), (masses, 0.2)):
        mixed = chance.normal(0.0, 1.0, (size, size))
        scale = np.sqrt(diagonal)
        matrices.append((np.eye(size) + part * mixed @ mixed.T / size) * np.outer(scale, scale))
    seats = [Interface(f"s{k}", (), np.array(place)) for k, place in enumerate(places)]
    reduction = Reduction(*matrices, None, np.zeros(0), np.zeros((0, size)))
    return mount(reduction, seats, [], [], (np.eye(3), np.zeros(3)), 0.02, float(masses[0]))


def with_bores(chance, shaft):
    """The shaft with some of its bores out of place across it."""
    supports = []
    for support in shaft.supports:
        aside = np.r_[chance.uniform(-2e-5, 2e-5, 2), np.zeros(3)] * (chance.random() < 0.5)
        supports.append(replace(support, offset=support.offset + aside))
    return replace(shaft, supports=tuple(supports))


def random_seated_machine(seed):
    """Three or four pinions, most of them on rolling bearings, on seats of a casing and on the ground."""
    chance = np.random.default_rng(1000 + seed)
    angles = np.cumsum(chance.uniform(70.0, 90.0, chance.integers(3, 5)))
    roles = [Role.INPUT, *(Role(chance.choice(["input", "idler", "tail"])) for _ in angles[1:])]
    layout = public_layout(pinions=tuple(zip(angles.tolist(), roles, strict=True)))
    by_role = {Role.INPUT: chance.uniform(200, 900), Role.IDLER: 0.0, Role.TAIL: -chance.uniform(50, 200)}
    turning = [i for i in range(angles.size) if i == 0 or chance.random() < 0.7]
    shafts = {i: with_bores(chance, random_shaft(chance)) for i in turning}
    inertias = {i: 1.5e-3 for i in shafts if chance.random() < 0.5}
    torques = [by_role[role] for role in roles]
    machine = machine_on(shafts, torques, layout, inertias, half_backlash=chance.uniform(0.0, 60e-6))
    along = {
        i: GEAR_RADIUS + np.array([s.position for s in each.supports]) - each.pinion
        for i, each in shafts.items()
    }
    places, names = [], {}
    for i, angle in enumerate(np.radians(angles)):
        outwards = np.array([np.cos(angle), np.sin(angle), 0.0])
        own = []
        for distance in along.get(i, [GEAR_RADIUS])[:2]:
            places.append(distance * outwards + chance.uniform(-0.02, 0.02, 3))
            own.append(f"s{len(places) - 1}")
        # The first bearing of all stands on the casing, so that every machine has both.
        count = len(along.get(i, [0]))
        names[i] = tuple(chance.choice([*own, ""]) if i or k else own[0] for k in range(count))
    for g, height in enumerate((-PINION_RADIUS, PINION_RADIUS)):
        places.append(1.5 * height * Z + chance.uniform(-0.02, 0.02, 3))
        names[angles.size + g] = (f"s{len(places) - 1}" if chance.random() < 0.8 else "",)
    names = {body: tuple(map(str, each)) for body, each in names.items()}
    return replace(machine, casing=Casing(layout, random_casing(chance, places), names, {}, along))


class WholeSeatedMachine(WholeMachine):
    """All coordinates of a machine on a casing; forces, balance and Newton's method are those of its base."""

    def __init__(self, machine):
        layout, line, casing = machine.layout, machine.drive_line, machine.casing
        self.machine, self.flank_stiffness = machine, MESH_STIFFNESS
        bodies, pinions = layout.bodies, len(layout.pinions)
        self.places, self.massive, blocks, rings = [], {}, [], []
        self.size = 4 * len(bodies)
        middle, tilts = {}, {}
        for pinion in line.rolling:
            shaft = line.seats[pinion].rolling
            nodes, elements = mesh_of(shaft)
            numbers = []
            for node in nodes:
                known = [4 * pinion + k for k in range(3)] if node == shaft.pinion else []
                numbers.append(known + list(range(self.size, self.size + 5 - len(known))))
                self.size += 5 - len(known)
            middle[pinion] = numbers[nodes.index(shaft.pinion)]
            if line.seats[pinion].tilt_inertia is not None:
                tilts[pinion] = line.seats[pinion].tilt_inertia
            for k, support in enumerate(shaft.supports):
                rings.append((pinion, k, support, numbers[nodes.index(support.position)]))
            blocks += [
                (np.array(numbers[i] + numbers[i + 1]), beam_stiffness(length, section, shaft.material))
                for i, (length, section) in enumerate(elements)
            ]
        self.first = self.size
        self.size += len(casing.mounted.stiffness)
        self.positions = casing.mounted.seat_positions
        self.stiffness, self.mass = np.zeros((2, self.size, self.size))
        self.stiffness[self.first :, self.first :] = casing.mounted.stiffness
        self.mass[self.first :, self.first :] = casing.mounted.mass
        for at, block in blocks:
            self.stiffness[np.ix_(at, at)] += block
        for number, body in enumerate(bodies):
            at = 4 * number + np.arange(4)
            self.mass[at, at] += [*3 * (body.mass,), body.inertia]
            if number not in middle:
                axes, point = self.axes_of(number)
                strain = (
                    self.picked(at[:3]) - axes @ self.seat_motion(casing.bearing_seats[number][0], point)[0]
                )
                self.stiffness += (strain.T * np.array(body.bearing)) @ strain
        for pinion, inertia in tilts.items():
            at = middle[pinion][3:]
            self.mass[at, at] += inertia
        for pinion, k, support, at in rings:
            axes = self.axes_of(pinion)[0]
            point = casing.bearing_places[pinion][k] * axes[2]
            shift, turn = self.seat_motion(casing.bearing_seats[pinion][k], point)
            self.places.append(
                (pinion, support, self.picked(at) - np.vstack([axes @ shift, (axes @ turn)[:2]]))
            )
        gears = [self.seat_motion(casing.bearing_seats[pinions + g][0], np.zeros(3))[1] for g in range(2)]
        for g, turn in enumerate(gears):
            self.mass += 0.5 * bodies[pinions + g].inertia * turn[:2].T @ turn[:2]
        self.rows = np.array(
            [self.flank(i, g, side, gears[g]) for side in (1.0, -1.0) for i, g in layout.meshes]
        )
        self.loads = np.zeros(self.size)
        self.loads[3 : 4 * len(bodies) : 4] = machine.torques
        self.arms = np.ones(self.size)
        self.arms[3 : 4 * len(bodies) : 4] = GEAR_RADIUS

    def picked(self, at):
        """Rows (r, n) of single coordinates."""
        return np.eye(self.size)[at]

    def axes_of(self, number):
        """Axes of a body in rows, and the point to which its motions belong."""
        layout = self.machine.layout
        if number < len(layout.pinions):
            angle = layout.angles[number]
            outwards = np.array([np.cos(angle), np.sin(angle), 0.0])
            return np.array([np.cross(Z, outwards), Z, outwards]), GEAR_RADIUS * outwards
        height = (-PINION_RADIUS, PINION_RADIUS)[number - len(layout.pinions)]
        return np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]), height * Z

    def seat_motion(self, name, point):
        """Motion and rotation (3, n) each, in space, that a seat gives a point; zero for the ground."""
        shift, turn = np.zeros((2, 3, self.size))
        if name:
            number = int(name[1:])
            at = self.first + 6 * number
            turn[:, at + 3 : at + 6] = np.eye(3)
            shift[:, at : at + 3] = np.eye(3)
            arm = point - self.positions[number]
            shift[:, at + 3 : at + 6] = np.cross(np.eye(3), arm).T
        return shift, turn

    def flank(self, pinion, gear, side, turn):
        """Row (n,) of a flank, 1 drive and -1 back: minus the force on the pinion at the pitch point, by the
        motion of the pinion's point less that of the gear's.
        """
        (across, up, out), middle = self.axes_of(pinion)
        above = (-1.0, 1.0)[gear]
        force = -above * side * np.cos(ANGLE) * across - above * np.sin(ANGLE) * up
        pitch_point = middle + above * PINION_RADIUS * up
        own, of_gear = 4 * pinion, 4 * (len(self.machine.layout.pinions) + gear)
        motion = np.zeros((3, self.size))
        motion[:, own : own + 3] = np.array([across, up, out]).T
        # Positive torques turn pinions about their axes inwards, and gears as pinions drive them.
        motion[:, own + 3] = -np.cross(out, pitch_point - middle)
        axes, point = self.axes_of(len(self.machine.layout.pinions) + gear)
        motion[:, of_gear : of_gear + 3] -= axes.T
        motion[:, of_gear + 3] -= above * np.cross(Z, pitch_point - point)
        tilt = turn.copy()
        tilt[2] = 0.0
        motion -= np.cross(tilt.T, pitch_point - point).T
        return -force @ motion
