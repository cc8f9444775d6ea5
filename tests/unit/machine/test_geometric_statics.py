"""Static load sharing of geometric meshes against closed forms, enumeration and the balance of forces."""

import itertools
from dataclasses import replace

import numpy as np
import pytest
from free_machines import rigid_rotation
from hypothesis import given, settings
from hypothesis import strategies as st
from lumped_machines import make_layout, make_machine
from references import against, agrees

from facegear.errors import NotConverged
from facegear.harmonics import Harmonics
from facegear.machine.block_statics import Springs, settle_all, static_blocks
from facegear.machine.flanks import flank_edges
from facegear.machine.imperfections import Runout, perfect
from facegear.machine.kinematics import GEOMETRIC
from facegear.machine.layout import Body, Role, Side, Tilt
from facegear.machine.linear_model import bearing_matrix, flank_jacobian
from facegear.machine.statics import (
    TOLERANCE,
    bearing_forces,
    equilibria,
    mean_equilibrium,
    static_equilibrium,
)
from facegear.meshing.linear import linear_law

K = 4.1e8
FLAT = Harmonics(np.zeros(1), np.array([K]))
COSINE = np.cos(np.radians(25.0))
SINE = np.sin(np.radians(25.0))
HELD = 1e22


def layout_with(bearings, roles, sides=(Side.LOWER, Side.UPPER), gear_bearing=HELD, coupled=0.0):
    """Pinions with bearings of their own, 45 pitches apart."""
    places = tuple((f"p{i}", role, 45.0 * i) for i, role in enumerate(roles))
    layout = make_layout(places, sides, 1.0, gear_bearing, GEOMETRIC)
    pinions = tuple(
        replace(pinion, body=Body(1.2, 0.002, (k, k, 0.0), coupled * k))
        for pinion, k in zip(layout.pinions, bearings, strict=True)
    )
    return replace(layout, pinions=pinions)


def machine_with(layout, torque=800.0, tail_share=0.0, backlash=100e-6, **errors):
    flaws = replace(perfect(layout), **{name: np.asarray(value) for name, value in errors.items()})
    options = {"tail_share": tail_share, "stiffness": FLAT, "error": 0.0, "imperfections": flaws}
    return make_machine(layout, torque, backlash=backlash, **options)


def held_forces(machine):
    """Mesh forces (meshes,) of flanks drive - back with both face gears held against turning."""
    springs = static_blocks(machine).springs
    core = np.arange(springs.loads.size - 3 * len(machine.layout.pinions))
    springs = springs._replace(core_row=core, core_column=core, core_value=np.full(core.size, HELD))
    gaps = (flank_edges(machine))[None]
    law = linear_law(gaps.size * [FLAT])
    start = np.zeros(springs.loads.size)
    _, forces, residual = settle_all(springs, law.statics_law(np.zeros(1)), gaps, TOLERANCE, start)
    assert residual[0] < 1e-12
    drive, back = np.split(forces[0], 2)
    return drive - back


@against(
    "analytic",
    "load sharing of a floating input in closed form",
    capability="hunting load_sharing_reference",
    module="facegear.machine.statics",
)
@pytest.mark.parametrize("bearing", 10.0 ** np.arange(5, 13))
@pytest.mark.parametrize("misfit", [12e-6, -7e-6])
def test_a_floating_input_between_held_gears_shares_as_the_closed_form_says(bearing, misfit):
    layout = layout_with([bearing], [Role.INPUT])
    forces = held_forces(machine_with(layout, error=[misfit, 0.0]))
    exact = K * misfit / (1.0 + 2.0 * K / bearing)
    total = 800.0 / layout.pinion_arm
    agrees(
        "difference of an input's mesh forces, N",
        forces[1] - forces[0],
        exact,
        relative=1e-10,
        absolute=1e-10 * total,
    )
    agrees("sum of an input's mesh forces, N", forces.sum(), total, relative=1e-12)


@against(
    "analytic",
    "load sharing of a floating input in closed form",
    capability="hunting load_sharing_reference",
    module="facegear.machine.statics",
)
def test_both_limits_of_an_inputs_bearing():
    layout = layout_with([1e-6], [Role.INPUT])
    floating = held_forces(machine_with(layout, error=[10e-6, 0.0]))
    agrees(
        "difference of the mesh forces on a soft bearing, N", floating[1] - floating[0], 0.0, absolute=1e-6
    )
    fixed = held_forces(machine_with(layout_with([1e20], [Role.INPUT]), error=[10e-6, 0.0]))
    agrees(
        "difference of the mesh forces on a stiff bearing, N", fixed[1] - fixed[0], K * 10e-6, relative=1e-10
    )


LOOPS = [(k_in, 1e11) for k_in in 10.0 ** np.arange(5, 13)]
LOOPS += [(3e7, k_id) for k_id in 2.0 * 10.0 ** np.arange(9, 16)]


@against(
    "analytic",
    "loop of input, idler and both gears in closed form",
    capability="hunting load_sharing_reference",
    module="facegear.machine.statics",
)
@pytest.mark.parametrize(("k_in", "k_id"), LOOPS)
def test_the_loop_through_the_idlers_loads_the_upper_mesh_as_the_closed_form_says(k_in, k_id):
    machine = machine_with(layout_with([k_in, k_id], [Role.INPUT, Role.IDLER]), 4000.0)
    found = mean_equilibrium(machine)
    # The idler works on its back flank below and on its drive flank above; nothing else touches.
    loaded = found.flank_forces[0] > 0.0
    np.testing.assert_array_equal(loaded, [True, False, True, True, False, True, False, False])
    lower_in, lower_idler, upper_in, upper_idler = found.forces[0]
    loop = 2.0 * upper_idler + 100e-6 * K + 4.0 * upper_idler * K * COSINE**2 / k_id
    exact = loop / (1.0 + 2.0 * K / k_in)
    agrees(
        "difference of an input's mesh forces, N",
        upper_in - lower_in,
        exact,
        relative=1e-10,
        absolute=1e-10 * upper_in,
    )
    agrees("mesh forces of an idler, N", lower_idler, -upper_idler, relative=1e-10)


@against(
    "analytic",
    "balance of forces of a pinion between two gears",
    capability="hunting load_sharing_reference",
    module="facegear.machine.statics",
)
def test_an_input_leaves_its_bearing_alone_and_an_idler_pulls_it_with_twice_the_tangential_force():
    machine = machine_with(layout_with([1e3, 1e10], [Role.INPUT, Role.IDLER]), 2000.0, backlash=0.0)
    found = mean_equilibrium(machine)
    reaction = bearing_forces(machine, found)[0]
    idler = found.forces[0, 3]
    agrees("bearing force of an input, N", reaction[0], 0.0, absolute=1e-3 * idler)
    agrees(
        "bearing force of an idler, N",
        -reaction[1],
        [2.0 * idler * COSINE, 0.0, 0.0],
        relative=1e-7,
        absolute=1e-7 * idler,
    )


@against(
    "analytic",
    "base radius and tooth ratio",
    capability="hunting load_sharing_reference ratings",
    module="facegear.machine.statics",
)
def test_one_torque_is_one_mesh_force_over_the_base_radius_and_ratios_are_the_teeths():
    layout = make_layout((("one", Role.INPUT, 0.0),), (Side.UPPER,), kinematics=GEOMETRIC, pinion_bearing=1e8)
    machine = machine_with(layout, 664.0)
    base_radius = 3.75e-3 * 23 / 2 * COSINE
    agrees("mesh force, N", mean_equilibrium(machine).forces[0, 0], 664.0 / base_radius, relative=1e-12)
    agrees("ratio of torques", -machine.torques[1] / machine.torques[0], 143 / 23, relative=1e-12)
    turn = rigid_rotation(layout)
    agrees("ratio of speeds", turn[3] / turn[7], 143 / 23, relative=1e-12)


@against(
    "analytic",
    "springs of both flanks and of the bearing in closed form",
    capability="hunting load_sharing_reference",
    module="facegear.machine.statics",
)
def test_a_squeezed_pinion_wedges_with_both_flanks_loaded():
    bearing, pushed, half = 2e8, 180e-6, 50e-6
    machine = machine_with(layout_with([bearing], [Role.INPUT]), 0.0, position=[[0.0, pushed]])
    found = mean_equilibrium(machine)
    lower_drive, upper_drive, lower_back, upper_back = found.flank_forces[0]
    gives = -2.0 * K * SINE * (pushed * SINE - half) / (bearing + 2.0 * K * SINE**2)
    each = K * ((pushed + gives) * SINE - half)
    assert each > 1000.0
    agrees("force on both flanks, N", [upper_drive, upper_back], each, relative=1e-10)
    assert lower_drive == lower_back == 0.0
    agrees("net mesh force, N", found.forces, 0.0, absolute=1e-9 * each)


def random_machine(draw, most_pinions):
    count = draw(st.integers(1, most_pinions))
    sides = draw(st.sampled_from([(Side.LOWER, Side.UPPER), (Side.UPPER,)]))
    bearings = [10.0 ** draw(st.floats(5, 11)) for _ in range(count)]
    roles = [Role.INPUT, *(draw(st.sampled_from(list(Role))) for _ in range(count - 1))]
    layout = layout_with(bearings, roles, sides, 10.0 ** draw(st.floats(7, 11)), draw(st.floats(-0.9, 0.9)))
    if draw(st.booleans()):
        tilt = Tilt(0.3, 10.0 ** draw(st.floats(5, 9)))
        rocking = replace(layout.gears[0], body=replace(layout.gears[0].body, tilt=tilt))
        layout = replace(layout, gears=(rocking, *layout.gears[1:]))
    random = np.random.default_rng(draw(st.integers(0, 2**31)))
    meshes = len(layout.meshes)
    return machine_with(
        layout,
        draw(st.floats(50.0, 3000.0)),
        draw(st.just(0.0) | st.floats(1e-6, 0.4)),
        draw(st.floats(1e-6, 2e-4)),
        error=draw(st.floats(0.0, 60e-6)) * random.normal(size=meshes),
        position=draw(st.floats(0.0, 60e-6)) * random.normal(size=(count, 2)),
        stiffness=random.uniform(0.7, 1.4, meshes),
    )


@against(
    "second implementation",
    "enumeration of all states of contact, numpy.linalg.lstsq",
    capability="hunting load_sharing_reference",
    module="facegear.machine.statics",
)
@settings(max_examples=25, deadline=None)
@given(st.data())
def test_sharing_with_gaps_is_the_one_consistent_state_of_all_contact_states(data):
    machine = random_machine(data.draw, 2)
    layout = machine.layout
    directions, bearing = flank_jacobian(layout), bearing_matrix(layout)
    applied = np.zeros(layout.dof)
    applied[layout.spins] = machine.torques
    gap = flank_edges(machine)
    stiffness = K * np.tile(machine.imperfections.stiffness, 2)
    forces = mean_equilibrium(machine).flank_forces[0]
    scale = np.ones(layout.dof)
    scale[layout.spins] = 1.0 / layout.pinion_radius
    directions, bearing, applied = directions * scale, bearing * np.outer(scale, scale), applied * scale
    size = max(np.abs(applied).max(), forces.max())
    matching = []
    for state in itertools.product((False, True), repeat=gap.size):
        on = np.array(state)
        pressed = directions[on]
        matrix = bearing + (pressed.T * stiffness[on]) @ pressed
        right = applied + pressed.T @ (stiffness[on] * gap[on])
        place = np.linalg.lstsq(matrix, right, rcond=1e-15)[0]
        place += np.linalg.lstsq(matrix, right - matrix @ place, rcond=1e-15)[0]
        if np.abs(matrix @ place - right).max() > 1e-6 * size:
            continue
        over = directions @ place - gap
        if (over[on] >= -1e-12).all() and (over[~on] <= 1e-12).all():
            matching.append(np.where(on, stiffness * over, 0.0))
    # Bodies that float free leave states that differ only in where lstsq puts them.
    assert matching or _floats(machine)
    for found in matching:
        agrees("flank force, N", forces, found, relative=1e-7, absolute=1e-6 * size)


def _floats(machine):
    """Whether a body hangs between its flanks: least squares may then put it where flanks overlap."""
    forces = mean_equilibrium(machine).flank_forces[0]
    return (np.add.reduce(forces.reshape(-1, len(machine.layout.pinions)), axis=0) == 0.0).any()


@against(
    "analytic",
    "balance of forces and moments of every body",
    capability="hunting load_sharing_reference",
    module="facegear.machine.statics",
)
@settings(max_examples=25, deadline=None)
@given(st.data())
def test_every_force_is_balanced_and_no_flank_pulls_or_penetrates(data):
    machine = random_machine(data.draw, 5)
    random = np.random.default_rng(1)
    count = len(machine.layout.pinions)
    round_bearings = all(p.body.bearing_xy == 0.0 for p in machine.layout.pinions)
    flaws = replace(
        machine.imperfections,
        bearing_clearance=random.uniform(0.0, 30e-6, count) * round_bearings,
        pinion_runout=tuple(Runout(8e-6, phase) for phase in random.uniform(0, 6, count)),
        gear_runout=tuple(Runout(2e-5, phase) for phase in random.uniform(0, 6, len(machine.layout.gears))),
    )
    machine = replace(machine, imperfections=flaws)
    found = equilibria(machine, np.linspace(0.0, 200.0, 7))
    assert (found.flank_forces >= 0.0).all()
    layout = machine.layout
    on_bodies = found.flank_forces @ flank_jacobian(layout)
    applied = np.zeros(layout.dof)
    applied[layout.spins] = machine.torques
    arms = np.where(np.arange(layout.dof) % 4 == 3, layout.pinion_arm, 1.0)
    size = max(np.abs(machine.torques / layout.pinion_arm).max(), found.flank_forces.max())
    bodies = slice(0, 4 * len(layout.bodies))
    missing = ((applied - on_bodies) / arms)[:, bodies].reshape(len(on_bodies), -1, 4)
    agrees(
        "bearing force, N",
        missing[..., :3],
        bearing_forces(machine, found),
        relative=1e-7,
        absolute=2e-11 * size,
    )
    agrees("torque over the base radius, N", missing[..., 3], 0.0, absolute=2e-11 * size)
    for g, place in zip(layout.tilting, range(4 * len(layout.bodies), layout.dof, 2), strict=True):
        moments = layout.gears[g].body.tilt.stiffness * found.displacements[:, place : place + 2]
        agrees(
            "moment of a gear that tilts, N m",
            -on_bodies[:, place : place + 2],
            moments,
            relative=1e-7,
            absolute=1e-10 * size * layout.mesh_radius,
        )


@against(
    "analytic",
    "rigid motion",
    capability="modal hunting load_sharing_reference",
    module="facegear.machine.linear_model",
)
def test_moving_the_whole_gearbox_loads_nothing():
    """Sideways, along the axis, round the axis, and turning as the gears turn."""
    layout = make_layout(kinematics=GEOMETRIC)
    directions = flank_jacobian(layout)
    pinions = len(layout.pinions)
    sideways, lifted, turned = np.zeros((3, layout.dof))
    sideways[: 4 * pinions : 4] = np.cos(layout.angles - 0.3)
    sideways[4 * pinions :: 4], sideways[4 * pinions + 1 :: 4] = np.cos(0.3), np.sin(0.3)
    lifted[1 : 4 * pinions : 4] = lifted[4 * pinions + 2 :: 4] = 1.0
    turned[: 4 * pinions : 4] = layout.mesh_radius
    turned[4 * pinions + 3 :: 4] = -1.0, 1.0
    for motion in (sideways, lifted, turned, rigid_rotation(layout)):
        agrees("deflection of a mesh, m", directions @ motion, 0.0, absolute=1e-15)


def test_the_contact_problem_of_printed_meshes_is_the_dead_zone():
    machine = make_machine(make_layout(), error=0.0, stiffness=FLAT)
    assert not machine.layout.kinematics.flanks_apart
    found = mean_equilibrium(machine)
    np.testing.assert_allclose(found.forces[0], static_equilibrium(machine).forces, rtol=1e-7, atol=1e-4)


@against(
    "analytic",
    "normal part of a displacement",
    capability="hunting load_sharing_reference",
    module="facegear.machine.statics",
)
def test_a_pinion_out_of_place_closes_one_mesh_by_what_it_opens_the_other():
    layout = layout_with([1e20], [Role.INPUT])
    moved = held_forces(machine_with(layout, position=[[10e-6, 0.0]]))
    misfit = held_forces(machine_with(layout, error=[2.0 * 10e-6 * COSINE, 0.0]))
    agrees("mesh force, N", moved, misfit, relative=1e-10)


@against(
    "analytic",
    "lever on a tilt spring",
    capability="hunting load_sharing_reference",
    module="facegear.machine.statics",
)
def test_a_gear_with_one_mesh_rocks_as_a_lever():
    """k_tilt / (R sin a)^2 in series with the mesh along its separating part."""
    layout = layout_with([1e20], [Role.INPUT], (Side.UPPER,))
    stiffness = 2e7
    tilt = Tilt(0.3, stiffness)
    rocking = replace(
        layout, gears=(replace(layout.gears[0], body=replace(layout.gears[0].body, tilt=tilt)),)
    )
    machine = machine_with(rocking, 600.0)
    found = mean_equilibrium(machine)
    force = found.forces[0, 0]
    agrees("mesh force, N", force, 600.0 / layout.pinion_arm, relative=1e-12)
    turned = -force * layout.mesh_radius * SINE / stiffness
    agrees("tilt, rad", found.displacements[0, 8:], [turned, 0.0], relative=1e-12, absolute=1e-18)


def test_tilt_of_no_give_is_the_gear_that_cannot_tilt():
    layout = make_layout(kinematics=GEOMETRIC)
    stiff = tuple(replace(gear, body=replace(gear.body, tilt=Tilt(0.3, 1e21))) for gear in layout.gears)
    square, rocking = (
        mean_equilibrium(machine_with(one, 1300.0, 0.1)) for one in (layout, replace(layout, gears=stiff))
    )
    np.testing.assert_allclose(rocking.forces, square.forces, rtol=1e-9, atol=1e-9 * square.forces.max())


@against(
    "analytic",
    "load sharing of a floating input in closed form, less its play",
    capability="hunting load_sharing_reference",
    module="facegear.machine.statics",
)
def test_a_pinion_inside_its_clearance_floats_and_beyond_it_is_held():
    layout = layout_with([1e9], [Role.INPUT])
    free = held_forces(machine_with(layout, error=[10e-6, 0.0], bearing_clearance=[50e-6]))
    agrees("mesh force of a pinion that floats, N", free[0], free[1], relative=1e-10)
    clearance = 1e-6
    tight = held_forces(machine_with(layout, error=[10e-6, 0.0], bearing_clearance=[clearance]))
    # The pinion leans along (cos a, sin a) F_difference: the play takes 2 play off the misfit of 10 um.
    exact = K * (10e-6 - 2.0 * clearance) / (1.0 + 2.0 * K / 1e9)
    agrees("difference of the mesh forces beyond the play, N", tight[1] - tight[0], exact, relative=1e-9)


def test_springs_hold_no_hidden_state():
    machine = machine_with(make_layout(kinematics=GEOMETRIC), 900.0, 0.1)
    assert isinstance(static_blocks(machine).springs, Springs)
    cycles = np.array([3.3, 0.2, 1700.1])
    together = equilibria(machine, cycles).flank_forces
    alone = np.concatenate([equilibria(machine, cycles[k : k + 1]).flank_forces for k in range(3)])
    np.testing.assert_allclose(together, alone, atol=1e-10 * together.max())


@pytest.mark.parametrize("share", [1e-16, 1e-14, 1e-13, 1e-11, 1e-8])
def test_next_to_no_torque_on_a_free_pinion_does_not_keep_the_others_from_balance(share):
    places = (("engine", Role.INPUT, 0.0), ("tail", Role.TAIL, 0.0))
    layout = make_layout(places, (Side.UPPER,), 1e7, 1e8, GEOMETRIC)
    found = mean_equilibrium(machine_with(layout, 50.0, share, 7.9e-5))
    assert found.residual[0] < 1e-12
    assert found.forces[0, 0] == pytest.approx(50.0 / layout.pinion_arm, rel=1e-12)


BEARING_CLEARANCES = {
    "six pinions": (6, 4.4e8, 1e9, 2e-4, [5e-5] * 6),
    "five pinions on soft bearings": (5, 1e5, 1e7, 1.433e-4, [15e-6, 28e-6, 4e-6, 28e-6, 9e-6]),
}


@pytest.mark.parametrize("name", BEARING_CLEARANCES)
@pytest.mark.parametrize("share", [1e-13, 1e-12, 1e-10, 1e-8, 1e-6])
def test_next_to_no_torque_against_a_bearing_ring_is_balanced_or_refused_by_name(share, name):
    """Below 1e-7 of the others' load the force that turns a free pinion in its ring is lost in rounding."""
    count, pinion, gear, backlash, clearance = BEARING_CLEARANCES[name]
    places = [(f"p{i}", Role.INPUT if i < count - 1 else Role.TAIL, 20.0 * i) for i in range(count)]
    layout = make_layout(tuple(places), (Side.LOWER, Side.UPPER), pinion, gear, GEOMETRIC)
    flaws = replace(perfect(layout), bearing_clearance=np.array(clearance))
    machine = make_machine(
        layout, torque=50.0, tail_share=share, backlash=backlash, error=0.0, imperfections=flaws
    )
    try:
        assert mean_equilibrium(machine).residual[0] < 1e-11
    except NotConverged as error:
        assert share < 1e-7
        assert "static equilibrium did not converge at mean stiffness" in str(error)


def test_the_equilibrium_is_that_of_the_mean_law_unless_a_mesh_position_is_given():
    swinging = Harmonics(np.array([0.0, 0.1 * K]), np.array([K, 0.1 * K]))
    layout = make_layout((("a", Role.INPUT, 0.0), ("b", Role.INPUT, 30.5)), kinematics=GEOMETRIC)
    machine = make_machine(layout, stiffness=swinging, error=5e-6)
    mean, placed = mean_equilibrium(machine), equilibria(machine, np.array([0.3]))
    np.testing.assert_array_equal(static_equilibrium(machine).forces, mean.forces[0])
    np.testing.assert_array_equal(static_equilibrium(machine, 0.3).forces, placed.forces[0])
    assert np.abs(placed.forces - mean.forces).max() > 1e-3 * np.abs(mean.forces).max()
