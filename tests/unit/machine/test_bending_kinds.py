"""Gears that bend under teeth of every kind: whole ring in space, rigid motions, modes, limits, mirror."""

from dataclasses import replace
from functools import cache
from math import atan2, cos, hypot, pi, radians, sin

import gear_bodies
import numpy as np
import pytest
import scipy.linalg
from lumped_machines import make_layout as make_spur_layout
from recorded_motion import record
from references import against, agrees
from scipy.integrate import solve_ivp
from scipy_motions import kicked
from whole_ring import WholeRing
from wrench_machines import (
    UP,
    Teeth,
    flank,
    flank_rows,
    gaps,
    gear_centre,
    make_layout,
    mirrored,
    place,
    springs,
)

from facegear.harmonics import Harmonics
from facegear.machine.elastic_coordinates import coordinates, gear_forces
from facegear.machine.elastic_gears import ElasticGears
from facegear.machine.kinematics import GEOMETRIC
from facegear.machine.layout import Body, FaceGear, Pinion, Role, Side, Tilt
from facegear.machine.loaded_modes import loaded_modes
from facegear.machine.machine import Damping, Machine, OpenFlanks
from facegear.machine.poses.mesh_poses import ForceDirections, pose_rows, rim_levers
from facegear.machine.static_gears import at_rest, static_rows
from facegear.machine.statics import mean_equilibrium
from facegear.machine.torques import balanced_torques
from facegear.motion.integrator.kernel_system import TAU
from facegear.motion.plan import Settings
from facegear.motion.steady_state.simulate import build_model
from facegear.parts.gear_body import mean_compliance
from facegear.parts.matrices import body_matrices, rigid_motions
from facegear.parts.modes import held_solver
from facegear.parts.wheel import Patch

KINDS = {
    "helical": Teeth(25, 125, 3.5e-3, (radians(25),) * 2, radians(15), middle=0.228),
    "tapered": Teeth(23, 143, 3.75e-3, (radians(25),) * 2, 0.0, radians(4), middle=0.264),
    "leaning": Teeth(29, 110, 3e-3, (radians(25), radians(20)), shaft=radians(100), middle=0.162),
    "offset": Teeth(27, 120, 4e-3, (radians(22.5),) * 2, radians(-10), offset=0.025, middle=0.239),
    "all": Teeth(
        27, 120, 4e-3, (radians(25), radians(21)), radians(-10), radians(2), radians(97), 0.02, 0.235
    ),
}
ORDERS, PATCH, K = 4, Patch(17e-3, 0.11), 4e8
RING = WholeRing(np.array([0.228, 0.238, 0.246]), np.array([-0.03, 0.0, 0.011]), gear_bodies.STEEL, ORDERS)


def layout_of(teeth: Teeth, places=(0.0, 31.5), tilt=None):
    pinions = [
        Pinion(f"p{i}", Role.INPUT, pitches, Body(1.2, 0.002, (1e8, 1e8, 2e8)))
        for i, pitches in enumerate(places)
    ]
    gears = [FaceGear(side, Body(31.0, 1.3, (2e9,) * 3, 0.0, tilt)) for side in Side]
    return make_layout(teeth, pinions, gears)


def on_rim(teeth: Teeth, angle: float, upper: bool, sigma: int):
    """Angle, radius and parts of a flank's unit force where its line crosses the gear's pitch plane.

    The parts are outwards, round the axis and to the teeth; all from the model of wrenches in space.
    """
    normal, point = flank(teeth, place(teeth, angle, upper), sigma)
    level = gear_centre(teeth, upper, 0.0)[2]
    x, y, z = point + (level - point[2]) / normal[2] * normal
    assert abs(z - level) < 1e-12
    at = atan2(x, -y)
    out, around = np.array([sin(at), -cos(at), 0.0]), np.array([cos(at), sin(at), 0.0])
    to_teeth = -UP if upper else UP
    return at, hypot(x, y), np.array([normal @ out, normal @ around, normal @ to_teeth])


@cache
def reduced_ring():
    """The ring's compliance by order, as the package reduces it."""
    matrices = body_matrices(RING.section, RING.mesh)
    below = [mean_compliance(matrices, held_solver(matrices, order)) for order in range(ORDERS)]
    static = np.stack([PATCH.compliance(order, means) for order, means in enumerate(below)])
    return replace(gear_bodies.small_body(), static=static)


@against(
    "second implementation",
    "tractions on a whole ring in space",
    capability="gear_bodies",
    module="facegear.machine.static_gears",
)
@pytest.mark.parametrize("name", KINDS)
def test_rim_answers_the_wrenches_of_all_flanks_as_a_whole_ring_in_space_does(name):
    teeth = KINDS[name]
    layout = layout_of(teeth)
    for gear, upper in ((0, False), (1, True)):
        loads = []
        for sigma in (1, -1):
            for angle in layout.angles:
                at, _, force = on_rim(teeth, angle, upper, sigma)
                loads.append(RING.load(at, force, PATCH.height, PATCH.half_width))
        expected = RING.answers(np.array(loads))
        rows = static_rows(reduced_ring(), layout, gear)
        scale = np.abs(expected).max()
        agrees("influence over the largest", rows @ rows.T / scale, expected / scale, absolute=1e-8)


def carried(centre: float, height: float):
    """A body whose modes are the rigid motions of a ring with teeth round a radius, a height below the pitch
    plane: along and round the axis, sideways, and a tilt about height 0.
    """
    radii, heights = centre + np.array([-0.01, 0.0, 0.01]), np.array([-0.02, 0.0])
    ring = WholeRing(radii, heights, gear_bodies.STEEL, 1)
    matrices, patch = body_matrices(ring.section, ring.mesh), Patch(height, 0.0)
    means = [matrices.on_teeth @ rigid_motions(matrices.elements, n) for n in (0, 1)]
    mesh = [patch.rows(n, each) for n, each in enumerate(means)]
    return replace(
        gear_bodies.small_body(),
        order=np.array([0, 0, 1, 1]),
        frequency=np.ones(4),
        coriolis=np.zeros((4, 4)),
        stiffening=np.zeros((4, 4)),
        mesh=np.concatenate(mesh, axis=1),
        hub=np.zeros((2, 4)),
        hub_spin=np.zeros(4),
        round=np.array([0.0, 1.0, 0.0, 0.0]),
        slope=np.concatenate([each[-1] for each in means]),
    )


def hub_columns(layout, gear):
    """Columns of a hub that moves as the waves of `carried` do, each with its factor.

    Waves: order 0 along and round the axis, then cosine and sine; heights count to the teeth.
    """
    sign, first, tilts = layout.gears[gear].sign, 4 * (2 + gear), layout.first_tilts[gear]
    same = [(first + 2, -sign), (first + 3, sign), (first + 1, -1.0), (first, 1.0)]
    return [*same, (tilts, sign), (tilts + 1, sign)]


@pytest.mark.parametrize("name", KINDS)
def test_rim_that_moves_as_a_rigid_whole_feels_the_wrench_of_every_flank(name):
    teeth, height = KINDS[name], 0.018
    layout = layout_of(teeth, tilt=Tilt(0.3, 1e7, height))
    rigid = layout.kinematics.flank_rows(layout)
    meshes = len(layout.meshes)
    for gear, upper in ((0, False), (1, True)):
        sign, forces = layout.gears[gear].sign, gear_forces(layout, gear)
        for number, sigma in enumerate((1, -1)):
            radius = on_rim(teeth, 0.0, upper, sigma)[1]
            rows = coordinates(carried(radius, height), sign, layout.angles, forces).rows
            mine = rows.reshape(2, 2, -1)[number]
            wrench = rigid[number * meshes + 2 * gear + np.arange(2)]
            columns = hub_columns(layout, gear)
            expected = np.stack([factor * wrench[:, column] for column, factor in columns], axis=1)
            np.testing.assert_allclose(mine, expected, rtol=0, atol=1e-12)


@pytest.mark.parametrize("name", KINDS)
def test_rim_that_moves_as_a_rigid_whole_moves_the_pose_of_every_mesh_as_its_hub_does(name):
    """But for its motion round the axis, which moves no path."""
    teeth, height = KINDS[name], 0.018
    layout = layout_of(teeth, tilt=Tilt(0.3, 1e7, height))
    axes = place(teeth, 0.0, True)
    x, y, _ = teeth.offset * axes.x + teeth.face * axes.a
    body, turn = carried(hypot(x, y), height), atan2(x, -y)
    rigid = balanced_machine(layout)
    for gear in range(2):
        linear = replace(rigid, bodies=ElasticGears(layout, {gear: body})).linear
        rows = pose_rows(linear, layout, teeth.face)
        first, hub = layout.dof, 4 * (2 + gear)
        for mesh in 2 * gear + np.arange(2):
            at = layout.angles[mesh - 2 * gear] + turn
            over = body.mesh[1]
            rounds = [0.0, 0.0, *(part * over[mode] for mode in (2, 3) for part in (sin(at), -cos(at)))]
            for number, (column, factor) in enumerate(hub_columns(layout, gear)):
                expected = factor * rows[:, mesh, column]
                expected = expected - rounds[number] * rows[:, mesh, hub : hub + 2] @ [cos(at), sin(at)]
                np.testing.assert_allclose(rows[:, mesh, first + number], expected, rtol=0, atol=1e-12)


def balanced_machine(layout, **changes) -> Machine:
    """Two inputs that drive both gears alike."""
    ratio = layout.gear_teeth / layout.pinion_teeth
    return Machine(
        layout=layout,
        torques=balanced_torques(layout, np.array([900.0, 800.0]), -850.0 * ratio),
        stiffness=Harmonics(np.zeros(1), np.array([K])),
        error=changes.pop("error", Harmonics(np.zeros(1), np.zeros(1))),
        half_backlash=np.full(4, 5e-6),
        damping=Damping(800.0, 300.0, 1e-6, OpenFlanks.CONTACT_ONLY),
    )


def bent(teeth: Teeth, stiffer=1.0, **changes):
    """Two inputs between gears that bend and share the load: small bodies that move along the radius, too."""
    layout = layout_of(teeth)
    bodies = {}
    for gear in range(2):
        body = gear_bodies.small_body(gear + 1)
        times = 1600.0 * stiffer
        frequency = body.frequency * np.sqrt(times)
        bodies[gear] = replace(body, frequency=frequency, static=body.static / times)
    elastic, rigid = ElasticGears(layout, bodies), balanced_machine(layout, **changes)
    return replace(rigid, bodies=elastic, softening=elastic.softening()), rigid


def rim_columns(machine, teeth):
    """Flank rows (8, k) of all waves, and masses (dof, k) between hubs and them, from motions in space."""
    layout, rows, masses = machine.layout, [], []
    for gear, body in machine.bodies.bodies.items():
        upper, hub = layout.gears[gear].side is Side.UPPER, 4 * (2 + gear)
        for mode, order in enumerate(body.order):
            axial, around, radial = body.mesh[:, mode]
            for part in ("c", "s") if order else ("c",):
                row, mass = np.zeros(8), np.zeros(layout.dof)
                for mesh, (pinion, g) in enumerate(layout.meshes):
                    for number, sigma in enumerate((1, -1)):
                        at, _, force = on_rim(teeth, layout.angles[pinion], upper, sigma)
                        c, s = cos(order * at), sin(order * at)
                        moved = np.array([radial * c, around * s, axial * c])
                        if part == "s":
                            moved = np.array([radial * s, -around * c, axial * s])
                        if not order:
                            turns = body.round[mode] > 0.5
                            moved = np.array([0.0, around, 0.0]) if turns else np.array([radial, 0.0, axial])
                        row[mesh + 4 * number] = -(force @ moved) * (g == gear)
                side = 1.0 if upper else -1.0
                if order == 0:
                    mass[hub + 2] = -side * body.hub[0, mode] * (1.0 - body.round[mode])
                    mass[hub + 3] = side * body.hub[1, mode] * body.round[mode]
                if order == 1:
                    mass[hub + (1 if part == "c" else 0)] = body.hub[0, mode] * (-1.0 if part == "c" else 1.0)
                rows.append(row)
                masses.append(mass)
    return np.array(rows).T, np.array(masses).T


def left_out(machine, teeth):
    """Compliance (8,) of the flanks beyond the modes: what small bodies have in one order more than these."""
    layout, found = machine.layout, np.zeros(8)
    for mesh, (pinion, gear) in enumerate(layout.meshes):
        body = machine.bodies.bodies[gear]
        extra = (body.static - body.modal)[4]
        for number, sigma in enumerate((1, -1)):
            upper = layout.gears[gear].side is Side.UPPER
            radial, around, axial = on_rim(teeth, layout.angles[pinion], upper, sigma)[2]
            found[mesh + 4 * number] = np.diagonal(extra) @ np.array([axial, around, radial]) ** 2
    return found


@against(
    "second implementation",
    "dense matrices of bodies and waves in space",
    capability="modal",
    module="facegear.machine.elastic_coordinates",
)
@pytest.mark.parametrize("name", KINDS)
def test_modes_of_machines_whose_gears_bend_are_those_of_a_dense_model_in_space(name):
    teeth = KINDS[name]
    machine, _ = bent(teeth)
    layout, waves = machine.layout, machine.bodies.bodies.values()
    rows, masses = rim_columns(machine, teeth)
    lumped, count = layout.dof, rows.shape[1]
    mass = np.eye(lumped + count)
    mass[:lumped, :lumped] = np.diag([*(1.2, 1.2, 1.2, 0.002) * 2, *(31.0, 31.0, 31.0, 1.3) * 2])
    mass[:lumped, lumped:], mass[lumped:, :lumped] = masses, masses.T
    squared = [(2 * pi * body.frequency[mode]) ** 2 for body in waves for mode in own_modes(body)]
    stiffness = np.zeros((lumped + count,) * 2)
    stiffness[:lumped, :lumped] = springs(machine)
    stiffness[range(lumped, lumped + count), range(lumped, lumped + count)] = squared
    whole = np.concatenate([flank_rows(machine, teeth), rows], axis=1)
    closed = mean_equilibrium(machine).flank_forces[0] > 0.0
    assert closed[:4].all() and not closed[4:].any()
    stiff = 1.0 / (1.0 / K + left_out(machine, teeth)[closed])
    stiffness += (stiff * whole[closed].T) @ whole[closed]
    expected = np.sqrt(np.maximum(scipy.linalg.eigh(stiffness, mass, eigvals_only=True), 0.0)) / (2 * pi)
    found = np.sort(loaded_modes(machine).frequencies)
    assert found.size == expected.size
    assert found[0] < 1e-6 * found[-1] and expected[0] < 1e-6 * expected[-1]  # all bodies turn together
    agrees("frequency, Hz", found[1:], expected[1:], relative=1e-8)


def own_modes(body):
    """Number of the mode of each coordinate."""
    return np.repeat(np.arange(body.order.size), np.where(body.order > 0, 2, 1))


@pytest.mark.parametrize("name", ["helical", "all"])
def test_stiffer_bodies_come_to_rigid_gears_of_any_teeth_in_proportion(name):
    away = []
    for stiffer in (1e3, 1e4):
        soft, rigid = bent(KINDS[name], stiffer)
        forces = [mean_equilibrium(each).forces[0] for each in (at_rest(soft), rigid)]
        away.append(forces[0] - forces[1])
    assert 0.0 < np.abs(away[0]).max() < 1e-2 * np.abs(forces[1]).max()
    np.testing.assert_allclose(away[0], 10.0 * away[1], rtol=0, atol=2e-2 * np.abs(away[0]).max())


def influences(teeth, places):
    """Motions of all flanks (4, 4) of each gear by unit forces on each other."""
    layout = layout_of(teeth, places)
    rows = [static_rows(gear_bodies.small_body(3), layout, gear) for gear in range(2)]
    return [each @ each.T for each in rows]


@pytest.mark.parametrize("name", KINDS)
def test_coast_flanks_bend_a_rim_as_drive_flanks_of_the_mirror_image_do(name):
    teeth = KINDS[name]
    own, image = influences(teeth, (0.0, 31.5)), influences(mirrored(teeth), (0.0, -31.5))
    swap = [2, 3, 0, 1]
    for mine, other in zip(own, image, strict=True):
        np.testing.assert_allclose(mine, other[np.ix_(swap, swap)], rtol=0, atol=1e-12 * np.abs(mine).max())


@pytest.mark.parametrize(
    "change",
    [{"helix": 1.0}, {"taper": 1.0}, {"offset": 0.1}, {"angles": 1.0}, {"shaft": 1.0}],
    ids=["helix", "taper", "offset", "angle", "shaft"],
)
def test_bending_under_spur_teeth_is_the_limit_of_every_kind_in_proportion(change):
    spur = Teeth(25, 125, 3.5e-3, (radians(25),) * 2)
    layout = make_spur_layout((("p0", Role.INPUT, 0.0), ("p1", Role.INPUT, 31.5)), kinematics=GEOMETRIC)
    radii = (radius * cos(radians(25)) for radius in (spur.pitch_radius, spur.gear_radius))
    names = ("pinion_teeth", "gear_teeth", "pinion_radius", "gear_radius")
    layout = replace(layout, **dict(zip(names, (25, 125, *radii), strict=True)))
    exact = [static_rows(gear_bodies.small_body(3), layout, gear) for gear in range(2)]
    ((key, size),) = change.items()
    ratios = []
    for step in (1e-8, 1e-6, 1e-4):
        value = {
            "angles": (radians(25), radians(25) + size * step),
            "shaft": pi / 2 + size * step,
        }.get(key, size * step)
        found = influences(replace(spur, **{key: value}), (0.0, 31.5))
        apart = [np.abs(each - rows @ rows.T).max() for each, rows in zip(found, exact, strict=True)]
        ratios.append(max(apart) / max(np.abs(found[0]).max(), np.abs(found[1]).max()) / step)
    assert ratios[2] > 1e-3
    assert max(ratios) < 1.05 * ratios[2] + 1e-15 / 1e-8


@against(
    "second implementation",
    "SciPy's DOP853 on rows in space",
    capability="dynamics_response",
    module="facegear.motion.integrator.reduction",
)
@pytest.mark.parametrize("name", ["helical", "all"])
def test_machines_whose_gears_bend_under_any_teeth_move_as_scipy_says(name):
    """Matrices of the turning waves are the package's, held elsewhere; rows, gaps and remainders are not."""
    teeth, omega = KINDS[name], TAU * 1900.0
    machine, _ = bent(teeth, error=Harmonics(np.zeros(2), np.array([0.0, 3e-6])))
    model, linear = build_model(machine), machine.linear
    rows = np.concatenate([flank_rows(machine, teeth), rim_columns(machine, teeth)[0]], axis=1)
    turning, spin, n = omega / teeth.pinion, linear.spin, linear.size
    damping = linear.damping + turning * spin.gyroscopic
    spring = linear.stiffness + turning * spin.circulatory + turning**2 * spin.centrifugal
    inverse = np.linalg.inv(linear.mass)
    stiff = 1.0 / (1.0 / K + left_out(machine, teeth))
    gap, lag = gaps(machine, teeth), np.tile(machine.phases, 2)
    load = np.zeros(n)
    load[: machine.layout.dof][3::4] = machine.torques

    def slope(t, state):
        moved, speed = state[:n], state[n:]
        place = omega * t - TAU * lag
        error, rate = 3e-6 * np.cos(place), -3e-6 * omega * np.sin(place)
        over, closing = rows @ moved - error - gap, rows @ speed - rate
        force = np.where(over > 0.0, stiff * over + 800.0 * closing, 0.0)
        return np.concatenate([speed, inverse @ (load - rows.T @ force - spring @ moved - damping @ speed)])

    start = kicked(model, 0.05)
    phases = np.linspace(0.0, 2.0 * TAU, 21)
    run = record(model.system, omega, start, 2, Settings(tolerance=1e-13))
    assert (run.states[:, :4] > 0).any() and (run.states == 0).any()
    coordinates_found = run.at(phases)[0]
    basis = model.reduction.basis
    first = np.concatenate([basis @ start.displacement, basis @ start.velocity])
    found = solve_ivp(
        slope,
        (0.0, phases[-1] / omega),
        first,
        "DOP853",
        phases / omega,
        rtol=1e-11,
        atol=1e-15,
        max_step=2e-6,
    )
    moved = found.y.T[:, :n]
    mine = coordinates_found @ basis.T
    rim = slice(machine.layout.dof, n)
    scale = np.abs(moved[:, rim] * linear.lengths[rim]).max()
    apart = (mine - moved)[:, rim] * linear.lengths[rim]
    agrees("motion of the waves over the largest", apart / scale, np.zeros_like(apart), absolute=1e-6)
    expected = moved @ rows.T
    assert scale > 1e-7 and np.ptp(expected[:, :4], axis=0).min() > 1e-7


@pytest.mark.parametrize("name", KINDS)
def test_levers_of_posed_meshes_complete_the_wrench_on_a_rim_that_tilts(name):
    """Teeth round the middle of the pinion's face; with an offset slopes are those below it, not those at the
    flank.
    """
    teeth, height = KINDS[name], 0.018
    layout = layout_of(teeth, tilt=Tilt(0.3, 1e7, height))
    rigid, axes = balanced_machine(layout), place(teeth, 0.0, True)
    body = carried(hypot(*(teeth.offset * axes.x + teeth.face * axes.a)[:2]), height)
    directions = ForceDirections(layout, teeth.face, np.zeros((8, 4)), rim_levers(layout, teeth.face))
    for gear in range(2):
        linear = replace(rigid, bodies=ElasticGears(layout, {gear: body})).linear
        rows = directions(linear).rows
        for number, (column, factor) in enumerate(hub_columns(layout, gear)):
            if number != 1:  # round the axis a force has its lever in the rigid rows alone
                expected = np.where(np.arange(8) // 2 % 2 == gear, factor * rows[:, column], 0.0)
                found = rows[:, layout.dof + number]
                np.testing.assert_allclose(found, expected, rtol=0, atol=5e-5 if teeth.offset else 1e-12)
