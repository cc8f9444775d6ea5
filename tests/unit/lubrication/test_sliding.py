"""Sliding speed of flanks: differences of material points, the instant axis, closed forms."""

from dataclasses import replace
from math import pi, sqrt

import numpy as np
import pytest
from contact_bodies import pair_design
from hypothesis import given, settings
from hypothesis import strategies as st
from references import against, agrees
from spur_path import c40

from facegear.contact.lines import contact_lines
from facegear.lubrication.kinematics import line_kinematics, pinion_pose, slip, spins, surface_normals
from facegear.teeth.design import AssemblyErrors
from facegear.teeth.placement import body_rotation, pinion_to_gear
from facegear.teeth.surfaces import fillet_points, flank_points
from facegear.teeth.unloaded_contact import unloaded_contact

PAIR = pair_design()
RATIO = 23 / 143
places = st.tuples(st.floats(-0.01, 0.01), st.floats(0.25, 0.275), st.floats(-0.05, -0.03))


@against(
    "second implementation",
    "differences of points that turn with their body",
    capability="lubrication",
    module="facegear.lubrication.kinematics",
)
@settings(max_examples=25)
@given(places, st.floats(-0.1, 0.1), st.floats(-3e-4, 3e-4), st.floats(-3e-3, 3e-3), st.floats(-2e-4, 2e-4))
def test_velocities_are_those_of_material_points_in_any_assembly(place, phi1, offset, tilt, shift):
    design = replace(PAIR, assembly=AssemblyErrors(offset, tilt, shift))
    point, step = np.array([place]), 1e-5
    moves = []
    for turn in (step, -step):
        phi = phi1 + turn
        inside = pinion_pose(design, phi1, 0).inverse().points(point)
        pinion = pinion_pose(design, phi, 0).points(inside)
        on_gear = point @ body_rotation("face_gear", RATIO * phi1)
        moves.append((pinion, on_gear @ body_rotation("face_gear", RATIO * phi).T))
    by_difference = [(after - before) / (2 * step) for after, before in zip(*moves, strict=True)]
    for spin, expected in zip(spins(design), by_difference, strict=True):
        agrees("velocity, m/s", spin.velocity(point), expected, absolute=1e-8)


def test_the_pinion_stands_in_the_mesh_frame_as_the_geometry_places_it_on_the_gear():
    design = replace(PAIR, assembly=AssemblyErrors(1e-4, 1e-3, 5e-5))
    point = np.array([[0.003, 0.26, -0.044]])
    gear = pinion_to_gear(design, 0.03, 0.005, 1)
    back = pinion_pose(design, 0.03, 1).then(body_rotation("face_gear", -(0.005 + 2 * pi / 143)))
    assert back.points(point) == pytest.approx(gear.points(point), abs=1e-15)


@against(
    "analytic",
    "instant axis of two turning bodies",
    capability="lubrication",
    module="facegear.lubrication.kinematics",
)
@given(places)
def test_relative_velocity_grows_with_the_distance_from_the_instant_axis(place):
    first, second = spins(PAIR)
    velocity = first.velocity(np.array(place)) - second.velocity(np.array(place))
    axis = np.array([0.0, 1.0, -RATIO]) / sqrt(1 + RATIO**2)
    distance = np.linalg.norm(np.cross(np.array(place), axis))
    agrees(
        "relative velocity, m/s",
        np.linalg.norm(velocity),
        sqrt(1 + RATIO**2) * distance,
        relative=1e-9,
        absolute=1e-15,
    )
    on_axis = place[1] * np.array([0.0, 1.0, -RATIO])
    agrees(
        "relative velocity on the axis, m/s",
        np.linalg.norm(first.velocity(on_axis) - second.velocity(on_axis)),
        0.0,
        absolute=1e-16,
    )


@against(
    "analytic",
    "sliding of a line contact in closed form",
    capability="lubrication",
    module="facegear.lubrication.kinematics",
)
def test_line_contact_pair_slides_as_its_closed_form_says():
    design = pair_design(shaper_teeth=23)
    position = np.array([0.1, 0.4, 0.8])
    phi1 = (position - 0.5) * 2 * pi / 23
    tooth, y = np.zeros(3), np.linspace(0.255, 0.27, 5)
    lines = contact_lines(design, phi1, unloaded_contact(design, phi1).phi2, tooth, y)
    found = line_kinematics(design, lines, position, tooth)
    on = np.isfinite(lines.slope) & (lines.to_gear_tip > 1e-4) & (lines.roll > 1.01 * lines.roll.min())
    assert on.sum() >= 8
    cosine = design.pinion_base_radius / (RATIO * y)
    s = design.pinion_base_radius * (lines.roll - np.sqrt(1 / cosine**2 - 1))
    c, k = np.cos(lines.slope), np.sin(lines.slope)
    rho = design.pinion_base_radius * lines.roll
    exact = {
        "sliding": np.abs(s) * np.sqrt(1 + (RATIO * cosine) ** 2),
        "across": s * (c - RATIO * cosine * k),
        "along": s * (RATIO * cosine * c + k),
        "u1": rho * c,
        "u2": rho * c - s * (c - RATIO * cosine * k),
        "line_entrainment": rho * k - 0.5 * s * (RATIO * cosine * c + k),
    }
    for name, expected in exact.items():
        agrees(
            "velocities of the contact, m/s",
            getattr(found, name)[on],
            expected[on],
            absolute=1e-5 * np.abs(s).max(),
        )
    assert (lines.slope[on] < 0).all()


@against(
    "analytic",
    "sliding of spur gears",
    capability="lubrication",
    module="facegear.lubrication.kinematics",
)
def test_spur_gears_slide_in_proportion_to_the_distance_from_the_pitch_point_and_roll_there():
    path, speed = c40(), 188.5
    g = np.linspace(-8e-3, 8e-3, 9)
    velocity, closing = slip(*path.spins(speed), *path.points(g))
    ratio = path.base[0] / path.base[1]
    tangent = np.array([np.sin(path.angle), 0.0, np.cos(path.angle)])
    agrees("sliding along the tangent, m/s", velocity @ tangent, speed * g * (1 + ratio), absolute=1e-12)
    agrees(
        "sliding speed, m/s",
        np.linalg.norm(velocity, axis=1),
        np.abs(speed * g * (1 + ratio)),
        absolute=1e-12,
    )
    assert np.linalg.norm(velocity[4]) < 1e-13 and np.abs(closing).max() < 1e-13


def test_normals_of_stored_points_are_those_of_the_surface_with_relief_and_in_the_fillet():
    pinion = replace(
        PAIR.pinion, thinning=1e-4, tip_relief=replace(PAIR.pinion.tip_relief, amount=2e-5, length=3e-3)
    )
    design = replace(PAIR, pinion=pinion)
    flank = flank_points(design, np.linspace(0.25, design.pinion_tip_roll, 40), 0.26)
    assert surface_normals(design, flank.position) == pytest.approx(flank.normal, abs=1e-12)
    fillet = fillet_points(design, np.linspace(design.pressure_angle, 0.5 * pi - 0.1, 40), 0.26)
    assert surface_normals(design, fillet.position) == pytest.approx(fillet.normal, abs=1e-5)
