"""Contact of two whole bodies that are moved rigidly in the frame of a machine.

Nothing here knows assembly errors, poses or lines of contact: flanks are points and normals of their bodies,
and classical tooth contact analysis solves for one contact (Litvin and Fuentes 2004, chapter 9).
"""

import numpy as np
from scipy.optimize import root
from scipy.spatial.transform import Rotation

from facegear.teeth.design import PairDesign
from facegear.teeth.generated_flank import gear_flank
from facegear.teeth.helicoid import PinionFlank
from facegear.teeth.placement import pair_at


class MovedBodies:
    """A pinion at an azimuth p of the gears' frame (x, y, up), and one of its two gears.

    The pinion lies towards (sin p, -cos p), its x points along (cos p, sin p), its z outwards along its axis.
    """

    def __init__(self, design: PairDesign, gear: str, azimuth: float, tilt_height: float) -> None:
        self.design, self.sign = pair_at(design, gear, "drive"), 1.0 if gear == "upper" else -1.0
        self.tangent = np.array([np.cos(azimuth), np.sin(azimuth), 0.0])
        self.away = np.array([np.sin(azimuth), -np.cos(azimuth), 0.0])
        self.up = np.array([0.0, 0.0, 1.0])
        self.axis = np.sin(design.shaft_angle) * self.away + np.cos(design.shaft_angle) * self.up
        self.across = np.cross(self.axis, self.tangent)
        self.origin = design.offset * self.tangent
        self.middle = self.origin + design.middle * self.axis
        self.centre = self.sign * tilt_height * self.up

    def contact(self, side: int, pinion, gear, phi1: float = 0.02) -> tuple[float, float]:
        """Return the turn of the gear to its contact, times the arm, and the place of the path (m).

        pinion, gear: shift (m) and turn (rad) as `Displacement`; side: 1 drive, -1 coast flank.
        """
        flank, helicoid = (
            gear_flank(self.design.family, side),
            self.design.family.pinion_flanks[(1 - side) // 2],
        )
        driving, teeth = PinionFlank(helicoid), self.design.pinion.teeth
        frame = np.stack([self.tangent, self.across, self.axis], axis=1)
        shift, turn = frame @ pinion[0], frame @ (np.array(pinion[1]) * [1.0, 1.0, -1.0])
        moved = Rotation.from_rotvec(turn)
        gear_shift, gear_turn = np.array(gear[0]), np.array(gear[1]) * [1.0, 1.0, self.sign]
        gear_moved = Rotation.from_rotvec(gear_turn)
        # a pinion's body has x, its axis, and from the gear to the pinion; so has the mesh frame
        body = np.stack([self.sign * self.tangent, self.axis, -self.sign * self.across], axis=1)
        to_global = np.stack([self.sign * self.tangent, self.away, -self.sign * self.up], axis=1)
        tooth = Rotation.from_rotvec([0.0, -(phi1 - np.pi / teeth), 0.0])

        def on_pinion(vectors, point):
            whole = body @ tooth.apply(vectors)
            if not point:
                return moved.apply(whole)
            return self.middle + shift + moved.apply(self.origin + whole - self.middle)

        def on_gear(vectors, phi2, point):
            whole = to_global @ Rotation.from_rotvec([0.0, 0.0, -phi2]).apply(vectors)
            if not point:
                return gear_moved.apply(whole)
            return self.centre + gear_shift + gear_moved.apply(whole - self.centre)

        def residual(x):
            psi, s, roll, y, phi2 = x * scale
            first = on_pinion(driving.point(roll, y), True) - on_gear(flank.point(psi, s), phi2, True)
            normal, other = (
                on_pinion(driving.normal(roll, y), False),
                on_gear(flank.normal(psi, s), phi2, False),
            )
            apart = np.cross(normal, other)
            return np.array([*(first / self.design.module), *apart[np.argsort(np.abs(normal))[:2]]])

        scale = np.array([1.0, 0.01, 0.01, 0.1, 0.1])
        pitch_roll = helicoid.pitch_radius * np.sin(helicoid.pressure_angle)
        start = [
            helicoid.pressure_angle,
            (pitch_roll + self.design.shaper_lift * np.sin(helicoid.pressure_angle)) / helicoid.cosine,
        ]
        start += [pitch_roll, self.design.middle, phi1 * teeth / self.design.face_gear.teeth]
        found = root(residual, np.array(start) / scale, tol=1e-14)
        x = found.x
        for _ in range(4):
            steps = 1e-6 * np.eye(5)
            slopes = np.stack([(residual(x + h) - residual(x - h)) / 2e-6 for h in steps], axis=1)
            x = x - np.linalg.solve(slopes, residual(x))
        assert np.abs(residual(x)).max() < 1e-12, found.message
        _, _, roll, y, phi2 = x * scale
        angle = phi2 - phi1 * teeth / self.design.face_gear.teeth
        arm = helicoid.base_radius * helicoid.cosine * self.design.face_gear.teeth / teeth
        return side * angle * arm, y + helicoid.lead * (pitch_roll - roll)
