"""Sections out of STEP files: solids of revolution and half sections, and files that are refused."""

from contextlib import contextmanager
from pathlib import Path

import gmsh
import numpy as np
import pytest
import yaml

from facegear.build.elastic_bodies import body_shape
from facegear.build.load import load_config
from facegear.errors import ConfigErrors
from facegear.io.step_section import CHORD, read_section
from facegear.parts.body_mesh import body_mesh, reentrant
from facegear.parts.section import section_properties
from facegear.schema.base import parse
from facegear.schema.gear_body import BodySection

FLEXIBLE = load_config(Path(__file__).parents[3] / "config" / "flexible.yaml")
PAIR = FLEXIBLE.tooth_pair
SHAPE = body_shape(FLEXIBLE.transmission.face_gear.body, PAIR)
CORNERS = 1e3 * SHAPE.corners


@contextmanager
def writing(path):
    """A gmsh model that is written to a STEP file in mm."""
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        yield gmsh.model.occ
        gmsh.model.occ.synchronize()
        gmsh.write(str(path))
    finally:
        gmsh.finalize()


def half_section(occ, corners):
    points = [occ.addPoint(r, 0.0, z) for r, z in corners]
    lines = [occ.addLine(a, b) for a, b in zip(points, [*points[1:], points[0]], strict=True)]
    return occ.addPlaneSurface([occ.addCurveLoop(lines)])


def turned(occ, corners):
    face = half_section(occ, corners)
    made = occ.revolve([(2, face)], 0, 0, 0, 0, 0, 1, 2.0 * np.pi)
    occ.remove([(2, face)], recursive=True)
    return next(tag for dimension, tag in made if dimension == 3)


def box(r0, r1, z0, z1):
    return [(r0, z0), (r1, z0), (r1, z1), (r0, z1)]


def step(path, build, corners=CORNERS):
    with writing(path) as occ:
        build(occ, corners)
    return path


def refusal(path, **beside):
    with pytest.raises(ConfigErrors) as refused:
        parse(BodySection, {"step": str(path), **beside})
    assert len(refused.value.lines) == 1
    return refused.value.lines[0]


@pytest.mark.parametrize("build", [turned, half_section])
def test_body_of_a_step_file_is_that_of_its_parameters(tmp_path, build):
    given = parse(BodySection, {"step": str(step(tmp_path / "gear.step", build))})
    shape = body_shape(given, PAIR)
    assert section_properties(shape) == pytest.approx(section_properties(SHAPE), rel=1e-9)
    assert shape.is_edge_held == SHAPE.is_edge_held
    same = body_shape(parse(BodySection, {"corners_mm": CORNERS.round(9).tolist()}), PAIR)
    drawn, typed = body_mesh(shape), body_mesh(same)
    assert np.array_equal(drawn.nodes, typed.nodes) and np.array_equal(drawn.quads, typed.quads)


@pytest.mark.parametrize("degrees", [90.0, 180.0, -90.0, 37.0])
def test_half_section_is_read_in_every_half_plane_through_the_axis(tmp_path, degrees):
    """The distance from the axis counts, wherever the face stands about it."""
    with writing(path := tmp_path / "gear.step") as occ:
        face = half_section(occ, CORNERS)
        occ.rotate([(2, face)], 0, 0, 0, 0, 0, 1, np.radians(degrees))
    straight = step(tmp_path / "straight.step", half_section)
    assert np.array(read_section(path)) == pytest.approx(np.array(read_section(straight)), abs=1e-8)


def test_file_says_its_own_unit(tmp_path):
    path = step(tmp_path / "gear.step", turned, 1e-3 * CORNERS)
    text = path.read_text()
    assert "SI_UNIT(.MILLI.,.METRE.)" in text
    path.write_text(text.replace("SI_UNIT(.MILLI.,.METRE.)", "SI_UNIT($,.METRE.)"))
    assert np.array(read_section(path)) == pytest.approx(CORNERS, abs=1e-6)
    path.write_text(text)
    assert "its outer radius is 0.275 mm by the unit of the file; 1 to 10000 mm are read" in refusal(path)


def test_curves_become_edges_within_the_stated_distance_and_take_no_smaller_elements(tmp_path):
    with writing(path := tmp_path / "ring.step") as occ:
        occ.addTorus(0, 0, 5, 200, 20)
    corners = np.array(read_section(path))
    assert np.hypot(corners[:, 0] - 200, corners[:, 1] - 5) == pytest.approx(20, abs=1e-8)
    middles = 0.5 * (corners + np.roll(corners, -1, axis=0))
    missed = 20 - np.hypot(middles[:, 0] - 200, middles[:, 1] - 5)
    assert 0.2 * CHORD < missed.max() <= CHORD
    with writing(rounded := tmp_path / "rounded.step") as occ:
        solid = occ.cut([(3, turned(occ, box(100, 250, 0, 80)))], [(3, turned(occ, box(150, 200, 40, 90)))])
        edges = [
            tag
            for _, tag in occ.getEntities(1)
            if np.allclose(occ.getBoundingBox(1, tag)[2::3], 40.0, atol=1e-3)
        ]
        assert len(edges) == 2
        occ.fillet([solid[0][0][1]], edges, [8.0])
    corners = np.array(read_section(rounded))
    assert len(corners) > 20 and reentrant(corners).size == 0
    area = 150 * 80 - 50 * 40 + 2 * (1 - np.pi / 4) * 8**2
    r, z = corners.T
    measured = 0.5 * np.sum(r * np.roll(z, -1) - z * np.roll(r, -1))
    assert 0.0 < measured - area < np.pi * 8 * CHORD


def test_file_counts_from_the_config_and_its_edit_changes_only_the_section(tmp_path):
    values = FLEXIBLE.model_dump(mode="json")
    values["transmission"]["face_gear"]["body"] = {"step": "gear.step"}
    (tmp_path / "machine.yaml").write_text(yaml.safe_dump(values))
    loaded = []
    for bore in (120.0, 121.0):
        corners = CORNERS.copy()
        corners[corners[:, 0] < 120.5, 0] = bore
        step(tmp_path / "gear.step", half_section, corners)
        loaded.append(load_config(tmp_path / "machine.yaml").model_dump(mode="json"))
    bodies = [values["transmission"]["face_gear"].pop("body") for values in loaded]
    assert loaded[0] == loaded[1]
    drawn = [body.pop("corners_mm") for body in bodies]
    assert bodies[0] == bodies[1] and bodies[0]["step"] is None
    assert min(drawn[0])[0] == 120.0 and min(drawn[1])[0] == 121.0


def two_rings(occ, corners):
    turned(occ, box(100, 150, 0, 20))
    turned(occ, box(200, 250, 0, 20))


def hollow(occ, corners):
    occ.cut([(3, turned(occ, box(100, 250, 0, 80)))], [(3, turned(occ, box(150, 200, 20, 60)))])


def drilled(occ, corners):
    hole = occ.addCylinder(-200, 20, -100, 0, 0, 200, 8)
    occ.cut([(3, turned(occ, corners))], [(3, hole)])


def drilled_twice(occ, corners):
    holes = [(3, occ.addCylinder(*way, -100, 0, 0, 200, 8)) for way in ((-200, 20), (200, -20))]
    occ.cut([(3, turned(occ, corners))], holes)


def square(occ, corners):
    occ.cut([(3, occ.addBox(-200, -200, 0, 400, 400, 30))], [(3, occ.addCylinder(0, 0, -10, 0, 0, 100, 80))])


def beside_axis(occ, corners):
    occ.translate([(3, turned(occ, corners))], 0.5, 0, 0)


def disc(occ, corners):
    occ.addCylinder(0, 0, 0, 0, 0, 12, 275)


def both_sides(occ, corners):
    occ.rotate([(2, occ.addRectangle(-200, -20, 0, 400, 40))], 0, 0, 0, 1, 0, 0, 0.5 * np.pi)


def leaning(occ, corners):
    occ.rotate([(2, half_section(occ, corners))], 200, 0, 0, 1, 0, 0, 0.01)


def across(occ, corners):
    occ.addRectangle(100, 20, 0, 150, 20)


@pytest.mark.parametrize(
    ("build", "line"),
    [
        (two_rings, "it holds 2 solids"),
        (hollow, "its section has a hole"),
        (drilled, "is not one of revolution: its centre of mass lies 0.1"),
        (drilled_twice, "is not one of revolution: its volume is"),
        (square, "is not one of revolution about the z axis: two cuts differ"),
        (beside_axis, "is not one of revolution about the z axis: two cuts differ"),
        (disc, "its body has no bore"),
        (across, "its face lies in no half plane through the z axis"),
        (leaning, "its face lies in no half plane through the z axis"),
        (both_sides, "its face lies in no half plane through the z axis"),
    ],
)
def test_shape_without_one_section_is_refused_in_one_line(tmp_path, build, line):
    said = refusal(step(tmp_path / "gear.step", build))
    assert said.startswith('step = "') and line in said, said


def test_file_that_is_no_step_file_or_stands_beside_corners_is_refused_in_one_line(tmp_path):
    assert "no such file" in refusal(tmp_path / "missing.step")
    assert "it is not a file" in refusal(tmp_path)
    (tmp_path / "text.step").write_text("r_mm,height_mm\n120,0\n")
    assert "gmsh cannot read it" in refusal(tmp_path / "text.step")
    path = step(tmp_path / "gear.step", half_section)
    assert "must be left out beside corners_mm" in refusal(path, corners_mm=CORNERS.tolist())
    assert "must be left out beside corners_mm" in refusal(path, rim={"back_mm": -12.0})
