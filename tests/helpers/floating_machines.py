"""Two pinions that float and tilt between tilting gears, and their equations of motion by hand."""

from dataclasses import replace
from math import cos, pi, radians

import numpy as np
from wrench_machines import Teeth, flank_rows, gaps, make_layout, random_shaft, springs

from facegear.harmonics import Harmonics
from facegear.machine.drive_line import DriveLine, Seat
from facegear.machine.imperfections import perfect
from facegear.machine.layout import Body, FaceGear, Pinion, Role, Side, Tilt
from facegear.machine.machine import Damping, Machine, OpenFlanks
from facegear.machine.torques import balanced_torques
from facegear.motion.integrator.kernel_system import TAU

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


class ByHand:
    """The equations of all coordinates, from the independent model of bodies in space."""

    def __init__(self, machine: Machine, teeth: Teeth, omega: float) -> None:
        self.rows, self.gap = flank_rows(machine, teeth), gaps(machine, teeth)
        self.spring, self.omega, self.phases = springs(machine), omega, machine.phases
        self.mass = np.array([*(PINION[:1] * 3 + PINION[1:]) * 2, *(GEAR[:1] * 3 + GEAR[1:]) * 2])
        self.mass = np.append(self.mass, [TILT] * 4 + [SEAT] * 2)
        self.damping = MASS_DAMPING * np.diag(self.mass) + BEARING_DAMPING * self.spring
        # The pinion turns against its z at omega / N1: its angular momentum turns with the tilts.
        turning = PINION[1] * omega / teeth.pinion
        self.gyroscopic = np.zeros_like(self.spring)
        self.gyroscopic[-2, -1], self.gyroscopic[-1, -2] = -turning, turning
        self.load = np.zeros(len(self.mass))
        self.load[3:16:4] = machine.torques
        # A pinion outwards by w is one that has turned: its place in the mesh cycle is ahead by eta w / p_bn.
        self.ahead = np.zeros(8)
        pitch = 2 * pi * teeth.pitch_radius * cos(teeth.helix) / teeth.pinion
        for flank, (angle, sign) in enumerate(zip(teeth.angles, (1, -1), strict=True)):
            for mesh, pinion in enumerate((0, 1, 0, 1)):
                axial = self.rows[4 * flank + mesh, 4 * pinion + 2]
                place = axial * machine.imperfections.outwards[pinion] / (pitch * cos(angle))
                self.ahead[4 * flank + mesh] = sign * place
        self.rotation = np.zeros(len(self.mass))
        self.rotation[[3, 7]], self.rotation[[11, 15]] = 1.0, teeth.pinion / teeth.gear
        self.phase_shifts = np.zeros((8, len(self.mass)))
        if machine.has_phase_shifts:
            self.phase_shifts = self.phase_rows(teeth, pitch)

    def phase_rows(self, teeth: Teeth, pitch: float) -> np.ndarray:
        """Places in the mesh cycle by turn and float of each pinion, without the rotation of all bodies."""
        rows = np.zeros((8, len(self.mass)))
        for flank, (angle, sign) in enumerate(zip(teeth.angles, (1, -1), strict=True)):
            for mesh, pinion in enumerate((0, 1, 0, 1)):
                number = 4 * flank + mesh
                rows[number, 4 * pinion + 2] = (
                    sign * TAU * self.rows[number, 4 * pinion + 2] / (pitch * cos(angle))
                )
                rows[number, 4 * pinion + 3] = teeth.pinion
        carried = self.mass * self.rotation
        return rows - np.outer(rows @ self.rotation, carried) / (self.rotation @ carried)

    def law(self, t: float, moved=None) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Stiffness, error and their rates of all flanks: back flanks go through the cycle backwards."""
        place = TAU * (self.omega * t / TAU - np.tile(self.phases, 2) + self.ahead)
        at = place if moved is None else place + self.phase_shifts @ moved
        back = np.repeat([1.0, -1.0], 4)
        stiffness, by_place = K + SWING * back * np.sin(at), SWING * back * np.cos(at)
        return stiffness, ERROR * np.cos(place), -ERROR * self.omega * np.sin(place), by_place

    def flanks(self, t, moved, speed):
        stiffness, error, rate, by_place = self.law(t, moved)
        over, closing = self.rows @ moved - error - self.gap, self.rows @ speed - rate
        touching = over > 0.0
        return stiffness, np.where(touching, over, 0.0), np.where(touching, closing, 0.0), by_place

    def slope(self, t, state):
        moved, speed = np.split(state, 2)
        stiffness, over, closing, by_place = self.flanks(t, moved, speed)
        force = stiffness * over + MESH_DAMPING * closing
        pull = (
            self.load
            - self.rows.T @ force
            - self.spring @ moved
            - self.phase_shifts.T @ (0.5 * by_place * over**2)
        )
        pull -= (self.damping + self.gyroscopic) @ speed
        return np.concatenate([speed, pull / self.mass])

    def energy(self, t, moved, speed):
        """Kinetic and elastic energy of a machine whose law is linear."""
        stiffness, over, *_ = self.flanks(t, moved, speed)
        elastic = 0.5 * (moved @ self.spring @ moved + stiffness @ over**2)
        return 0.5 * self.mass @ speed**2 + elastic


def motion_at(run, basis, omega, phases, step):
    """Return motions and speeds of all coordinates at phases of a recorded run, in its steps."""
    powers = np.arange(run.coordinates.shape[1])
    ahead = (phases - run.starts[step])[:, None]
    at = np.einsum("kp,kpn->kn", ahead**powers, run.coordinates[step])
    rate = np.einsum("kp,kpn->kn", powers[1:] * ahead ** (powers[1:] - 1), run.coordinates[step][:, 1:])
    return at @ basis.T, omega * rate @ basis.T
