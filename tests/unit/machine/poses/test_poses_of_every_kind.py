"""Poses of helical, tapered, offset and asymmetric teeth: moved bodies, first order, a machine's own rows."""

from dataclasses import replace

import numpy as np
import pytest
from family_pairs import public_pair, random_pairs
from moved_bodies import MovedBodies
from references import against, agrees
from wrench_machines import random_shaft

from facegear.build.tooth_numbers import ToothNumbers
from facegear.machine.drive_line import DriveLine, Seat
from facegear.machine.kinematics import GEOMETRIC
from facegear.machine.layout import Body, FaceGear, Layout, Pinion, Role, Side, Tilt
from facegear.machine.linear_model import lumped_model
from facegear.machine.poses.displaced_pair import Displacement, MeshPlace, displaced_flanks
from facegear.machine.poses.mesh_poses import mesh_poses
from facegear.teeth.conjugate import PairNumbers, contact_at, exact_contact
from facegear.teeth.design import AssemblyErrors
from facegear.teeth.pitch_line import path_middles
from facegear.teeth.placement import FLANKS, GEARS, mirror_design, pair_at

SIDES = {"drive": 1, "back": -1}
AZIMUTH, TILT_HEIGHT = 0.7, 0.05
STILL = (np.zeros(3), np.zeros(3))
NAMES = ("P1", "P2", "P3", "P4", "P3 at 92 deg", "P4 at 5 mm")


def pair_of(name):
    """Return a public pair, or one whose lower gear has teeth, too."""
    pair = public_pair(name[:2])
    if name.endswith("deg"):
        return replace(pair, shaft_angle=np.radians(92.0))
    return replace(pair, offset=5e-3) if name.endswith("mm") else pair


def gears_of(pair):
    """Return the gears on whose face the unloaded path of both flanks lies."""
    return [gear for gear in GEARS if all(exact_contact(pair_at(pair, gear, flank)) for flank in FLANKS)]


def random_motion(seed):
    """Return shifts up to 40 um and turns up to 1e-4 rad of both bodies."""
    rng = np.random.default_rng(seed)
    return [(rng.uniform(-4e-5, 4e-5, 3), rng.uniform(-1e-4, 1e-4, 3)) for _ in range(2)]


def displaced(pair, gear, moved):
    """Return the flanks of a pair whose bodies are moved."""
    bodies = [Displacement(tuple(shift), tuple(turn)) for shift, turn in moved]
    return displaced_flanks(pair, MeshPlace(gear, AZIMUTH, TILT_HEIGHT), *bodies)


def assert_moved_bodies_agree(pair, gears, seed):
    """Compare approach and path of both flanks with contact of bodies that are moved as a whole."""
    for gear in gears:
        moved = random_motion(seed)
        bodies, found = MovedBodies(pair, gear, AZIMUTH, TILT_HEIGHT), displaced(pair, gear, moved)
        for flank, side in SIDES.items():
            assert np.isfinite(found[flank].slope)
            at_rest, (turned, path) = bodies.contact(side, STILL, STILL)[0], bodies.contact(side, *moved)
            agrees(f"approach at the {gear} gear, m", found[flank].approach, turned - at_rest, absolute=1e-12)
            agrees(
                f"path at the {gear} gear, m", found[flank].path - found[flank].outward, path, absolute=1e-8
            )


@against(
    "second implementation",
    "both bodies moved rigidly in the machine's frame, tooth contact analysis on them",
    capability="displaced_contact",
    module="facegear.machine.poses.displaced_pair",
)
@pytest.mark.parametrize("name", NAMES)
def test_bodies_moved_as_a_whole_meet_and_close_as_their_pose_says(name):
    pair = pair_of(name)
    gears = gears_of(pair)
    assert gears == list(GEARS) or name in ("P3", "P4")
    assert_moved_bodies_agree(pair, gears, NAMES.index(name))


@against(
    "second implementation",
    "both bodies moved rigidly in the machine's frame, tooth contact analysis on them",
    capability="displaced_contact",
    module="facegear.machine.poses.displaced_pair",
)
def test_bodies_of_random_pairs_moved_as_a_whole_meet_as_their_pose_says():
    checked = 0
    for seed, pair in enumerate(random_pairs(18)):
        gears = [
            gear
            for gear in gears_of(pair)
            if np.isfinite([part.slope for part in displaced(pair, gear, random_motion(seed)).values()]).all()
        ]
        assert_moved_bodies_agree(pair, gears, seed)
        checked += len(gears)
    assert checked >= 6


@pytest.mark.parametrize("name", ["P1", "P2", "P4 at 5 mm"])
def test_a_shift_along_the_pinion_closes_by_the_sine_of_the_base_helix(name):
    """Exactly for any size, beside the shift that the config sets."""
    pair = replace(pair_of(name), assembly=AssemblyErrors(30e-6, 0.0, -20e-6, 50e-6))
    moved = displaced(pair, "upper", [(np.array([0.0, 0.0, 200e-6]), np.zeros(3)), STILL])
    still = displaced(pair, "upper", [STILL, STILL])
    for flank, helicoid in zip(FLANKS, pair.family.pinion_flanks, strict=True):
        found = moved[flank]
        assert found.outward == pytest.approx(250e-6, abs=1e-15)
        assert found.design.assembly.pinion_axial == found.outward
        assert found.approach == pytest.approx(helicoid.sine * 200e-6, abs=1e-15)
        assert found.path == pytest.approx(still[flank].path, abs=1e-15)
        assert found.slope == pytest.approx(still[flank].slope, abs=1e-13)


@pytest.mark.parametrize("name", NAMES)
def test_the_path_of_a_pose_is_where_the_normal_passes_the_pitch_line(name):
    pair = pair_of(name)
    for design, middle in zip((pair, mirror_design(pair)), path_middles(pair.family), strict=True):
        contact = contact_at(PairNumbers.of_design(design), AssemblyErrors())
        assert contact.path == pytest.approx(middle, abs=1e-12)


def layout_of(pair):
    """Return the layout of one pinion between two gears that tilt."""
    numbers, tilt = ToothNumbers.of_design(pair), Tilt(0.3, 1e7, 0.005)
    gear = Body(8.0, 0.4, (1e9, 1e9, 1e9), 0.0, tilt)
    return Layout(
        pinions=(Pinion("one", Role.INPUT, 11.3, Body(1.0, 0.002, (1e8, 1e8, 1e8))),),
        gears=(FaceGear(Side.LOWER, gear), FaceGear(Side.UPPER, gear)),
        pinion_teeth=numbers.pinion_teeth,
        gear_teeth=numbers.gear_teeth,
        pressure_angle=numbers.pressure_angle,
        pinion_radius=numbers.pinion_arm,
        gear_radius=numbers.pinion_arm * numbers.gear_teeth / numbers.pinion_teeth,
        kinematics=GEOMETRIC,
        kind=numbers.kind,
    )


def tilting_model(layout):
    """Return the linear model of a layout whose pinion tilts, as on a shaft."""
    return DriveLine(layout, {0: Seat(random_shaft(np.random.default_rng(1)), 1e-3)}, {})(
        lumped_model(layout)
    )


def coordinates_of(model, moved):
    """Return displacements (n,) by one motion of the pinion and one of both gears."""
    displacements = np.zeros(model.size)
    for name, (shift, turn) in (
        ("one", moved[0]),
        ("lower face gear", moved[1]),
        ("upper face gear", moved[1]),
    ):
        parts = dict(zip(("x", "y", "z", "tilt_x", "tilt_y", "theta"), (*shift, *turn), strict=True))
        for letter, value in parts.items():
            displacements[model.labels.index(f"{name}:{letter}")] = value
    return displacements


def poses_of(pair, layout, moved):
    """Return the displaced flanks of the meshes of `layout`, by gear."""
    bodies = [Displacement(tuple(shift), tuple(turn)) for shift, turn in moved]
    return [
        displaced_flanks(pair, MeshPlace(gear.side.value, layout.angles[0], layout.tilt_distance(g)), *bodies)
        for g, gear in enumerate(layout.gears)
    ]


@pytest.mark.parametrize("name", ["P1", "P2", "P3 at 92 deg", "P4 at 5 mm"])
def test_deflections_of_moved_bodies_are_those_of_the_machine_s_own_flanks(name):
    pair, moved = pair_of(name), random_motion(11)
    layout = layout_of(pair)
    model = tilting_model(layout)
    found = [part[flank].deflection for flank in FLANKS for part in poses_of(pair, layout, moved)]
    assert found == pytest.approx((model.rows @ coordinates_of(model, moved)).tolist(), rel=1e-9, abs=1e-15)


@pytest.mark.parametrize("name", ["P1", "P2", "P3 at 92 deg", "P4 at 5 mm"])
def test_the_first_order_of_poses_errs_four_times_less_for_half_the_motion(name):
    pair, misses = pair_of(name), []
    layout = layout_of(pair)
    model = tilting_model(layout)
    for size in (1.0, 0.5, 0.25):
        moved = [(size * shift, size * turn) for shift, turn in random_motion(5)]
        linear = mesh_poses(model, layout, pair.middle, coordinates_of(model, moved))
        for mesh, flanks in enumerate(poses_of(pair, layout, moved)):
            exact, first = flanks["drive"].design.assembly, linear.errors(mesh)
            parts = exact.offset, exact.gear_axial, 0.1 * exact.shaft_angle_error, exact.pinion_axial
            known = first.offset, first.gear_axial, 0.1 * first.shaft_angle_error, linear.outward[mesh]
            misses.append(np.abs(np.array(parts) - known).max())
            assert linear.errors(mesh, back=True) == replace(first, offset=-first.offset)
    whole, half, quarter = np.array(misses).reshape(3, 2).max(axis=1)
    assert whole < 1e-7
    assert (whole / half, half / quarter) == pytest.approx((4.0, 4.0), rel=2e-2)


WAYS = {
    "helix": lambda pair, size: replace(pair, helix_angle=size),
    "taper": lambda pair, size: replace(pair, taper_angle=size),
    "shaft angle": lambda pair, size: replace(pair, shaft_angle=pair.shaft_angle + size),
    "offset": lambda pair, size: replace(pair, offset=0.1 * size),
    "coast flank": lambda pair, size: replace(pair, coast_pressure_angle=pair.pressure_angle + size),
}
"""Teeth that are almost spur teeth, by the way in which they are not."""


@pytest.mark.parametrize("way", WAYS)
def test_poses_of_teeth_that_are_almost_spur_differ_from_those_of_spur_teeth_in_proportion(way):
    spur = replace(public_pair("P2"), taper_angle=0.0)
    assert spur.is_spur
    found = []
    for size in (0.0, 1e-8, 1e-6, 1e-4):
        pair = WAYS[way](spur, size) if size else spur
        parts = [displaced(pair, gear, random_motion(3))[flank] for gear in GEARS for flank in FLANKS]
        found.append(
            [(one.approach, one.deflection, one.path, one.to_inner_end, 0.1 * one.slope) for one in parts]
        )
    smallest, small, large = (np.abs(np.array(values) - found[0]).max() for values in found[1:])
    assert large < 1e-4 * 0.3 and large / small == pytest.approx(100.0, rel=0.05)
    assert smallest < 1.1e-4 * large + 1e-14
