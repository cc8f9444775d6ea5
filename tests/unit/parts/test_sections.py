"""Sections as a config gives them: what they become, and what is refused in one line before any work."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from gear_bodies import STEEL

from facegear.build.config import Config
from facegear.build.elastic_bodies import body_shape
from facegear.build.load import load_config
from facegear.build.machine_layout import layout
from facegear.build.teeth_on_body import crosses_rectangle
from facegear.build.tooth_numbers import ToothNumbers
from facegear.errors import ConfigErrors
from facegear.machine.layout import Tilt
from facegear.parts.body_mesh import body_mesh, reentrant
from facegear.parts.section import Layer, Section, inertia_about, rectangle, section_properties, thinnest
from facegear.schema.base import parse
from facegear.schema.gear_body import BodySection

FLEXIBLE = load_config(Path(__file__).parents[3] / "config" / "flexible.yaml")
PAIR = FLEXIBLE.tooth_pair
BODY = FLEXIBLE.transmission.face_gear.body
POLYGON = [
    [120, -50],
    [140, -50],
    [140, -40],
    [250, -12],
    [275, -12],
    [275, 12],
    [250, 12],
    [250, 0],
    [140, -22],
    [140, 0],
    [120, 0],
]


def lines(**changes):
    """All that is said of the flexible machine with dotted keys of its body or gear (two underscores) set."""
    values = FLEXIBLE.model_dump(mode="json")
    for key, value in changes.items():
        inside = values["transmission"]["face_gear"]
        *sections, last = key.split("__")
        for section in sections:
            inside = inside[section]
        inside[last] = value
    with pytest.raises(ConfigErrors) as refused:
        parse(Config, values)
    return refused.value.lines


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        (
            {"body__hub__outer_radius_mm": 260.0},
            "body.hub.outer_radius_mm = 260.0: must be below inner radius",
        ),
        ({"body__hub__bore_radius_mm": 150.0}, "body.hub.bore_radius_mm = 150.0: must be below outer radius"),
        ({"body__teeth": "fit"}, "body.teeth = \"fit\": must be True, False or 'fitted'"),
        ({"body__web__offset_mm": 20.0}, "body.web.offset_mm = 20.0: must be such that the web"),
        ({"body__web__hub_thickness_mm": 60.0}, "body.web.offset_mm = -6.0: must be such that the web"),
        (
            {"body__web__rim_thickness_mm": 0.1},
            "body.web.rim_thickness_mm = 0.1: must be such that the thinnest wall",
        ),
        ({"body__rim__inner_radius_mm": 252.0}, "body.rim.inner_radius_mm = "),
        ({"body__rim__outer_radius_mm": 0.275}, "body.rim.inner_radius_mm = 250.0: must be below 0.275"),
        ({"body__web__hub_thickness_mm": 0.018}, "body.web.hub_thickness_mm = 0.018: must be such that the"),
        (
            {"body__hub__outer_radius_mm": 0.14},
            "body.hub.bore_radius_mm = 120.0: must be below outer radius of the hub, 0.14 mm",
        ),
        (
            {"body__material": {"young_modulus_gpa": 206e9, "poisson_ratio": 0.3}},
            "material.young_modulus_gpa = 206000000000.0: must be less than or equal to 2000",
        ),
        ({"body__rim__back_mm": 3.0}, "body.rim.back_mm = 3.0: must be less than or equal to 0"),
        ({"body__rim": None}, "body.rim = null: must be given"),
        ({"body__hub": None}, "body.hub = null: must be given"),
        (
            {"body__density_kg_per_m3": 7.85},
            "density_kg_per_m3 = 7.85: must be greater than or equal to 500",
        ),
        ({"mass_kg": 7.795}, "face_gear.mass_kg = 7.795: must be at least 31.1827 kg"),
        ({"inertia_kg_m2": 0.54}, "face_gear.inertia_kg_m2 = 0.54: must be at least 1.36121 kg m2"),
        (
            {"tilt": {"inertia_kg_m2": 0.7, "stiffness_n_m_per_rad": 1e7}},
            'face_gear.tilt = "given": must be left out',
        ),
        (
            {"hub_tilt": {"inertia_kg_m2": 0.5, "stiffness_n_m_per_rad": 1e7}},
            "face_gear.hub_tilt.inertia_kg_m2 = 0.5: must be at least 0.7",
        ),
        (
            {"body": None, "hub_tilt": {"inertia_kg_m2": 2.0, "stiffness_n_m_per_rad": 1e7}},
            'face_gear.hub_tilt = "given": must be left out where the gear has no body',
        ),
        ({"body__corners_mm": POLYGON}, 'body.hub = "given": must be left out beside corners_mm'),
        ({"body": {"held_edges": [1], "rim": {"back_mm": -5.0}}}, "body.held_edges = [1]: must be left out"),
    ],
)
def test_body_that_cannot_be_is_refused_in_one_line_with_key_and_value(changes, line):
    said = lines(**changes)
    assert len(said) == 1 and line in said[0], said


@pytest.mark.parametrize(
    ("corners", "line"),
    [
        (
            POLYGON[:3] + [[250, 5], [275, -12], [275, 12], [250, 12], [250, -12]] + POLYGON[8:],
            "does not cross itself",
        ),
        (POLYGON[:2], "three points or more"),
        ([[0.001 * r, 0.001 * z] for r, z in POLYGON], "on which the teeth stand"),
        (POLYGON[:5] + [[275, 11], [250, 11]] + POLYGON[7:], "on which the teeth stand"),
        ([[120, -50], [140, -50], [140, 5], [275, 5], [275, 12], [120, 12]], "solid to height 0"),
    ],
)
@pytest.mark.parametrize("teeth", [True, "fitted"])
def test_polygon_that_crosses_itself_or_carries_no_teeth_is_refused_in_one_line(corners, line, teeth):
    said = lines(body={"corners_mm": corners, "teeth": teeth})
    assert len(said) == 1 and "body.corners_mm = " in said[0] and line in said[0], said


def test_parameters_and_the_polygon_of_their_corners_are_one_body(tmp_path):
    table = tmp_path / "section.csv"
    rows = [f"{r},{z}" for r, z in reversed(POLYGON)]
    table.write_text("\n".join(["r_mm,height_mm", *rows]))
    given = parse(BodySection, {"corners_csv": str(table)})
    flat = parse(
        BodySection,
        {
            "hub": {"bore_radius_mm": 120, "outer_radius_mm": 140, "back_mm": -50, "front_mm": 0},
            "web": {
                "hub_thickness_mm": 18,
                "rim_thickness_mm": 12,
                "offset_mm": -6,
                "cone_angle_deg": 12.8042661,
            },
            "rim": {"back_mm": -12},
        },
    )
    polygon, wheel = body_shape(given, PAIR), body_shape(flat, PAIR)
    assert section_properties(polygon) == pytest.approx(section_properties(wheel), rel=1e-6)
    for shape in (polygon, wheel):
        held = shape.edges[np.array(shape.is_edge_held)]
        assert held.shape == (1, 2, 2) and held[..., 0] == pytest.approx(0.120)
    named = given.model_copy(update={"held_edges": (1,)})
    first = body_shape(named, PAIR)
    held = np.sort(first.edges[np.array(first.is_edge_held)][0], axis=0)
    assert held == pytest.approx(np.array([[0.12, 0.0], [0.14, 0.0]]))


def test_rim_alone_is_a_disc_or_ring_held_at_its_bore():
    disc = body_shape(
        parse(BodySection, {"rim": {"inner_radius_mm": 100.0, "back_mm": 0.0}, "teeth": False}), PAIR
    )
    mass, polar, *_ = section_properties(disc)
    assert mass == pytest.approx(7850 * np.pi * (0.275**2 - 0.1**2) * 0.012, rel=1e-12)
    assert polar == pytest.approx(0.5 * mass * (0.275**2 + 0.1**2), rel=1e-12)
    assert disc.edges[np.array(disc.is_edge_held)][0, :, 0] == pytest.approx(0.1)


def test_mesh_fills_the_section_with_quadrilaterals_and_follows_the_plane_below_the_teeth():
    shape = body_shape(BODY, PAIR)
    mesh = body_mesh(shape)
    corners = mesh.nodes[mesh.quads]
    following = np.roll(corners, -1, axis=1)
    areas = 0.5 * np.abs(
        (corners[..., 0] * following[..., 1] - corners[..., 1] * following[..., 0]).sum(axis=1)
    )
    layer = (0.275 - 0.25) * 2.25 * 3.75e-3
    first, last = shape.corners, np.roll(shape.corners, -1, axis=0)
    body = 0.5 * np.sum(first[:, 0] * last[:, 1] - first[:, 1] * last[:, 0])
    assert areas[mesh.in_layer].sum() == pytest.approx(layer, rel=1e-9)
    assert areas[~mesh.in_layer].sum() == pytest.approx(body, rel=1e-9)
    on_plane = mesh.nodes[np.abs(mesh.nodes[:, 1]) < 1e-12]
    below = on_plane[on_plane[:, 0] > 0.25 - 1e-9]
    assert below[:, 0].min() == pytest.approx(0.25) and below[:, 0].max() == pytest.approx(0.275)


def test_walls_are_measured_through_the_material_and_not_across_a_gap_or_along_a_step():
    stepped = np.array([(0, 0), (10, 0), (10, 3), (5, 3), (5, 3.2), (0, 3.2)], float)
    assert thinnest(stepped) == pytest.approx(3.0)
    slotted = np.array([(0, 0), (10, 0), (10, 4), (0, 4), (0, 2.05), (6, 2.05), (6, 1.95), (0, 1.95)], float)
    assert thinnest(slotted) == pytest.approx(1.95)
    assert reentrant(stepped).tolist() == [[5.0, 3.0]]


def test_only_edges_through_the_inside_cross_a_rectangle():
    edges = np.stack([rectangle(1, 2, 0, 1), np.roll(rectangle(1, 2, 0, 1), -1, axis=0)], axis=1)
    assert not crosses_rectangle(edges, 1, 2, 0, 1)
    assert crosses_rectangle(edges, 1.5, 3, 0.2, 0.8)
    assert crosses_rectangle(np.array([[[0.0, 0.5], [3.0, 0.6]]]), 1, 2, 0, 1)


def test_hub_on_bearings_tilts_as_the_config_says_and_only_where_the_gear_bends():
    tilt = {"inertia_kg_m2": 2.0, "stiffness_n_m_per_rad": 1e7, "centre_below_pitch_plane_mm": 40.0}
    values = FLEXIBLE.model_dump(mode="json")
    gear, single = values["transmission"]["face_gear"], values["transmission"]["single_gears"]
    single["upper"] = {"body": gear["body"]}
    gear |= {"body": None, "hub_tilt": tilt}
    section = parse(Config, values).transmission
    lower, upper = layout(section, ToothNumbers.of_config(PAIR.model_dump())).gears
    assert lower.body.tilt is None and upper.body.tilt == Tilt(2.0, 1e7, 0.04)


def test_inertia_about_a_diameter_of_another_height_is_that_of_the_mass_moved_there():
    """The body is a disc by its closed form; its teeth are heavier at their roots than at their tips."""
    disc = Section(rectangle(0.1, 0.2, -0.02, 0.01), (False,) * 4, (0.1, 0.2), STEEL, 7850.0)
    mass = 7850.0 * np.pi * (0.2**2 - 0.1**2) * 0.03
    across = mass * ((0.2**2 + 0.1**2) / 4.0 + 0.03**2 / 12.0)
    assert inertia_about(disc, -0.005) == pytest.approx(across, rel=1e-12)
    assert inertia_about(disc, 0.045) == pytest.approx(across + mass * 0.05**2, rel=1e-12)
    toothed = replace(disc, layer=Layer(0.1, 0.2, 0.01, 0.04, taper=0.5))
    heights = 0.01 + 0.03 * (np.arange(4000) + 0.5) / 4000
    slices = toothed.layer.density_at(0.15, heights) * mass / 4000
    added = (slices * ((0.2**2 + 0.1**2) / 4.0 + (heights - 0.045) ** 2)).sum()
    assert inertia_about(toothed, 0.045) - inertia_about(disc, 0.045) == pytest.approx(added, rel=1e-6)
