"""Pose of a mesh from the motions of its bodies: exactly, to first order, and in the machine's directions."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lumped_machines import make_layout
from references import against, agrees

from facegear.build.load import load_config
from facegear.build.tooth_pair import pair_design
from facegear.machine.kinematics import GEOMETRIC
from facegear.machine.layout import Role, Tilt
from facegear.machine.linear_model import LinearModel, lumped_model
from facegear.machine.poses.displaced_pair import body_motion, pose_of
from facegear.machine.poses.mesh_poses import mesh_poses, pose_rows, to_mesh_frame
from facegear.teeth.conjugate import conjugate_contact
from facegear.teeth.design import AssemblyErrors
from facegear.teeth.placement import body_rotation, mirror_design, pinion_to_gear

PITCHES = 143 * 30.0 / 360.0
SIDES = {"lower": -1.0, "upper": 1.0}
PUBLISHED = {
    "upper": (91.552571, 71.009790, 0.00803542, -17.1232, -17.111118, 140.755496),
    "lower": (-98.774889, -71.010566, -0.00803542, -20.2092, -77.806095, -41.469026),
}
"""Offset, axial shift (um), error of the shaft angle (deg), shift outwards, transmission errors of drive and
back flank with all turns (um), of the motion below."""
MOTION = {
    "pinion": ((80e-6, -50e-6, 0.0), np.radians((0.010, -0.006, 0.0))),
    "gear": ((20e-6, -10e-6, 30e-6), np.radians((0.004, -0.003))),
}
BELOW = 0.045 - 0.5 * 23 * 3.75e-3


@pytest.fixture(scope="module")
def design():
    section = load_config("config/paper.yaml").tooth_pair
    pair = pair_design(section)
    return replace(pair, pinion=replace(pair.pinion, thinning=1e-4))


def motions(side, design, size=1.0, below=BELOW):
    """Pinion and gear in the frame of their mesh, moved by `size` times MOTION."""
    sign, at = SIDES[side], np.radians(30.0)
    tangent, away = np.array([np.cos(at), np.sin(at)]), np.array([np.sin(at), -np.cos(at)])
    shift, turn = (size * np.array(part) for part in MOTION["pinion"])
    frame = to_mesh_frame(sign)
    pinion = body_motion(frame @ shift, frame @ turn, frame @ [0.0, 0.0, design.mean_radius])
    shift, tilt = (size * np.array(part) for part in MOTION["gear"])
    height = sign * (design.pinion_pitch_radius + below)
    moved = (shift[:2] @ tangent, shift[2], shift[:2] @ away)
    turn = frame @ [tilt @ tangent, 0.0, tilt @ away]
    return pinion, body_motion(frame @ moved, turn, frame @ [0.0, height, 0.0])


def leaning(layout):
    """A machine whose pinion has two tilts behind the coordinates of the layout."""
    model = lumped_model(layout)
    size = model.size + 2
    wider = np.zeros((size, size))
    wider[: model.size, : model.size] = model.stiffness
    labels = (*model.labels, "one:tilt_x", "one:tilt_y")
    rows = np.concatenate([model.rows, np.zeros((len(model.rows), 2))], axis=1)
    return replace(model, labels=labels, stiffness=wider, rows=rows)


def layout_of(below=BELOW):
    layout = make_layout((("one", Role.INPUT, PITCHES),), kinematics=GEOMETRIC)
    tilt = Tilt(0.3, 1e7, below)
    return replace(layout, gears=tuple(replace(g, body=replace(g.body, tilt=tilt)) for g in layout.gears))


def moved_by(model: LinearModel, size=1.0):
    """Displacements of `size` times MOTION of all bodies of `leaning`."""
    place = {label: number for number, label in enumerate(model.labels)}
    displacements = np.zeros(model.size)
    shift, turn = MOTION["pinion"]
    for letter, value in zip(("x", "y", "z", "tilt_x", "tilt_y"), (*shift, *turn[:2]), strict=True):
        displacements[place[f"one:{letter}"]] = value
    shift, tilt = MOTION["gear"]
    for side in SIDES:
        for letter, value in zip(("x", "y", "z", "tilt_x", "tilt_y"), (*shift, *tilt), strict=True):
            displacements[place[f"{side} face gear:{letter}"]] = value
    return size * displacements


@against(
    "second implementation",
    "both bodies displaced rigidly, contact searched at 1e-13 m",
    capability="geometry",
    module="facegear.teeth.conjugate",
)
@pytest.mark.parametrize("side", SIDES)
def test_a_pose_of_two_moved_bodies_is_the_published_one(design, side):
    pose = pose_of(*motions(side, design), design.mean_radius, design.family.motion)
    errors = pose.errors
    parts = (1e6 * errors.offset, 1e6 * errors.gear_axial, 1e6 * pose.outward)
    published = PUBLISHED[side]
    agrees("offset and axial shift, um", parts[:2], published[:2], absolute=6e-7)
    agrees("error of the shaft angle, deg", np.degrees(errors.shaft_angle_error), published[2], absolute=6e-9)
    agrees("shift outwards, um", parts[2], published[3], absolute=6e-5)
    posed = replace(design, assembly=errors)
    turned = design.pinion_base_radius * pose.ahead + design.gear_base_radius * pose.behind
    drive = conjugate_contact(posed).transmission_error
    back = -conjugate_contact(mirror_design(posed)).transmission_error
    computed = [1e6 * (error + turned) for error in (drive, back)]
    agrees("transmission errors, um", computed, published[4:], absolute=6e-7)


@settings(max_examples=20, deadline=None)
@given(
    st.lists(st.floats(-0.3, 0.3), min_size=12, max_size=12),
    st.floats(-0.1, 0.1),
    st.floats(-0.1, 0.1),
)
def test_a_pair_in_its_pose_stands_as_both_moved_bodies_do(design, parts, phi1, phi2):
    """Pinion's teeth and gear's teeth differ by an equal rigid motion, for motions that are large."""
    first, second, third, fourth = np.array(parts).reshape(4, 3)
    pinion = body_motion(0.1 * first, second, (0.0, design.mean_radius, 0.0))
    gear = body_motion(0.1 * third, fourth, (0.0, 0.0, -0.05))
    pose = pose_of(pinion, gear, design.mean_radius, design.family.motion)
    points = np.array([[0.01, 0.25, -0.04], [-0.02, 0.27, 0.03], [0.0, 0.26, 0.0]])
    turned = points @ body_rotation("pinion", phi1 + (0 - 0.5) * 2 * np.pi / 23).T
    brute = gear.inverse().points(pinion.points(turned)) @ body_rotation("face_gear", -phi2).T
    posed = replace(design, assembly=pose.errors)
    along = points + np.array([0.0, pose.outward, 0.0])
    motion = pinion_to_gear(posed, phi1 + pose.ahead, phi2 - pose.behind, 0)
    np.testing.assert_allclose(motion.points(along), brute, atol=1e-14)


@pytest.mark.parametrize("side", SIDES)
def test_the_first_order_of_a_pose_errs_four_times_less_for_half_the_motion(design, side):
    layout = layout_of()
    model = leaning(layout)
    mesh = layout.mesh_names.index(f"one/{side}")
    differences = []
    for size in (1.0, 0.5, 0.25):
        linear = mesh_poses(model, layout, design.mean_radius, moved_by(model, size))
        pose = pose_of(*motions(side, design, size), design.mean_radius, design.family.motion)
        exact = pose.errors
        first = linear.errors(mesh)
        parts = (first.offset, first.gear_axial, 0.1 * first.shaft_angle_error, linear.outward[mesh])
        known = (exact.offset, exact.gear_axial, 0.1 * exact.shaft_angle_error, pose.outward)
        differences.append(np.abs(np.array(parts) - known).max())
    assert differences[0] < 2e-8
    assert differences[0] / differences[1] == pytest.approx(4.0, rel=1e-2)
    assert differences[1] / differences[2] == pytest.approx(4.0, rel=1e-2)


@pytest.mark.parametrize("below", [0.0, BELOW, -0.02])
def test_along_the_line_of_action_a_pose_and_the_machine_s_own_directions_are_the_same(design, below):
    """Displacements, turns and the gears' tilts, for any point that the gears tilt about."""
    layout = layout_of(below)
    model = lumped_model(layout)
    angle, names = design.pressure_angle, list(model.labels)
    offset, shift, tilt, _ = pose_rows(model, layout, design.mean_radius)
    beyond = design.gear_pitch_radius - design.mean_radius
    closing = np.cos(angle) * offset - np.sin(angle) * (shift + beyond * tilt)
    away = np.array([np.sin(layout.angles[0]), -np.cos(layout.angles[0])])
    for mesh, side in enumerate(layout.mesh_names):
        gear = f"{side.split('/')[1]} face gear"
        closing[mesh, names.index("one:theta")] = design.pinion_base_radius
        closing[mesh, names.index(f"{gear}:theta")] = -design.gear_base_radius
        first = names.index(f"{gear}:tilt_x")
        closing[mesh, first : first + 2] += design.pinion_base_radius * away
    np.testing.assert_allclose(1e-6 * closing, 1e-6 * model.rows[: len(closing)], rtol=0, atol=1e-20)


@settings(max_examples=25, deadline=None)
@given(st.floats(-1e-4, 1e-4))
def test_a_motion_along_the_line_of_action_changes_the_deflection_alone(design, offset):
    """Path and slope of the unloaded contact stay for any motion that is along the common normal."""
    shift = -(offset * np.tan(design.pressure_angle))
    posed = replace(design, assembly=AssemblyErrors(offset=offset, gear_axial=shift))
    contact = conjugate_contact(posed)
    assert contact.y == pytest.approx(design.gear_pitch_radius, abs=1e-12)
    assert contact.psi == pytest.approx(design.pressure_angle, abs=1e-12)
    along = offset / np.cos(design.pressure_angle)
    assert contact.transmission_error == pytest.approx(along - design.pinion.thinning / 2, abs=1e-15)


def test_a_flank_s_back_meets_the_offset_from_the_other_side(design):
    layout = layout_of()
    model = leaning(layout)
    poses = mesh_poses(model, layout, design.mean_radius, moved_by(model))
    mesh = layout.mesh_names.index("one/upper")
    drive, back = poses.errors(mesh), poses.errors(mesh, back=True)
    assert back == replace(drive, offset=-drive.offset)
