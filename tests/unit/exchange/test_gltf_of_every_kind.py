"""A glTF scene holds helical, tapered, offset and asymmetric gears in mesh, free of each other."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import trimesh
from family_pairs import pair_of, public_pair
from public_teeth import NAMES, public_design

from facegear.exchange.gltf import PROFILE, WIDTH, gear_transform, pinion_transform, write_gltf
from facegear.teeth.placement import pair_at, pinion_to_gear
from facegear.teeth.solids import solid, volume

GEARS = {"upper": "upper face gear", "lower": "lower face gear"}


def pair_between_gears(name):
    """A public pair whose pinion also meets a lower gear; that of P4, with 25 mm of offset, is undercut."""
    if name != "P4":
        return public_pair(name)
    face = {"inner_radius": 237e-3, "outer_radius": 256e-3, "middle": 247e-3}
    return pair_of(replace(public_design(name), offset=5e-3, **face))


@cache
def scene_of(name, folder):
    """The scene of a pinion between two gears."""
    path = write_gltf(folder / f"{name}.glb", pair_between_gears(name), [("first", 0.0)], tuple(GEARS))
    return trimesh.load(path)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("gltf")


def placed(scene, name):
    """A body's vertices (n, 3) and triangles where the scene has it."""
    transform, shape = scene.graph[name]
    body = scene.geometry[shape]
    return trimesh.transform_points(body.vertices, transform), body.faces


def winding(points, vertices, faces):
    """How often a closed surface goes round each point: 1 inside, 0 outside; by solid angles."""
    turns = []
    for point in points:
        corners = vertices[faces] - point
        a, b, c = np.moveaxis(corners, 1, 0)
        la, lb, lc = np.linalg.norm(corners, axis=2).T
        over = np.einsum("ij,ij->i", a, np.cross(b, c))
        below = la * lb * lc + (a * b).sum(-1) * lc + (b * c).sum(-1) * la + (c * a).sum(-1) * lb
        turns.append(np.arctan2(over, below).sum() / (2 * np.pi))
    return np.array(turns)


def points_near(vertices, pinion):
    """Return some fifty vertices of a gear within the pinion's box."""
    low, high = pinion.min(axis=0), pinion.max(axis=0)
    inside = vertices[((vertices > low) & (vertices < high)).all(axis=1)]
    return inside[:: max(1, len(inside) // 50)]


@pytest.mark.parametrize("name", ["P3"])
def test_bodies_are_closed_and_have_the_volume_of_the_exact_surfaces(name, folder):
    design, scene = pair_between_gears(name), scene_of(name, folder)
    assert set(scene.geometry) == {"pinion", "face_gear", "lower_face_gear"}
    bodies = {"first": (design, "pinion")}
    bodies |= {node: (pair_at(design, side, "drive"), "face_gear") for side, node in GEARS.items()}
    for node, (pair, kind) in bodies.items():
        body = trimesh.Trimesh(*placed(scene, node))
        assert body.is_watertight
        exact = volume(solid(pair, kind, None, PROFILE, WIDTH))
        assert body.volume == pytest.approx(exact, rel=1e-4), "coordinates are of single precision"


@pytest.mark.parametrize("side", GEARS)
@pytest.mark.parametrize("name", NAMES)
def test_no_tooth_of_either_gear_stands_inside_the_pinion(name, side, folder):
    scene = scene_of(name, folder)
    pinion, faces = placed(scene, "first")
    points = points_near(placed(scene, GEARS[side])[0], pinion)
    assert len(points) > 40
    assert np.abs(winding(points, pinion, faces)).max() < 0.5
    half_pitch = np.pi / pair_between_gears(name).pinion.teeth
    middle, along = pinion.mean(axis=0), scene.graph["first"][0][:3, 1]
    turn = trimesh.transformations.rotation_matrix(half_pitch, along, middle)
    assert winding(points, trimesh.transform_points(pinion, turn), faces).max() > 0.5


@pytest.mark.parametrize("name", NAMES)
def test_the_pinion_stands_where_contact_has_it(name):
    design = pair_between_gears(name)
    motion = pinion_to_gear(design, 0.0, 0.0, 0)
    transform = pinion_transform(design, 0.0)
    np.testing.assert_allclose(transform[:3, :3], motion.matrix, atol=1e-15)
    np.testing.assert_allclose(transform[:3, 3], motion.shift, atol=1e-15)


@pytest.mark.parametrize("name", NAMES)
def test_the_pinion_stands_against_the_lower_gear_as_against_its_pair(name):
    """In the lower gear's frame the pinion's axis is that of the lower pair, and its teeth are a pitch on."""
    design = pair_between_gears(name)
    lower = pair_at(design, "lower", "drive")
    here = np.linalg.inv(gear_transform(design, "lower")) @ pinion_transform(design, 0.0)
    shift = np.pi / design.face_gear.teeth if design.pinion.teeth % 2 else 0.0
    there = pinion_to_gear(lower, shift * design.face_gear.teeth / design.pinion.teeth, shift, 0)
    turned = np.linalg.inv(there.matrix) @ here[:3, :3]
    np.testing.assert_allclose(here[:3, 3], there.shift, atol=1e-15)
    np.testing.assert_allclose(turned[:, 1], [0.0, 1.0, 0.0], atol=1e-14)
    pitches = np.arctan2(turned[0, 2], turned[2, 2]) * design.pinion.teeth / (2 * np.pi)
    assert pitches == pytest.approx(round(pitches), abs=1e-9)
