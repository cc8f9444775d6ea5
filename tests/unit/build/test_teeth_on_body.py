"""Where teeth of every kind stand on the bodies of both gears, and bodies that carry them."""

from dataclasses import replace
from math import cos, sin, tan

import numpy as np
import pytest
from kinds_of_teeth import public_section
from public_teeth import NAMES
from skfem import Basis, ElementHex2

from facegear.build.config import Config
from facegear.build.elastic_bodies import body_shape, contact_patch, fitted_shape
from facegear.build.teeth_on_body import teeth_on_body
from facegear.build.tooth_numbers import ToothNumbers
from facegear.build.tooth_pair import ToothPair, pair
from facegear.errors import ConfigErrors
from facegear.parts.body_mesh import body_mesh
from facegear.parts.matrices import around, body_matrices, rigid_motions
from facegear.parts.reduced_body import ReducedBody
from facegear.parts.section import mass_properties, section_properties
from facegear.pipeline.stages import gear_bodies as stage
from facegear.schema.base import parse
from facegear.schema.gear_body import BodySection
from facegear.schema.transmission import Transmission
from facegear.teeth import face_gear, face_gear_fillet
from facegear.teeth.mesh_quality import hex_mesh
from facegear.teeth.mesh_sizes import MeshSizes
from facegear.teeth.placement import pair_at
from facegear.teeth.tooth_mesh import gear_tooth

SIDES = {"upper": 1.0, "lower": -1.0}
DISC = {
    "rim": {"inner_radius_mm": 130.0, "back_mm": -12.0},
    "max_frequency_hz": 20000.0,
    "nodal_diameters": 2,
    "density_kg_per_m3": 7850.0,
}
BODY = {"mass_kg": 1.2, "inertia_kg_m2": 0.002, "bearing_stiffness_n_per_m": {"x": 2e8, "y": 2e8, "z": 2e8}}


def machine(body=DISC, **gear):
    return {
        "pinions": [
            {"name": "engine", "role": "input", "angle_deg": 0},
            {"name": "idler", "role": "idler", "angle_deg": 180},
        ],
        "pinion": BODY,
        "face_gear": BODY | {"mass_kg": 40, "inertia_kg_m2": 2.0, "body": body} | gear,
        "damping": {"mesh_n_s_per_m": 1500, "mass_per_s": 50, "bearing_s": 2e-6},
        "torque": {"per_input_n_m": 500, "tail_share": 0},
        "transmission_error": {"source": "given", "amplitude_um": 1},
    }


def teeth_of(name, **changes):
    return parse(ToothPair, public_section(name) | changes)


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("name", NAMES)
def test_heights_of_teeth_over_the_clamped_plane_are_those_of_the_exact_surfaces(name, side):
    teeth = teeth_of(name)
    design = pair_at(pair(teeth).design, side, "drive")
    found, ends = (
        teeth_on_body(teeth, side),
        np.array([design.face_gear.inner_radius, design.face_gear.outer_radius]),
    )
    back = face_gear_fillet.back_height(design)
    for heights, surface in ((found.roots, face_gear_fillet.root_height), (found.tips, face_gear.tip_height)):
        np.testing.assert_allclose(heights, surface(design, ends) - back, rtol=0, atol=1e-12)
    kind = ToothNumbers.of_config(teeth.model_dump()).kind
    assert found.pitch_height == pytest.approx(-kind.pitch_height(SIDES[side]) - back, abs=1e-15)
    # a cone with the half angle of the shaft angle less the taper, as deep as both addenda along u
    gamma, delta = design.shaft_angle, design.taper_angle
    assert found.slope == pytest.approx(-cos(gamma - delta) / sin(gamma - delta), abs=1e-9)
    depth = (design.face_gear.addendum + design.shaper.addendum) / (sin(gamma) - tan(delta) * cos(gamma))
    assert found.tips[0] - found.roots[0] == pytest.approx(depth, abs=1e-12)


def test_meshes_of_teeth_with_profile_shift_press_in_the_plane_in_which_they_roll():
    """Their root lies deeper below that plane by the shift."""
    section = public_section("P1") | {"helix_angle_deg": 0}
    section["pinion"] = section["pinion"] | {"profile_shift_modules": 0.2}
    teeth = parse(ToothPair, section)
    design = pair(teeth).design
    height = -design.pinion_pitch_radius - face_gear_fillet.back_height(design)
    assert contact_patch(parse(BodySection, DISC), teeth).height == pytest.approx(height, abs=1e-15)


@pytest.mark.parametrize(("name", "side"), [("P2", "upper"), ("P3", "upper"), ("P3", "lower")])
def test_mass_and_inertias_of_bodies_with_inclined_teeth_are_those_of_their_elements(name, side):
    shape = body_shape(parse(BodySection, DISC), teeth_of(name), side)
    shape = replace(shape, layer=replace(shape.layer, taper=0.4))
    assert abs(shape.layer.slope) > 0.05
    body = body_matrices(shape, body_mesh(shape, 1, 1.0))
    zero, one = (rigid_motions(body.elements, order) for order in (0, 1))
    kinetic = [around(n) * rigid.T @ (body.mass @ rigid) for n, rigid in ((0, zero), (1, one))]
    mass, polar, across, moment = section_properties(shape)
    assert np.diagonal(kinetic[0]) == pytest.approx([mass, polar], rel=1e-9)
    assert kinetic[1][1, 1] == pytest.approx(across, rel=1e-9)
    assert abs(kinetic[1][0, 1]) == pytest.approx(abs(moment), rel=1e-9)


def test_body_is_refused_unless_its_rim_goes_along_inclined_roots():
    flat = {"corners_mm": [[130, -12], [280, -12], [280, 12], [130, 12]]}
    values = {"case": "flat", "tooth_pair": public_section("P2"), "transmission": machine(flat)}
    with pytest.raises(
        ConfigErrors, match=r"an edge from radius 253 and height 13\.6083167 mm to 276 and 12 mm"
    ):
        parse(Config, values)
    inclined = {"corners_mm": [[130, -12], [276, -12], [276, 12], [253, 13.6083167], [130, 13.6083167]]}
    parse(Config, values | {"transmission": machine(inclined)})


@pytest.mark.parametrize("name", NAMES)
def test_bodies_are_solved_under_teeth_of_every_kind(name):
    """Own compliance along both flanks is that of the influence; gears are solved apart where they differ."""
    teeth = teeth_of(name)
    section = parse(Transmission, machine())
    found = stage.gear_bodies(section, teeth, 6000.0, 9000.0).content
    own = found["bodies"].set_index("gear")["own_compliance_m_per_n"]
    for gear in SIDES:
        table = found["influence"].query("gear == @gear and first == second == 'engine'")
        by_flanks = table.set_index(["first_flank", "second_flank"])["compliance_m_per_n"]
        assert own[gear] == pytest.approx(by_flanks["drive", "drive"], rel=1e-12)
        assert ("back", "back") in by_flanks or name == "P2"
        body = ReducedBody.of_arrays(found["reduced"], gear)
        assert body.static.shape == (len(body.static), 3, 3) and body.mesh[2].any()
        assert np.linalg.eigvalsh(body.static).min() > -1e-3 * np.abs(body.static).max()
    frequencies = [found["modes"].query("gear == @gear")["frequency_hz"].to_numpy() for gear in SIDES]
    same = frequencies[0].size == frequencies[1].size and np.allclose(*frequencies, rtol=1e-12)
    assert same == (name != "P3")


@pytest.mark.parametrize(("name", "side"), [("P1", "upper"), ("P2", "upper"), ("P3", "lower")])
def test_layer_of_inclined_teeth_weighs_what_the_meshed_teeth_weigh(name, side):
    """The rim below is solid up to the line of the roots, and the back of the meshed rim is flat."""
    teeth, body = teeth_of(name), parse(BodySection, DISC | {"teeth": "fitted"})
    design, shape = pair_at(pair(teeth).design, side, "drive"), body_shape(body, teeth, side)
    tooth = gear_tooth(design, MeshSizes(*(size * design.module for size in (0.5, 1.6, 0.9))))
    mesh, _ = hex_mesh(tooth.nodes, tooth.hexes)
    volume = teeth.face_gear_teeth * float(Basis(mesh, ElementHex2(), intorder=5).dx.sum())
    (inner, outer), layer = shape.teeth, shape.layer
    top = [layer.back + layer.rise(r) for r in (inner, outer)]
    rim = mass_properties(np.array([(inner, 0.0), (outer, 0.0), (outer, top[1]), (inner, top[0])]), 1.0)[0]
    assert (volume - rim) / mass_properties(layer.corners, 1.0)[0] == pytest.approx(layer.density, rel=1e-3)
    assert 0.03 < fitted_shape(body, teeth, side).layer.hoop < 0.1  # 0.06 of common teeth
