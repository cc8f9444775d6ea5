"""Sliding and rolling velocities of teeth of the whole family: against the path of contact on both gears."""

import numpy as np
import pytest
from family_pairs import public_pair

from facegear.contact.lines import ContactLines
from facegear.lubrication.kinematics import line_kinematics, surface_normals
from facegear.teeth.bounded_contact import contact_path
from facegear.teeth.family_contact import contact_line
from facegear.teeth.helicoid import PinionFlank, pinion_fillet, pinion_start
from facegear.teeth.placement import pinion_to_gear

NAMES = ("P1", "P2", "P3", "P4")
TURN = 1e-5
"""Turn of the pinion (rad) over which the paths are differenced."""


def contact_at(design, line, s):
    """Return normal in the mesh frame, length of roll, y and angle of the pinion at s (m) of a line."""
    flank = design.family.pinion_flanks[0]
    y, roll = line.pinion_y(s), (s + line.pinion_lead) * flank.cosine
    angle = (roll + flank.lead * (y - design.middle)) / flank.base_radius - line.pinion_slope - flank.phase
    return line.normal, roll, y, float(angle)


@pytest.mark.parametrize("name", NAMES)
def test_normals_of_flank_and_root_are_those_of_the_surfaces(name):
    design = public_pair(name)
    flank, root = design.family.pinion_flanks[0], pinion_fillet(design.family, 1)
    y = design.middle + design.pinion.width * np.linspace(-0.5, 0.5, 5)
    roll = np.linspace(1.01 * pinion_start(design.family, 1, y), 0.02, 4)
    surface = PinionFlank(flank)
    points, normals = surface.point(roll, y).reshape(-1, 3), surface.normal(roll, y).reshape(-1, 3)
    assert surface_normals(design, points) == pytest.approx(normals, abs=1e-12)
    slopes = np.linspace(flank.pressure_angle + 0.01, np.pi / 2 - 0.01, 4)[:, None]
    points, normals = root.point(slopes, y).reshape(-1, 3), root.normal(slopes, y).reshape(-1, 3)
    assert surface_normals(design, points) == pytest.approx(normals, abs=1e-9)


@pytest.mark.parametrize("name", NAMES)
def test_velocities_are_those_of_the_contact_s_paths_on_both_gears(name):
    design = public_pair(name)
    line = contact_line(design.family, 1)
    path = contact_path(design.family, line)
    axis = design.family.motion.basis[1]
    for s in np.linspace(path.first, path.last, 5):
        normal, roll, y, angle = contact_at(design, line, s)
        lean = float(line.curvatures(s)[2])
        shape = np.full((1, 1), np.nan)
        lines = ContactLines(
            np.array([y]),
            np.array([[roll / design.pinion_base_radius]]),
            shape,
            np.array([[-lean]]),
            *4 * [shape],
        )
        position = np.array([angle * design.pinion.teeth / (2 * np.pi) + 0.5])
        found = line_kinematics(design, lines, position, np.zeros(1))
        radial = line._radial
        generator = np.cross(normal, radial)
        way = np.cos(lean) * generator + np.sin(lean) * radial
        # the common tangent across the line, towards the pinion's axis
        across = np.cross(way, normal)
        across *= -np.sign(across @ radial)
        steps = TURN * np.array([-0.5, 0.5])
        places = line.point(s + line.base_pitch * steps)
        moves = {}
        for body in ("pinion", "gear"):
            turned = angle + steps, (angle + steps) * design.pinion.teeth / design.face_gear.teeth
            if body == "pinion":
                motions = [pinion_to_gear(design, turn, 0.0, 0.0) for turn in turned[0]]
                seen = [m.inverse().points(at[None])[0] for m, at in zip(motions, places, strict=True)]
                back = pinion_to_gear(design, angle, 0.0, 0.0).directions
            else:
                motions = [pinion_to_gear(design, 0.0, turn, 0.0).matrix for turn in turned[1]]
                still = pinion_to_gear(design, 0.0, 0.0, 0.0).matrix
                seen = [m @ still.T @ at for m, at in zip(motions, places, strict=True)]
                here = pinion_to_gear(design, 0.0, angle * design.pinion.teeth / design.face_gear.teeth, 0.0)

                def back(vectors, matrix=still @ here.matrix.T):
                    return vectors @ matrix.T

            moves[body] = -back(((seen[1] - seen[0]) / TURN)[None])[0]
        size = np.linalg.norm(moves["pinion"])
        assert found.sliding[0, 0] == pytest.approx(float(line.sliding(s)), rel=1e-9)
        sliding = moves["pinion"] - moves["gear"]
        assert found.u1[0, 0] == pytest.approx(moves["pinion"] @ across, abs=1e-8 * size)
        assert found.u2[0, 0] == pytest.approx(moves["gear"] @ across, abs=1e-8 * size)
        assert found.across[0, 0] == pytest.approx(sliding @ across, abs=1e-8 * size)
        assert abs(found.along[0, 0]) == pytest.approx(abs(sliding @ way), abs=1e-8 * size)
        # seen from the point of the line in a plane across the axis that stands
        along = np.sign(way @ axis) * way
        standing = -line.base_pitch * (normal @ axis) / (along @ axis)
        entrained = 0.5 * (moves["pinion"] + moves["gear"]) @ along - standing
        assert found.line_entrainment[0, 0] == pytest.approx(entrained, abs=1e-8 * size)
