"""A glTF scene holds the gears as they are, in mesh and free of each other."""

from functools import cache
from itertools import product

import numpy as np
import pytest
import trimesh

import facegear
from facegear.build.tooth_pair import pair_design
from facegear.exchange.gltf import PROFILE, WIDTH, gear_transform, pinion_transform, write_gltf
from facegear.teeth.solids import solid, volume

DESIGN = pair_design(facegear.example().config.tooth_pair)
GEARS = ("upper face gear", "lower face gear")
ANGLES = (("first", 0.0), ("half a pitch on", 2 * np.pi * 22.5 / 143), ("anywhere", 0.3))


@cache
def scene(folder):
    return trimesh.load(write_gltf(folder / "machine.glb", DESIGN, ANGLES, ("upper", "lower")))


@pytest.fixture(scope="module")
def machine(tmp_path_factory):
    return scene(tmp_path_factory.mktemp("gltf"))


def placed(machine, name):
    """A body's vertices (n, 3) and triangles where the scene has it."""
    transform, shape = machine.graph[name]
    body = machine.geometry[shape]
    return trimesh.transform_points(body.vertices, transform), body.faces


def winding(points, vertices, faces):
    """How often a closed surface goes round each point: 1 inside, 0 outside; by solid angles."""
    corners = vertices[faces][None] - points[:, None, None]
    length = np.linalg.norm(corners, axis=3)
    a, b, c = np.moveaxis(corners, 2, 0)
    la, lb, lc = np.moveaxis(length, 2, 0)
    over = np.einsum("...i,...i", a, np.cross(b, c))
    below = la * lb * lc + (a * b).sum(-1) * lc + (b * c).sum(-1) * la + (c * a).sum(-1) * lb
    return np.arctan2(over, below).sum(axis=1) / (2 * np.pi)


def near(vertices, pinion):
    """Vertices of a gear within the pinion's box."""
    low, high = pinion.min(axis=0), pinion.max(axis=0)
    return vertices[((vertices > low) & (vertices < high)).all(axis=1)]


def test_bodies_are_closed_and_have_the_volume_of_the_exact_surfaces(machine):
    assert set(machine.graph.nodes_geometry) == {*(name for name, _ in ANGLES), *GEARS}
    assert set(machine.geometry) == {"pinion", "face_gear"}, "each shape is stored once"
    for name, kind in (("first", "pinion"), ("upper face gear", "face_gear")):
        vertices, faces = placed(machine, name)
        body = trimesh.Trimesh(vertices, faces)
        assert body.is_watertight
        exact = volume(solid(DESIGN, kind, None, PROFILE, WIDTH))
        assert body.volume == pytest.approx(exact, rel=1e-4), "coordinates are of single precision"


@pytest.mark.parametrize(
    ("name", "gear"), [*product(("first", "half a pitch on"), GEARS), ("anywhere", GEARS[0])]
)
def test_no_tooth_of_a_gear_stands_inside_a_pinion(machine, name, gear):
    """Between two gears a pinion fits at multiples of half a pitch alone."""
    pinion, faces = placed(machine, name)
    points = near(placed(machine, gear)[0], pinion)[::17]
    assert len(points) > 20
    assert np.abs(winding(points, pinion, faces)).max() < 0.5


def test_a_pinion_turned_by_half_a_tooth_would_stand_in_the_gear(machine):
    """So that the test above can fail."""
    pinion, faces = placed(machine, "first")
    points = near(placed(machine, "upper face gear")[0], pinion)[::17]
    centre = pinion.mean(axis=0)
    along = machine.graph["first"][0][:3, 1]
    turn = trimesh.transformations.rotation_matrix(np.pi / 23, along, centre)
    assert winding(points, trimesh.transform_points(pinion, turn), faces).max() > 0.5


def test_pinions_a_whole_number_of_pitches_apart_stand_alike():
    pitch = 2 * np.pi / 143
    first, other = pinion_transform(DESIGN, 0.2), pinion_transform(DESIGN, 0.2 + 23 * pitch)
    turned = gear_transform(DESIGN, "upper") @ np.linalg.inv(first) @ other
    assert turned[:3, :3] @ [0, 1, 0] != pytest.approx([0, 1, 0])
    angle = 23 * pitch
    about = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
    np.testing.assert_allclose(other[:3, :3], about @ first[:3, :3], atol=1e-12)
