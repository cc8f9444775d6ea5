"""A mesh of any teeth as a wrench: public numbers, an independent model, balance, mirror images, modes."""

from dataclasses import replace
from math import cos, pi, radians

import numpy as np
import pytest
import scipy.linalg
from free_machines import natural_modes
from lumped_machines import make_layout as make_spur_layout
from lumped_machines import make_machine as make_spur_machine
from public_teeth import NAMES, PARAMETERS, public_design, public_numbers
from wrench_machines import (
    MESH,
    Teeth,
    common_rotation,
    coordinates,
    flank_rows,
    gaps,
    make_layout,
    mirrored,
    random_machine,
    random_teeth,
    solved,
    springs,
)

from facegear.errors import InvalidInput
from facegear.harmonics import Harmonics
from facegear.machine import statics
from facegear.machine.block_statics import static_blocks
from facegear.machine.drive_line import DriveLine, Seat
from facegear.machine.flanks import flank_edges, flank_law
from facegear.machine.imperfections import perfect
from facegear.machine.kinematics import GEOMETRIC, PRINTED_KINEMATICS
from facegear.machine.layout import Body, FaceGear, Pinion, Role, Side, Tilt
from facegear.machine.loaded_modes import loaded_modes
from facegear.machine.machine import Damping, Machine
from facegear.machine.mesh_phases import place_lags
from facegear.machine.shaft_tables import load_table, seat_table
from facegear.machine.statics import bearing_loads, equilibria, mean_equilibrium
from facegear.machine.torques import balanced_torques
from facegear.parts.shafts import CondensedShaft
from facegear.rigid_body import carry_motion
from facegear.teeth.family_contact import contact_line

FLAT = Harmonics(np.zeros(1), np.array([MESH]))
BOTH = Side.LOWER, Side.UPPER
SEEDS = range(30)


def agree(computed, expected, relative=0.0, absolute=0.0):
    np.testing.assert_allclose(computed, expected, rtol=relative, atol=absolute)


def public_teeth(name: str) -> Teeth:
    module, teeth, angles, helix, taper, shaft, offset, middle, *_ = PARAMETERS[name]
    return Teeth(
        pinion=teeth[0],
        gear=teeth[1],
        module=1e-3 * module,
        angles=(radians(angles[0]), radians(angles[1])),
        helix=radians(helix),
        taper=radians(taper),
        shaft=pi / 2 if shaft == 90 else radians(shaft),
        offset=1e-3 * offset,
        middle=1e-3 * middle,
    )


def machine_of(teeth, torques, sides=BOTH, bearing=(1e8, 1e8, 2e8), roles=None, **more):
    """Pinions a quarter turn apart between gears on stiff bearings, every mesh with k = 4e8 N/m."""
    roles = roles or [Role.INPUT] * len(torques)
    pinions = [
        Pinion(f"p{i}", role, float(round(teeth.gear * i / 4)), Body(1.2, 0.002, bearing))
        for i, role in enumerate(roles)
    ]
    gears = [FaceGear(side, Body(8.0, 0.5, (1e16,) * 3)) for side in sides]
    layout = make_layout(teeth, pinions, gears)
    return Machine(
        layout=layout,
        torques=balanced_torques(layout, np.array(torques)),
        stiffness=more.pop("stiffness", FLAT),
        error=Harmonics(np.zeros(1), np.zeros(1)),
        half_backlash=np.full(len(layout.meshes), more.pop("half_backlash", 1e-12)),
        damping=Damping(1000.0, 500.0, 1e-6),
        **more,
    )


@pytest.mark.parametrize("name", NAMES)
def test_forces_and_moments_on_both_bodies_are_those_of_the_public_designs(name):
    teeth = public_teeth(name)
    layout = machine_of(teeth, [500.0], (Side.UPPER,)).layout
    # The gear tilts about the foot of the common perpendicular, to which the public moments refer.
    tilt = Tilt(0.1, 1e6, -layout.tilt_distance(0))
    gear = replace(layout.gears[0], body=replace(layout.gears[0].body, tilt=tilt))
    layout = replace(layout, gears=(gear,))
    rows, numbers = layout.kinematics.flank_rows(layout), public_numbers(name)
    for row, flank in zip(rows, ("drive", "coast"), strict=True):
        on_body = -row * 500.0 / abs(row[3])
        # At angle 0 the mesh frame has its axes along x, -y and -z of the gear.
        agree(
            on_body[4:7] * [1, -1, -1],
            numbers[f"{flank} force on gear at 500 N m, x y z N"],
            relative=1e-9,
            absolute=1e-5,
        )
        agree(
            np.array([on_body[8], -on_body[9], -on_body[7]]),
            numbers[f"{flank} moment on gear about the origin N m"],
            relative=1e-9,
            absolute=1e-6,
        )
        agree(
            np.array([on_body[2], -on_body[1]]),
            numbers[f"{flank} force on pinion along its axis, along u N"],
            relative=1e-9,
            absolute=1e-5,
        )


AXIAL = {
    "P1": (-5915.863888, 0.0),
    "P2": (754.271952, 754.271952),
    "P4": (3215.706994, 0.0),
}
"""Axial force on a pinion with 500 N m in each of two meshes: as it drives both, and as an idler; N."""


@pytest.mark.parametrize("name", AXIAL)
def test_axial_forces_of_helix_and_taper_add_or_cancel_on_inputs_and_idlers(name):
    driving, idling = AXIAL[name]
    teeth = public_teeth(name)
    ratio = teeth.gear / teeth.pinion
    machine = machine_of(teeth, [1000.0])
    machine = replace(machine, torques=np.array([1000.0, -500.0 * ratio, -500.0 * ratio]))
    found = mean_equilibrium(machine)
    force = -bearing_loads(machine.linear, found.displacements)[0, 2]
    agree(-force, driving, relative=1e-9, absolute=1e-6)
    # One idler carries all the torque from the lower gear, which drives, to the upper one.
    idle = machine_of(teeth, [0.0], roles=[Role.IDLER], half_backlash=50e-6)
    torques = np.array([0.0, 500.0 * ratio, -500.0 * ratio])
    idle = replace(idle, torques=torques)
    found = mean_equilibrium(idle)
    force = bearing_loads(idle.linear, found.displacements)[0, 2]
    assert (found.forces[0] < 0.0).sum() == 1
    agree(force, idling, relative=1e-9, absolute=1e-6)


SERIES = {"P1": 8.18004e7, "P4": 8.08322e7, "P3": 8.0e7}


@pytest.mark.parametrize("name", SERIES)
def test_springs_of_bearings_and_mesh_are_in_series_along_the_normal(name):
    machine = machine_of(public_teeth(name), [500.0], (Side.UPPER,))
    moved = mean_equilibrium(machine).displacements[0]
    layout, force = machine.layout, 500.0 / machine.layout.pinion_arm
    along = layout.pinion_arm * moved[3] - layout.gear_arm * moved[7]
    agree(force / along, SERIES[name], relative=1e-6)


FREQUENCIES = {"P1": (1948.9005, 2975.3889), "P4": (2028.8879, 3596.0913)}


@pytest.mark.parametrize("name", FREQUENCIES)
def test_a_helical_pinion_turns_and_floats_at_two_frequencies(name):
    layout = machine_of(public_teeth(name), [500.0], (Side.UPPER,), (1e16, 1e16, 2e8)).layout
    heavy = replace(layout.gears[0], body=Body(1e9, 1e9, (1e22,) * 3))
    modes = natural_modes(replace(layout, gears=(heavy,)), MESH)
    slow = modes.frequencies[modes.frequencies > 10.0][:2]
    agree(slow, np.array(FREQUENCIES[name]), relative=6e-8)


@pytest.mark.parametrize("seed", SEEDS)
def test_random_machines_of_all_teeth_stand_as_an_independent_model(seed):
    machine, teeth = random_machine(np.random.default_rng([54, seed]))
    agree(machine.linear.rows, flank_rows(machine, teeth), absolute=1e-14)
    agree(flank_edges(machine), gaps(machine, teeth), absolute=1e-17)
    agree(machine.linear.stiffness, springs(machine), relative=1e-12, absolute=1e-3)
    found, (moved, forces) = mean_equilibrium(machine), solved(machine, teeth)
    agree(found.flank_forces[0], forces, relative=1e-9, absolute=1e-9 * forces.max())
    rotation, lengths = common_rotation(machine), machine.linear.lengths
    apart = found.displacements[0] - moved
    apart -= rotation * (rotation @ apart) / (rotation @ rotation)
    still = moved - rotation * (rotation @ moved) / (rotation @ rotation)
    assert np.abs(apart * lengths).max() < 1e-9 * np.abs(still * lengths).max()


@pytest.mark.parametrize("seed", SEEDS)
def test_forces_and_moments_of_all_bearings_and_torques_balance_in_space(seed):
    """Meshes are forces inside the machine: what bearings and torques do from outside must vanish."""
    machine, teeth = random_machine(np.random.default_rng([55, seed]), everything_tilts=True)
    found = mean_equilibrium(machine)
    held = -bearing_loads(machine.linear, found.displacements)[0] + machine.linear.loads
    force, moment = outside(machine, teeth, held)
    size = found.flank_forces.max()
    assert np.abs(force).max() < 1e-12 * size
    assert np.abs(moment).max() < 1e-12 * size * teeth.gear_radius


def outside(machine, teeth, loads):
    """Force and moment about the origin, in space, of loads on all coordinates."""
    force, moment = np.zeros(3), np.zeros(3)
    for load, part in zip(loads, coordinates(machine, teeth), strict=True):
        force += load * part.motion
        moment += load * (np.cross(part.centre, part.motion) + part.turn)
    return force, moment


@pytest.mark.parametrize("seed", range(6))
def test_bearings_of_a_shaft_carry_the_forces_and_moments_of_the_meshes_of_its_pinion(seed):
    machine, teeth = random_machine(np.random.default_rng([59, seed]), everything_tilts=True)
    line, found = machine.drive_line, mean_equilibrium(machine)
    table = load_table(machine, line, found).set_index("pinion")
    columns = ["x_n", "y_n", "z_n", "tilt_x_n_m", "tilt_y_n_m"]
    wrenches = -flank_rows(machine, teeth).T @ found.flank_forces[0]
    size = found.flank_forces.max()
    for pinion in line.tilting:
        loads = table.loc[machine.layout.pinions[pinion].name, columns].to_numpy(float)
        # Bearings stand at the beginning and at 120 mm, the pinion at 50 mm.
        carried = sum(load @ carry_motion(at - 0.05) for load, at in zip(loads, (0.0, 0.12), strict=True))
        agree(carried, wrenches[line.motions(pinion)], absolute=1e-9 * size)
        seat = seat_table(machine, line, found).set_index("pinion").loc[machine.layout.pinions[pinion].name]
        moved = 1e-6 * seat[["x_um", "y_um", "z_um", "tilt_x_urad", "tilt_y_urad"]].to_numpy(float)
        agree(moved, found.displacements[0, line.motions(pinion)], absolute=1e-12)


def mirror_shaft(shaft: CondensedShaft) -> CondensedShaft:
    signs = np.array([-1.0, 1.0, 1.0, 1.0, -1.0])
    return replace(
        shaft,
        compliance=shaft.compliance * np.outer(signs, signs),
        reactions=shaft.reactions * np.outer(signs, signs),
    )


def mirror_machine(machine: Machine, teeth: Teeth) -> Machine:
    """The machine in a mirror across x of the gears, at angle 0 across the tangent; torques change sign."""
    layout, errors, other = machine.layout, machine.imperfections, mirrored(teeth)
    pinions = [
        replace(p, pitches=-p.pitches, body=replace(p.body, bearing_xy=-p.body.bearing_xy))
        for p in layout.pinions
    ]
    image = make_layout(other, pinions, layout.gears)
    line = machine.drive_line
    if line is not None:
        seats = {i: Seat(mirror_shaft(s.shaft), s.tilt_inertia) for i, s in line.seats.items()}
        line = DriveLine(image, seats, {})
    arms = [cos(angle) for angle in teeth.angles]
    flaws = replace(
        errors,
        error=-errors.error * arms[1] / arms[0],
        position=errors.position * [-1.0, 1.0],
    )
    return replace(machine, layout=image, torques=-machine.torques, imperfections=flaws, drive_line=line)


@pytest.mark.parametrize("seed", range(10))
def test_the_mirror_image_of_a_machine_stands_as_the_mirror_image_of_its_place(seed):
    machine, teeth = random_machine(np.random.default_rng([56, seed]))
    image = mirror_machine(machine, teeth)
    found, other = mean_equilibrium(machine), mean_equilibrium(image)
    drive, back = np.split(found.flank_forces[0], 2)
    size = found.flank_forces.max()
    agree(other.flank_forces[0], np.append(back, drive), absolute=1e-9 * size)
    bodies = len(machine.layout.bodies)
    signs = np.concatenate([np.tile([-1.0, 1.0, 1.0, -1.0], bodies), np.ones(machine.linear.size)])
    signs = signs[: machine.linear.size]
    signs[4 * bodies + 1 :: 2] = -1.0
    loads = bearing_loads(machine.linear, found.displacements)[0] * signs
    agree(
        bearing_loads(image.linear, other.displacements)[0],
        loads,
        absolute=1e-9 * size,
    )


@pytest.mark.parametrize("seed", range(10))
def test_modes_with_tilts_and_axial_motion_are_those_of_differences_of_the_energy(seed):
    rng = np.random.default_rng([57, seed])
    machine, teeth = random_machine(rng, everything_tilts=True)
    while mean_equilibrium(machine).flank_forces.reshape(2, -1).max(axis=0).min() < 1.0:
        machine, teeth = random_machine(rng, everything_tilts=True)
    moved, _ = solved(machine, teeth)
    rows, stiffness = flank_rows(machine, teeth), springs(machine)
    factors = MESH * np.tile(machine.imperfections.stiffness, 2)
    lengths = machine.linear.lengths

    def slope(at):
        return stiffness @ at + rows.T @ (factors * np.maximum(rows @ at - gaps(machine, teeth), 0.0))

    steps = 1e-9 / lengths
    columns = [
        (slope(moved + step * unit) - slope(moved - step * unit)) / (2.0 * step)
        for step, unit in zip(steps, np.eye(len(moved)), strict=True)
    ]
    tangent = 0.5 * (np.array(columns) + np.array(columns).T)
    pinions, gears = len(machine.layout.pinions), len(machine.layout.gears)
    masses = [1.2, 1.2, 1.2, 0.002] * pinions + [8.0, 8.0, 8.0, 0.5] * gears
    masses += [0.3, 0.3] * gears + [1.5e-3] * 2 * pinions
    exact = scipy.linalg.eigh(tangent, np.diag(masses), eigvals_only=True)
    agree(
        (2.0 * pi * loaded_modes(machine).frequencies) ** 2,
        np.maximum(exact, 0.0),
        relative=1e-6,
        absolute=1e-9 * exact.max(),
    )


SHIFTS = {"P1": 8.4738508, "P4": -4.9746537, "P2": None}


@pytest.mark.parametrize("name", ["P1", "P4"])
def test_a_helical_pinion_that_stands_outwards_meshes_as_one_that_has_turned(name):
    teeth, swing = public_teeth(name), Harmonics(np.array([0.0, 5e7]), np.array([MESH, 3e7]))
    machine = machine_of(teeth, [500.0, 300.0], stiffness=swing)
    flaws = replace(perfect(machine.layout), outwards=np.full(2, 1e-3))
    moved, turned = replace(machine, imperfections=flaws), SHIFTS[name] / 360.0
    agree(place_lags(moved.layout, flaws.outwards), np.full(8, -turned), relative=1e-7)
    cycles = np.array([0.1, 0.37, 0.8])
    laws = flank_law(moved), flank_law(machine)
    compressions = np.full((3, 8), 1e-5)
    agree(
        laws[0].force(cycles, compressions),
        laws[1].force(cycles + turned, compressions),
        relative=1e-6,
    )
    # The turn itself is a motion that both meshes of a pinion on the drive flanks take up alike.
    loads = [equilibria(each, np.array([at])) for each, at in ((moved, 0.3), (machine, 0.3 + turned))]
    agree(*(load.flank_forces for load in loads), relative=1e-6, absolute=1e-3)


def test_taper_makes_backlash_a_function_of_the_place_along_the_axis():
    teeth = public_teeth("P2")
    machine = machine_of(teeth, [500.0], (Side.UPPER,))
    flaws = replace(perfect(machine.layout), outwards=np.full(1, 1e-3))
    more = flank_edges(replace(machine, imperfections=flaws)) - flank_edges(machine)
    arc = 1e6 * more.sum() / cos(teeth.angles[0])
    agree(arc, 65.055955826, relative=1e-9)


@pytest.mark.parametrize("smallness", [1e-4, 1e-6, 1e-8])
def test_rows_of_nearly_spur_teeth_differ_from_spur_rows_in_proportion(smallness):
    spur = make_spur_machine(torque=500.0).layout
    angle = spur.pressure_angle
    teeth = Teeth(
        23, 143, 3.75e-3, (angle, angle + smallness), smallness, smallness, pi / 2 + smallness, smallness
    )
    near = make_layout(teeth, spur.pinions, spur.gears)
    exact = replace(
        spur, kinematics=near.kinematics, gear_radius=3.75e-3 * 143 / 2 * np.cos(angle), kind=None
    )
    apart = near.kinematics.flank_rows(near) - exact.kinematics.flank_rows(exact)
    assert np.abs(apart).max() < 4.0 * smallness


def test_equation_13_as_printed_refuses_teeth_that_are_not_spur_teeth():
    layout = machine_of(public_teeth("P1"), [500.0]).layout
    with pytest.raises(InvalidInput, match=r"mesh_kinematics = 'printed': must be geometric"):
        replace(layout, kinematics=PRINTED_KINEMATICS)


def test_an_arm_of_other_teeth_is_refused():
    layout = machine_of(public_teeth("P1"), [500.0]).layout
    with pytest.raises(InvalidInput, match=r"pinion_radius = 0\.04: must be 0\.0396509"):
        replace(layout, pinion_radius=0.04, gear_radius=0.2)


@pytest.mark.parametrize("seed", range(20))
def test_the_line_of_contact_of_the_whole_design_gives_the_same_wrench(seed):
    """The kind of the teeth alone, without shaper, lands and faces, has the contact line of the pair."""
    teeth = random_teeth(np.random.default_rng([58, seed]))
    kind = replace(teeth, middle=teeth.face).kind
    family = replace(public_design("P1"), rack=kind.rack, pinion_teeth=teeth.pinion, gear_teeth=teeth.gear)
    family = replace(
        family,
        shaper_teeth=teeth.pinion + 2,
        shaft_angle=teeth.shaft,
        offset=teeth.offset,
        middle=teeth.face,
    )
    for side, frame in zip((1, -1), kind.frames(1.0), strict=True):
        line = contact_line(family, side)
        wrench = line.frame(3e-3).wrench()
        x, height, away = frame.gear_point
        point = np.array([x, away, -height - kind.pitch_height(1.0)])
        normal = np.array([frame.gear_normal[0], frame.gear_normal[2], -frame.gear_normal[1]])
        agree(normal, wrench[:3], absolute=1e-14)
        agree(np.cross(point, normal), wrench[3:], absolute=1e-14)


@pytest.mark.parametrize("sides", [BOTH, (Side.UPPER,), (Side.LOWER,)])
@pytest.mark.parametrize("below", [None, 0.0, 0.031])
def test_rows_of_spur_teeth_are_those_of_their_closed_form_bit_for_bit(sides, below):
    """Tangential plus and minus separating part, as written out for spur teeth at right angles."""
    layout = make_spur_layout(sides=sides, kinematics=GEOMETRIC)
    if below is not None:
        tilt = Tilt(0.3, 1e7, below)
        gears = tuple(replace(gear, body=replace(gear.body, tilt=tilt)) for gear in layout.gears)
        layout = replace(layout, gears=gears)
    cosine, sine = np.cos(layout.pressure_angle), np.sin(layout.pressure_angle)
    radius = layout.gear_radius / float(cosine)
    along, apart = np.zeros((2, len(layout.meshes), layout.dof))
    for mesh, (i, g) in enumerate(layout.meshes):
        sign, pinion, gear = layout.gears[g].sign, 4 * i, 4 * (5 + g)
        tangent = np.array([np.cos(layout.angles[i]), np.sin(layout.angles[i])])
        along[mesh, pinion] = sign * cosine
        along[mesh, gear : gear + 2] = -sign * cosine * tangent
        along[mesh, [pinion + 3, gear + 3]] = layout.pinion_radius, -layout.gear_radius
        apart[mesh, [pinion + 1, gear + 2]] = sign * sine, -sign * sine
        if below is not None:
            tilts = slice(layout.first_tilts[g], layout.first_tilts[g] + 2)
            along[mesh, tilts] -= below * cosine * np.array([tangent[1], -tangent[0]])
            apart[mesh, tilts] = sign * sine * radius * tangent
    assert np.array_equal(
        layout.kinematics.flank_rows(layout), np.concatenate([apart + along, apart - along])
    )


@pytest.mark.parametrize("seed", [0, 2, 3, 4, 6, 7])
def test_compiled_statics_of_pinions_pushed_along_their_axes_are_those_of_dense_algebra(seed, monkeypatch):
    with_shafts, _ = random_machine(np.random.default_rng([56, seed]))
    machine = replace(with_shafts, drive_line=None)
    assert machine.linear.rows[:, 2 : 4 * len(machine.layout.pinions) : 4].any()
    cycles = np.array([0.0, 0.37])
    assert static_blocks(machine) is not None
    compiled = equilibria(machine, cycles)
    monkeypatch.setattr(statics, "static_blocks", lambda machine: None)
    dense = equilibria(machine, cycles)
    agree(compiled.flank_forces, dense.flank_forces, absolute=1e-9 * dense.flank_forces.max())
    agree(
        bearing_loads(machine.linear, compiled.displacements),
        bearing_loads(machine.linear, dense.displacements),
        absolute=1e-9 * dense.flank_forces.max() * machine.linear.lengths.max(initial=1.0),
    )
