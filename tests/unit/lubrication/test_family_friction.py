"""Friction of teeth of the whole family: sliding of the public designs, power, wrenches, mirror image."""

from dataclasses import replace
from math import cos, radians, sin

import numpy as np
import pytest
from family_pairs import public_pair
from public_teeth import ERRORS, NAMES, public_numbers

from facegear.lubrication.assessment import friction_ratios
from facegear.lubrication.kinematics import slip, spins
from facegear.lubrication.loss import HatSlip, loss_factors
from facegear.teeth.bounded_contact import contact_path
from facegear.teeth.family_contact import contact_line
from facegear.teeth.placement import FLANKS, GEARS, mirror_design, pair_at

FRICTION = 0.06
PUBLIC_FLANKS = {"drive": "drive", "back": "coast"}


def path_of(design):
    """Return points and normal of the nominal line of contact of the drive flank, first to last."""
    line = contact_line(design.family, 1)
    path = contact_path(design.family, line)
    s = np.linspace(path.first, path.last, 9)
    return line.point(s), np.broadcast_to(line.normal, (9, 3))


def near_pitch_line(design):
    """Return points and normal of the nominal line of contact of the drive flank, on both sides of the pitch
    line.
    """
    line = contact_line(design.family, 1)
    up = design.family.motion.basis[2]
    middle = (-design.family.pinion_pitch_radius - up @ line.foot) / (up @ line.normal)
    s = middle + np.linspace(-8e-3, 7e-3, 9)
    return line.point(s), np.broadcast_to(line.normal, (9, 3))


def hats_on(design, points, normals, seed=5):
    """Return loaded hats with random forces at points, in three positions of a pitch."""
    force = np.random.default_rng(seed).uniform(10.0, 300.0, len(points))
    velocity, closing = slip(*spins(design), points, normals)
    torque = design.normal_arm * force.reshape(3, -1).sum(axis=1).mean()
    return HatSlip(
        torque=np.full(len(points), torque),
        position=np.repeat([0.0, 0.25, 0.5], len(points) // 3),
        tooth=np.zeros(len(points), dtype=int),
        plane=np.zeros(len(points), dtype=int),
        force=force,
        point=points,
        normal=normals,
        velocity=velocity,
        normal_velocity=closing,
    )


@pytest.mark.parametrize("flank", FLANKS)
@pytest.mark.parametrize("name", NAMES)
def test_sliding_is_the_public_one_from_first_to_last_contact(name, flank):
    design = pair_at(public_pair(name), "upper", flank)
    points, normals = path_of(design)
    sliding, closing = slip(*spins(design), points, normals)
    expected = public_numbers(name)[
        f"{PUBLIC_FLANKS[flank]} sliding first, middle, last mm per rad of pinion"
    ]
    np.testing.assert_allclose(1e3 * np.linalg.norm(sliding, axis=1)[[0, 4, 8]], expected, rtol=1e-9)
    assert np.abs(closing).max() < 1e-15


@pytest.mark.parametrize("errors", [None, ERRORS])
@pytest.mark.parametrize("flank", FLANKS)
@pytest.mark.parametrize("gear", GEARS)
@pytest.mark.parametrize("name", NAMES)
def test_power_into_both_shafts_is_friction_times_sliding(name, gear, flank, errors):
    """Shafts turn about the axes of their shaft angle and offset, written out once more."""
    design = public_pair(name)
    if errors is not None:
        design = replace(design, assembly=errors)
    design = pair_at(design, gear, flank)
    points, normals = near_pitch_line(design)
    hats = hats_on(design, points, normals)
    ratios = friction_ratios(design, hats, np.full(len(points), FRICTION))
    lean, ratio = (
        design.shaft_angle + design.assembly.shaft_angle_error,
        design.pinion.teeth / design.face_gear.teeth,
    )
    axis = np.array([0.0, sin(lean), -cos(lean)])
    nominal = np.array([0.0, sin(design.shaft_angle), -cos(design.shaft_angle)])
    moves = design.assembly
    middle = np.array([design.offset + moves.offset, 0.0, moves.gear_axial]) + design.middle * nominal
    middle = middle + moves.pinion_axial * axis
    seen = np.cross(-axis, points - middle) - np.cross([0.0, 0.0, -ratio], points)
    seen -= np.einsum("mi,mi->m", seen, normals)[:, None] * normals
    lost = FRICTION * hats.force * np.linalg.norm(seen, axis=1)
    mesh_force = hats.torque[0] / design.normal_arm
    power = -mesh_force * (ratios[:, 3] + ratio * ratios[:, 4])
    np.testing.assert_allclose(power, lost.reshape(3, -1).sum(axis=1), rtol=1e-12)
    factors = loss_factors(hats)
    np.testing.assert_allclose(power, FRICTION * factors.at[0] * hats.torque[0], rtol=1e-12)


@pytest.mark.parametrize("name", NAMES)
def test_ratios_are_one_wrench_on_the_pinion_and_the_opposite_on_the_gear(name):
    design = public_pair(name)
    points, normals = near_pitch_line(design)
    hats = hats_on(design, points, normals)
    ratios = friction_ratios(design, hats, np.full(len(points), FRICTION))
    gamma = design.shaft_angle
    x, a, u = np.array([[1, 0, 0], [0, sin(gamma), -cos(gamma)], [0, cos(gamma), sin(gamma)]])
    middle = design.offset * x + design.middle * a
    direction = -hats.velocity / np.linalg.norm(hats.velocity, axis=1)[:, None]
    force = FRICTION * hats.force[:, None] * direction
    for row, on in enumerate(np.split(np.arange(len(points)), 3)):
        total = force[on].sum(axis=0)
        moment = np.cross(points[on] - middle, force[on]).sum(axis=0)
        on_gear = -np.cross(points[on], force[on]).sum(axis=0)
        expected = [total @ x, total @ a, -total[2], -moment @ a, -on_gear[2], moment @ x, -moment @ u]
        found = ratios[row] * hats.torque[0] / design.normal_arm
        np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-13 * np.abs(force).sum())


@pytest.mark.parametrize("name", NAMES)
def test_the_mirror_image_that_turns_the_other_way_rubs_as_its_signs_say(name):
    """Trap 1: the coast flank of a pair is the drive flank of the pair of the other hand."""
    design = replace(public_pair(name), assembly=ERRORS)
    points, normals = near_pitch_line(design)
    flip = np.array([-1.0, 1.0, 1.0])
    hats, seen = (
        hats_on(design, points, normals),
        hats_on(mirror_design(design), points * flip, normals * flip),
    )
    friction = np.full(len(points), FRICTION)
    power, mirrored = (loss_factors(one).at * one.torque[0] for one in (hats, seen))
    np.testing.assert_allclose(mirrored, power, rtol=1e-12)
    # force and moments in N and N m: both flanks of P3 have arms of their own
    drive, back = (
        friction_ratios(one, loads, friction) * loads.torque[0] / one.normal_arm
        for one, loads in ((design, hats), (mirror_design(design), seen))
    )
    signs = np.array([1.0, -1.0, -1.0, 1.0, 1.0, -1.0, 1.0])
    np.testing.assert_allclose(back, drive * signs, atol=1e-12 * np.abs(drive).max())


def test_spur_teeth_keep_their_five_ratios():
    design = replace(
        public_pair("P2"), taper_angle=0.0, pinion=replace(public_pair("P2").pinion, middle=None)
    )
    assert design.is_spur
    points, normals = near_pitch_line(public_pair("P2"))
    hats = hats_on(design, points, normals)
    assert friction_ratios(design, hats, np.full(len(points), FRICTION)).shape == (3, 5)


@pytest.mark.parametrize("degrees", [1e-4, 1e-6, 1e-8])
def test_ratios_of_a_small_helix_are_those_of_spur_teeth_in_proportion(degrees):
    base = replace(public_pair("P2"), taper_angle=0.0, pinion=replace(public_pair("P2").pinion, middle=None))
    points, normals = near_pitch_line(base)
    friction = np.full(len(points), FRICTION)
    spur = friction_ratios(base, hats_on(base, points, normals), friction)
    leaning = replace(base, helix_angle=radians(degrees))
    found = friction_ratios(leaning, hats_on(leaning, points, normals), friction)
    np.testing.assert_allclose(found[:, :5], spur, atol=2.0 * radians(degrees) + 1e-15)
