"""Machines with any teeth as rigid bodies in one global frame: normals, points, springs, least energy.

Nothing of the package's frames and rows is used. The gears' axis is z, up from the lower to the upper gear,
and both gears and all pinions' axes refer to one origin. Normals come from the rack's planes, points from the
place at which the line of contact passes the pinion's pitch line.
"""

from dataclasses import dataclass, replace
from math import cos, pi, radians, sin

import numpy as np

from facegear.harmonics import Harmonics
from facegear.machine.drive_line import DriveLine, Seat
from facegear.machine.imperfections import perfect
from facegear.machine.kinematics import GEOMETRIC
from facegear.machine.layout import Body, FaceGear, Layout, Pinion, Role, Side, Tilt
from facegear.machine.machine import Damping, Machine
from facegear.machine.mesh_frames import ToothKind
from facegear.machine.torques import balanced_torques
from facegear.parts.shafts import Bearing, Elasticity, Segment, Shaft, condense_shaft
from facegear.teeth.tooth_family import Rack

UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True)
class Teeth:
    """Module, normal pressure angles of drive and coast flank, helix, taper, shaft angle, offset, middle."""

    pinion: int
    gear: int
    module: float
    angles: tuple[float, float]
    helix: float = 0.0
    taper: float = 0.0
    shaft: float = pi / 2
    offset: float = 0.0
    middle: float | None = None

    @property
    def pitch_radius(self) -> float:
        return self.pinion * self.module / cos(self.helix) / 2

    @property
    def gear_radius(self) -> float:
        return self.gear * self.module / cos(self.helix) / 2

    @property
    def face(self) -> float:
        """Middle of the face; without one, where the pitch radii of the upper mesh roll on each other."""
        if self.middle is not None:
            return self.middle
        return (self.gear_radius + self.pitch_radius * cos(self.shaft)) / sin(self.shaft)

    @property
    def kind(self) -> ToothKind:
        rack = Rack(self.module, self.angles, self.helix, self.taper)
        return ToothKind(self.pinion, self.gear, rack, self.shaft, self.offset, self.middle)


def mirrored(teeth: Teeth) -> Teeth:
    """The teeth in a mirror across the tangent."""
    return replace(teeth, helix=-teeth.helix, offset=-teeth.offset, angles=teeth.angles[::-1])


@dataclass(frozen=True)
class Place:
    """Axes of a mesh in space: tangent x, pinion's axis a, u = x cross a, gear's own axis g to its teeth."""

    x: np.ndarray
    a: np.ndarray
    u: np.ndarray
    shaft: float
    offset: float


def place(teeth: Teeth, angle: float, upper: bool) -> Place:
    """Mesh of a pinion at an angle with one of the gears: the lower one from half round the pinion's axis."""
    tangent = np.array([cos(angle), sin(angle), 0.0])
    away = np.array([sin(angle), -cos(angle), 0.0])
    axis = sin(teeth.shaft) * away + cos(teeth.shaft) * UP
    x = tangent if upper else -tangent
    shaft = teeth.shaft if upper else pi - teeth.shaft
    return Place(x, axis, np.cross(x, axis), shaft, teeth.offset if upper else -teeth.offset)


def flank(teeth: Teeth, at: Place, sigma: int) -> tuple[np.ndarray, np.ndarray]:
    """Normal from pinion to gear and a point of the line of contact of a flank, in space."""
    alpha, beta, delta = teeth.angles[0 if sigma > 0 else 1], teeth.helix, teeth.taper
    n_x = sigma * cos(alpha) * cos(beta)
    n_a = sigma * cos(alpha) * sin(beta) * cos(delta) - sin(alpha) * sin(delta)
    n_u = -(sigma * cos(alpha) * sin(beta) * sin(delta) + sin(alpha) * cos(delta))
    n_y = n_a * sin(at.shaft) + n_u * cos(at.shaft)
    rolled = teeth.gear_radius + at.offset * n_y / n_x + teeth.pitch_radius * cos(at.shaft)
    point = at.offset * at.x + rolled / sin(at.shaft) * at.a - teeth.pitch_radius * at.u
    return n_x * at.x + n_a * at.a + n_u * at.u, point


def pinion_centre(teeth: Teeth, angle: float) -> np.ndarray:
    at = place(teeth, angle, upper=True)
    return at.offset * at.x + teeth.face * at.a


def gear_centre(teeth: Teeth, upper: bool, below: float) -> np.ndarray:
    """Point about which a gear tilts: below the circle that rolls on the pinion's without offset."""
    shaft = teeth.shaft if upper else pi - teeth.shaft
    rolling = (teeth.gear_radius + teeth.pitch_radius * cos(shaft)) / sin(shaft)
    height = teeth.pitch_radius * sin(shaft) + rolling * cos(shaft) + below
    return (height if upper else -height) * UP


@dataclass(frozen=True)
class Coordinate:
    """One coordinate: its body, and the screw of a unit of it about the body's centre."""

    body: int
    motion: np.ndarray
    turn: np.ndarray
    centre: np.ndarray


def coordinates(machine: Machine, teeth: Teeth) -> list[Coordinate]:
    """All coordinates of a machine in its own order, as motions in space."""
    layout, zero = machine.layout, np.zeros(3)
    pinions, found = len(layout.pinions), []
    angles = [2 * pi * pinion.pitches / layout.gear_teeth for pinion in layout.pinions]
    frames, centres = [], []
    for angle in angles:
        at = place(teeth, angle, upper=True)
        frames.append((at.x, -at.u, at.a))
        centres.append(pinion_centre(teeth, angle))
    for gear in layout.gears:
        frames.append((np.array([1.0, 0, 0]), np.array([0, 1.0, 0]), UP))
        below = gear.body.tilt.below if gear.body.tilt else 0.0
        centres.append(gear_centre(teeth, gear.side is Side.UPPER, below))
    for body, (frame, centre) in enumerate(zip(frames, centres, strict=True)):
        found += [Coordinate(body, axis, zero, centre) for axis in frame]
        # a pinion turns against its axis as it drives, the upper gear about +z, the lower one about -z
        ahead = -1.0 if body < pinions else (1.0 if layout.gears[body - pinions].side is Side.UPPER else -1.0)
        found.append(Coordinate(body, zero, ahead * frame[2], centre))
    tilting = [pinions + g for g, gear in enumerate(layout.gears) if gear.body.tilt]
    if machine.drive_line is not None:
        tilting += machine.drive_line.tilting
    for body in tilting:
        found += [Coordinate(body, zero, axis, centres[body]) for axis in frames[body][:2]]
    return found


def flank_rows(machine: Machine, teeth: Teeth) -> np.ndarray:
    """Closing motion of all flanks by all coordinates, (2 meshes, n), drive flanks first."""
    layout, bodies = machine.layout, coordinates(machine, teeth)
    rows = np.zeros((2 * len(layout.meshes), len(bodies)))
    for mesh, (i, g) in enumerate(layout.meshes):
        angle = 2 * pi * layout.pinions[i].pitches / layout.gear_teeth
        at = place(teeth, angle, layout.gears[g].side is Side.UPPER)
        for number, sigma in enumerate((1, -1)):
            normal, point = flank(teeth, at, sigma)
            row = rows[mesh + number * len(layout.meshes)]
            for column, part in enumerate(bodies):
                closing = normal @ (part.motion + np.cross(part.turn, point - part.centre))
                if part.body == i:
                    row[column] = closing
                elif part.body == len(layout.pinions) + g:
                    row[column] = -closing
    return rows


def gaps(machine: Machine, teeth: Teeth) -> np.ndarray:
    """Half the backlash and constant errors of all flanks, as displacements in space close them."""
    layout, errors = machine.layout, machine.imperfections
    open_by = np.tile(machine.half_backlash, 2)
    for mesh, (i, g) in enumerate(layout.meshes):
        angle = 2 * pi * layout.pinions[i].pitches / layout.gear_teeth
        frame = place(teeth, angle, upper=True)
        moved = errors.position[i] @ np.array([frame.x, -frame.u]) + errors.outwards[i] * frame.a
        at = place(teeth, angle, layout.gears[g].side is Side.UPPER)
        arms = [cos(alpha) for alpha in teeth.angles]
        for number, sigma in enumerate((1, -1)):
            normal, _ = flank(teeth, at, sigma)
            late = sigma * errors.error[mesh] * arms[number] / arms[0]
            open_by[mesh + number * len(layout.meshes)] += late - normal @ moved
    return open_by


def springs(machine: Machine) -> np.ndarray:
    """Bearing stiffness over all coordinates."""
    layout = machine.layout
    count = len(coordinates_count(machine))
    matrix = np.zeros((count, count))
    for body, part in enumerate(layout.bodies):
        at = 4 * body + np.arange(3)
        matrix[at, at] = part.bearing
        matrix[at[0], at[1]] = matrix[at[1], at[0]] = part.bearing_xy
    after = 4 * len(layout.bodies)
    for gear in layout.gears:
        if gear.body.tilt:
            matrix[[after, after + 1], [after, after + 1]] = gear.body.tilt.stiffness
            after += 2
    for pinion, seat in sorted(machine.drive_line.seats.items()) if machine.drive_line else ():
        at = np.array([4 * pinion, 4 * pinion + 1, 4 * pinion + 2, after, after + 1])
        matrix[np.ix_(at, at)] = np.linalg.inv(seat.shaft.compliance)
        after += 2
    return matrix


def coordinates_count(machine: Machine) -> range:
    tilts = sum(gear.body.tilt is not None for gear in machine.layout.gears)
    tilts += len(machine.drive_line.tilting) if machine.drive_line else 0
    return range(4 * len(machine.layout.bodies) + 2 * tilts)


def least_energy(stiffness, rows, mesh_stiffness, gap, loads, lengths):
    """Newton's method with an exact search along each step; returns displacements and flank forces."""
    scale = 1.0 / lengths
    stiffness, rows, loads = stiffness * np.outer(scale, scale), rows * scale, loads * scale
    moved, weight = np.zeros(loads.size), 1e-7 * mesh_stiffness.max() * np.eye(loads.size)
    size = np.abs(loads).max()

    def slope(at):
        return stiffness @ at + rows.T @ (mesh_stiffness * np.maximum(rows @ at - gap, 0.0)) - loads

    for _ in range(400):
        gradient = slope(moved)
        if np.abs(gradient).max() < 3e-13 * size:
            break
        on = rows @ moved > gap
        tangent = stiffness + weight + (rows[on].T * mesh_stiffness[on]) @ rows[on]
        step = -np.linalg.solve(tangent, gradient)
        low, high = 0.0, 1.0
        while slope(moved + high * step) @ step < 0.0 and high < 2.0**40:
            low, high = high, 2.0 * high
        for _ in range(80):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if slope(moved + middle * step) @ step < 0.0 else (low, middle)
        moved = moved + (1.0 if abs(high - 1.0) < 1e-9 else high) * step
    return moved * scale, mesh_stiffness * np.maximum(rows @ moved - gap, 0.0)


MESH = 4e8


def random_teeth(rng: np.random.Generator) -> Teeth:
    """Teeth with any helix, taper, offset, angles and place of the face."""
    pinion = int(rng.integers(17, 40))
    gear = int(pinion * rng.uniform(3.0, 6.0))
    module = rng.uniform(2e-3, 6e-3)
    helix = radians(rng.uniform(-20, 20)) * rng.choice([0, 1])
    taper = radians(rng.uniform(-5, 5)) * rng.choice([0, 1])
    first = radians(rng.uniform(18, 28))
    angles = (first, radians(rng.uniform(18, 28)) if rng.random() < 0.4 else first)
    shaft = pi / 2 + radians(rng.uniform(-15, 15)) * rng.choice([0, 1])
    teeth = Teeth(pinion, gear, module, angles, helix, taper, shaft)
    offset = rng.uniform(-0.1, 0.1) * teeth.gear_radius * rng.choice([0, 1])
    middle = teeth.face * (1.0 + rng.uniform(-0.03, 0.03)) if rng.random() < 0.7 else None
    return replace(teeth, offset=offset, middle=middle)


def make_layout(teeth: Teeth, pinions, gears) -> Layout:
    kind = teeth.kind
    arm = kind.normal_arms[0]
    return Layout(
        pinions=tuple(pinions),
        gears=tuple(gears),
        pinion_teeth=teeth.pinion,
        gear_teeth=teeth.gear,
        pressure_angle=teeth.angles[0],
        pinion_radius=arm,
        gear_radius=arm * teeth.gear / teeth.pinion,
        kinematics=GEOMETRIC,
        kind=kind,
    )


def random_shaft(rng: np.random.Generator):
    """A shaft on two bearings, the first of which holds it along its axis and couples that with a tilt."""
    stiff = 10.0 ** rng.uniform(7.5, 9.0, 3)
    matrix = np.diag([stiff[0], 1.3 * stiff[0], 10.0 ** rng.uniform(7.0, 8.5), 2e5, 3e5])
    matrix[2, 4] = matrix[4, 2] = rng.uniform(-1, 1) * 1e6
    bearings = Bearing(0.0, matrix), Bearing(0.12, np.diag([stiff[1], stiff[2], 0.0, 0.0, 0.0]))
    return condense_shaft(Shaft((Segment(0.12, 0.04),), Elasticity(206e9, 0.3), bearings, 0.05))


def random_machine(rng: np.random.Generator, everything_tilts: bool = False) -> tuple[Machine, Teeth]:
    """One to four pinions between one or two gears, inputs, idlers and a tail, errors in every mesh."""
    teeth = random_teeth(rng)
    sides = [(Side.LOWER, Side.UPPER), (Side.UPPER,), (Side.LOWER,)][rng.integers(0, 3)]
    count = int(rng.integers(1, 5))
    shafts = {i: random_shaft(rng) for i in range(count) if everything_tilts or rng.random() < 0.4}
    pinions, torques = [], []
    for i in range(count):
        k = 10.0 ** rng.uniform(7.0, 9.5, 3)
        bearing, cross = tuple(k), 0.3 * float(rng.uniform(-1, 1)) * float(min(k[:2]))
        if i in shafts:
            across = np.linalg.inv(shafts[i].compliance[:2, :2])
            bearing = (across[0, 0], across[1, 1], 1.0 / shafts[i].compliance[2, 2])
            cross = across[0, 1]
        idler = len(sides) > 1 and i > 0 and rng.random() < 0.5
        torques.append(
            0.0 if idler else rng.uniform(200.0, 900.0) * (1.0 if i == 0 else rng.choice([1, -0.3]))
        )
        pitches = float(rng.integers(0, 2 * teeth.gear)) / 2.0
        role = Role.IDLER if idler else (Role.INPUT if torques[-1] > 0.0 else Role.TAIL)
        pinions.append(Pinion(f"p{i}", role, pitches, Body(1.2, 0.002, bearing, cross)))
    gears = []
    for side in sides:
        tilts = everything_tilts or rng.random() < 0.5
        tilt = Tilt(0.3, 10.0 ** rng.uniform(6, 8), rng.uniform(-0.02, 0.05)) if tilts else None
        gears.append(FaceGear(side, Body(8.0, 0.5, tuple(10.0 ** rng.uniform(8, 10, 3)), 0.0, tilt)))
    layout = make_layout(teeth, pinions, gears)
    meshes = len(layout.meshes)
    flaws = replace(
        perfect(layout),
        error=8e-6 * rng.normal(size=meshes),
        position=8e-6 * rng.normal(size=(count, 2)),
        outwards=20e-6 * rng.normal(size=count),
        stiffness=rng.uniform(0.7, 1.4, meshes),
    )
    seats = {i: Seat(shaft, 1.5e-3) for i, shaft in shafts.items()}
    machine = Machine(
        layout=layout,
        torques=balanced_torques(layout, np.array(torques)),
        stiffness=Harmonics(np.zeros(1), np.array([MESH])),
        error=Harmonics(np.zeros(1), np.zeros(1)),
        half_backlash=rng.uniform(10e-6, 60e-6, meshes),
        damping=Damping(1000.0, 500.0, 1e-6),
        imperfections=flaws,
        drive_line=DriveLine(layout, seats, {}) if seats else None,
    )
    return machine, teeth


def solved(machine: Machine, teeth: Teeth) -> tuple[np.ndarray, np.ndarray]:
    """Displacements and flank forces of the independent model at rest."""
    parts = coordinates(machine, teeth)
    loads = np.zeros(len(parts))
    loads[3 : 4 * len(machine.layout.bodies) : 4] = machine.torques
    mesh_stiffness = MESH * np.tile(machine.imperfections.stiffness, 2)
    radius = teeth.pitch_radius, teeth.gear_radius
    lengths = np.array(
        [radius[part.body >= len(machine.layout.pinions)] if part.turn.any() else 1.0 for part in parts]
    )
    rows = flank_rows(machine, teeth)
    return least_energy(springs(machine), rows, mesh_stiffness, gaps(machine, teeth), loads, lengths)


def common_rotation(machine: Machine) -> np.ndarray:
    """All bodies turning together, which nothing resists."""
    motion = np.zeros(len(coordinates_count(machine)))
    pinions, bodies = len(machine.layout.pinions), len(machine.layout.bodies)
    motion[3 : 4 * pinions : 4] = 1.0
    motion[4 * pinions + 3 : 4 * bodies : 4] = machine.layout.pinion_teeth / machine.layout.gear_teeth
    return motion
