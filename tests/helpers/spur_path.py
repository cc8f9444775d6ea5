"""Spur gears along their line of action: kinematics by the vectors of two parallel axes."""

from dataclasses import dataclass
from math import cos, pi, radians, sin, sqrt, tan

import numpy as np
from scipy.optimize import brentq

from facegear.lubrication.kinematics import Spin, slip
from facegear.lubrication.loss import HatSlip


@dataclass(frozen=True)
class SpurPath:
    """Base radii (m), working pressure angle (rad), parts of the path before and after the pitch point in
    base pitches, tooth number of the pinion.
    """

    base: tuple[float, float]
    angle: float
    approach: float
    recess: float
    teeth: int

    @property
    def pitch(self) -> float:
        return 2 * pi * self.base[0] / self.teeth

    @property
    def curvature_radii(self) -> np.ndarray:
        return np.array(self.base) * tan(self.angle)

    def spins(self, speed: float) -> tuple[Spin, Spin]:
        distance = sum(self.base) / cos(self.angle)
        axis = np.array([0.0, -1.0, 0.0])
        ratio = self.base[0] / self.base[1]
        return (
            Spin(axis, np.zeros(3), speed),
            Spin(-axis, np.array([0.0, 0.0, -distance]), speed * ratio),
        )

    def points(self, g):
        """Points and pinion's outward normals at distances g (m) from the pitch point, recess positive."""
        g = np.asarray(g, float)
        normal = np.array([cos(self.angle), 0.0, -sin(self.angle)])
        pitch_point = np.array([0.0, 0.0, -self.base[0] / cos(self.angle)])
        along = g[..., None] * np.array([cos(self.angle), 0.0, -sin(self.angle)])
        return pitch_point + along, np.broadcast_to(normal, along.shape)

    def hats(self, positions: int) -> HatSlip:
        """Loads of an even division where two pairs touch, in the middle of `positions` parts of a pitch."""
        at = (np.arange(positions) + 0.5) / positions
        place = np.floor(-self.approach) + at[:, None] + np.arange(4)
        on = (place > -self.approach) & (place < self.recess)
        force = on / on.sum(axis=1)[:, None]
        row, column = np.nonzero(on)
        point, normal = self.points(place[on] * self.pitch)
        velocity, closing = slip(*self.spins(1.0), point, normal)
        return HatSlip(
            torque=np.full(row.size, self.base[0]),
            position=at[row],
            tooth=column,
            plane=np.zeros(row.size, dtype=int),
            force=force[on],
            point=point,
            normal=normal,
            velocity=velocity,
            normal_velocity=closing,
        )


def c40() -> SpurPath:
    """FZG type C gears, 40 mm wide, at the centre distance of their profile shifts."""
    teeth, shifts = (16, 24), (0.1817, 0.1715)
    tips = [4.5e-3 * (0.5 * z + 1 + shift) for z, shift in zip(teeth, shifts, strict=True)]
    cut = radians(20.0)
    base = tuple(0.5 * 4.5e-3 * z * cos(cut) for z in teeth)
    wanted = tan(cut) - cut + 2 * tan(cut) * sum(shifts) / sum(teeth)
    angle = brentq(lambda at: tan(at) - at - wanted, cut, 1.0, xtol=1e-15)
    pitch = 2 * pi * base[0] / teeth[0]
    recess, approach = (
        (sqrt(tip**2 - r**2) - r * tan(angle)) / pitch for tip, r in zip(tips, base, strict=True)
    )
    return SpurPath(base, angle, approach, recess, teeth[0])
