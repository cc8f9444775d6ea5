"""Helical and tapered pairs cut out for three programs: the teeth of the whole pairs, shorter; no run."""

from dataclasses import replace
from math import tan

import numpy as np
import pytest

import facegear
from facegear.build.tooth_pair import pair
from facegear.teeth.mesh_sizes import MeshSizes
from facegear.teeth.placement import body_rotation
from facegear.teeth.surfaces import flank_points
from validation.contact.family_peer import CONFIGS, family_pair, touching_place
from validation.contact.pair_bodies import PairBodies, contact_faces, held_nodes
from validation.contact.pair_own import Answer
from validation.contact.pair_peer import _row

TURN = 1e-3


@pytest.fixture(scope="module", params=CONFIGS)
def kind(request):
    return request.param


@pytest.fixture(scope="module")
def whole(kind):
    return pair(facegear.load(CONFIGS[kind], results=None).config.tooth_pair).design


@pytest.fixture(scope="module")
def cut_out(kind):
    family = family_pair(kind)
    return PairBodies(family.design, MeshSizes(3e-3, 4e-3, 4e-3), family.materials, family.position)


def mean_normals(bodies):
    """Mean outward unit normal of the faces that may touch, one a body."""
    means = []
    for faces in bodies.faces:
        a, b, c, d = (bodies.nodes[faces[:, corner]] for corner in range(4))
        means.append(np.cross(c - a, d - b).sum(axis=0))
    return np.array(means) / np.linalg.norm(means, axis=1)[:, None]


def test_the_part_that_is_cut_out_has_the_flanks_of_the_whole_pair(whole, cut_out):
    part = cut_out.design
    roll, y = np.array([0.35, 0.45, 0.55]), part.middle + np.array([-2e-3, 0.0, 2e-3])
    found, expected = (flank_points(design, roll, y).position for design in (part, whole))
    # the reference tooth is centred in the middle of either face, and a helix turns it on the way
    turn = tan(whole.helix_angle) * (part.middle - whole.middle) / whole.pinion_pitch_radius
    np.testing.assert_allclose(found, expected @ body_rotation("pinion", turn).T, atol=1e-15)
    assert touching_place(part)[:2] == pytest.approx(touching_place(whole)[:2], rel=1e-12)


def test_normals_face_each_other_and_point_along_the_axis_as_the_helicoid_s_do(cut_out):
    bodies = cut_out.linear(TURN)
    one, two = mean_normals(bodies)
    assert one @ two < -0.9
    flank = cut_out.design.family.pinion_flanks[0]
    assert abs(flank.sine) > 0.02
    tooth = cut_out.teeth["pinion"]
    nodes = tooth.nodes[tooth.surfaces["flank_right"].nodes]
    normal = np.cross(*(np.gradient(nodes, axis=axis) for axis in (0, 1)))
    along = normal[1:-1, 1:-1, 1] / np.linalg.norm(normal[1:-1, 1:-1], axis=-1)
    np.testing.assert_allclose(np.abs(along), abs(flank.sine), atol=0.01)


def test_the_gears_mesh_runs_through_the_touching_place(cut_out):
    roll, y, _ = touching_place(cut_out.design)
    point = flank_points(cut_out.design, roll, y).position
    grid = cut_out.node_positions("face_gear")[cut_out.teeth["face_gear"].surfaces["flank_left"].nodes]
    nearest = np.unravel_index(np.argmin(np.linalg.norm(grid - point, axis=-1)), grid.shape[:2])
    down, beside = (np.gradient(grid, axis=axis)[nearest] for axis in (0, 1))
    normal = np.cross(down, beside)
    assert abs(normal @ (grid[nearest] - point)) < 10e-6 * np.linalg.norm(normal)


def test_supports_turn_about_the_axis_and_helical_cuts_are_a_pitch_apart(cut_out):
    bodies = cut_out.linear(TURN)
    pinion = cut_out.teeth["pinion"]
    x, _, z = bodies.nodes[held_nodes(pinion)].T
    u, v, w = bodies.support_displacement[held_nodes(pinion)].T
    np.testing.assert_allclose(np.hypot(u, w), TURN * np.hypot(x, z), rtol=1e-12)
    np.testing.assert_allclose(x * u + z * w, 0.0, atol=1e-12)
    assert (v == 0.0).all()
    left, right = (pinion.nodes[cut] for cut in (pinion.cut_left, pinion.cut_right))
    np.testing.assert_allclose(pinion.rotated(left, pinion.pitch), right, atol=1e-12)


@pytest.mark.parametrize("body", ["pinion", "face_gear"])
def test_a_small_rigid_motion_stresses_no_fillet_of_other_teeth(cut_out, body):
    points = cut_out.node_positions(body)
    rigid = 1e-6 * np.array([1.0, -2.0, 3.0]) + np.cross([1e-4, 2e-4, -3e-4], points)
    material = cut_out.materials[0]
    assert abs(cut_out.root_stress(body, rigid)) < 1e-8 * material.young_modulus
    grown = cut_out.root_stress(body, 1e-4 * points)
    expected = 1e-4 * material.young_modulus / (1.0 - material.poisson_ratio)
    assert grown == pytest.approx(expected, rel=1e-9)


def test_stiffness_is_force_along_the_normal_over_the_way_along_it(cut_out):
    arm = cut_out.design.normal_arm
    force, way = 4000.0, 25e-6
    answer = Answer(force * arm, way / arm, 0.0, 0.0, 0.0, 0.0)
    row = _row(cut_out, "medium", "facegear", 1, answer, 0.0, 0.0)
    assert row["stiffness_n_per_um"] == pytest.approx(1e-6 * force / way, rel=1e-12)


def test_faces_that_kratos_may_close_lie_along_the_line_of_contact(cut_out):
    pair = replace(cut_out, sizes=MeshSizes(1e-3, 1.5e-3, 4e-3))
    pinion, width = pair.teeth["pinion"], pair.design.pinion.width
    every = {tuple(face) for face in contact_faces(pinion)}
    few, more = ({tuple(face) for face in pair.close_faces(turn)} for turn in (TURN / 4, TURN))
    assert few < more < every
    places = pinion.nodes[np.array(sorted(few))]
    y = places[..., 1]
    assert (y.min(), y.max()) == pytest.approx(pair.design.middle + np.array([-0.5, 0.5]) * width)
    roll, middle, _ = touching_place(pair.design)
    touch = flank_points(pair.design, roll, middle).position
    assert np.linalg.norm(places - touch, axis=-1).min() < 1e-3
    # across the line a gap of 20 um is some 0.9 mm away, and an element is 1 mm high
    heights = np.hypot(places[..., 0], places[..., 2])[np.abs(y.mean(axis=1) - middle) < 1e-3]
    assert np.abs(heights - np.hypot(touch[0], touch[2])).max() < 3e-3
