"""Rims of face gears that bend lean under their meshes: by how much, and what that does to the poses."""

from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import gear_bodies
import numpy as np
import pytest
from gear_bodies import ANGLE, PATCH
from lumped_machines import make_layout, make_machine
from references import against, agrees

from facegear.machine.elastic_gears import ElasticGears
from facegear.machine.kinematics import GEOMETRIC
from facegear.machine.layout import Tilt
from facegear.machine.poses.fixed_point import operating_pose
from facegear.machine.poses.surface import PoseSurface
from facegear.machine.static_gears import at_rest, posed_rows, static_rows
from facegear.parts.body_mesh import body_mesh
from facegear.parts.gear_body import mean_compliance, reduced_body
from facegear.parts.matrices import body_matrices
from facegear.parts.modes import held_solver, order_modes
from facegear.parts.reduced_body import ReducedBody
from validation.poses.measure import TILTING

ORDERS = 4
TILTING_STIFFNESS = 4e6
"""N m/rad."""
POSE = {"offset": "m", "gear_axial": "m", "shaft_angle_error": "rad"}


@pytest.fixture(scope="module")
def surface():
    """The contact of the paper's pair with two errors of the shaft angle."""
    with np.load(TILTING) as stored:
        return PoseSurface.of_arrays(dict(stored))


@cache
def matrices():
    """Matrices of the reference body, on a mesh as coarse as the question allows."""
    return body_matrices(gear_bodies.section(), body_mesh(gear_bodies.section(), 1, 2.0))


@cache
def body() -> ReducedBody:
    """Its compliance of a few orders, and the modes of one nodal diameter."""
    solvers = [held_solver(matrices(), order) for order in range(ORDERS)]
    below = [mean_compliance(matrices(), solve) for solve in solvers]
    static = np.stack([PATCH.compliance(n, means) for n, means in enumerate(below)])
    leaning = np.stack([PATCH.leaning(n, means[-1]) for n, means in enumerate(below)])
    solved = SimpleNamespace(
        orders=tuple(order_modes(matrices(), n, np.inf, solvers[n], 1) for n in (0, 1)),
        section=gear_bodies.section(),
        static=lambda patch: static,
        leaning=lambda patch: leaning,
    )
    return reduced_body(solved, PATCH, 0.002)


def heights(nodes, order, direction):
    """Complex heights of nodes by a unit flank force at angle 0 with an axial and a tangential part."""
    means, factor = matrices().on_teeth, PATCH.factor(order)
    solve = held_solver(matrices(), order)
    axial, around = direction[0] * means[0], direction[1] * (means[1] + order * PATCH.height * means[2])
    moved = solve(factor * np.stack([axial, around], axis=1))[2::3][nodes]
    return moved[:, 0] - 1j * moved[:, 1]


@against(
    "analytic",
    "straight lines fitted to the heights of nodes below the teeth, orders summed",
    capability="operating_pose",
    module="facegear.machine.static_gears",
)
@pytest.mark.parametrize("side", [0, 1])
def test_slope_of_the_rim_below_a_mesh_is_that_of_the_nodes_when_another_mesh_is_loaded(side):
    """The line fits piecewise straight heights between nodes, whose slope is within 0.2 %."""
    layout = make_layout(kinematics=GEOMETRIC)
    flanks, slopes = posed_rows(body(), layout, side)
    meshes, sign = slopes.shape[1], layout.gears[side].sign
    given = -slopes @ flanks.T
    r, height = matrices().elements.shape_points
    nodes = np.flatnonzero((np.abs(height) < 1e-9) & (r > 0.25 - 1e-9) & (r < 0.275 + 1e-9))
    nodes = nodes[np.argsort(r[nodes])]
    fine = np.linspace(0.250, 0.275, 400)
    for back in (False, True):
        waves = [heights(nodes, n, gear_bodies.flank_direction(ANGLE, back)) for n in range(ORDERS)]
        known = np.zeros((meshes, meshes))
        for first, second in np.ndindex(known.shape):
            apart = sign * (layout.angles[first] - layout.angles[second])
            for n, wave in enumerate(waves):
                line = np.interp(fine, r[nodes], np.real(np.exp(-1j * n * apart) * wave))
                known[first, second] += PATCH.factor(n) * np.polyfit(fine, line, 1)[0]
        columns = slice(meshes * back, meshes * (1 + back))
        scale = np.abs(known).max()
        agrees("slope over the largest", given[0][:, columns] / scale, known / scale, absolute=2e-3)


def test_slopes_are_those_of_the_flanks_own_answers_with_more_columns():
    """The coupling between flanks is as without slopes, which are influenced both ways equally."""
    layout = make_layout(kinematics=GEOMETRIC)
    plain, (flanks, slopes) = static_rows(body(), layout, 1), posed_rows(body(), layout, 1)
    np.testing.assert_allclose(flanks @ flanks.T, plain @ plain.T, rtol=1e-9, atol=1e-18)
    np.testing.assert_allclose((slopes[0] ** 2).sum(axis=1), body().leaning[:, -1].sum(), rtol=1e-9)


def rocking_machine():
    """Two rigid gears that tilt about their pitch planes."""
    layout = make_layout(gear_bearing=2e8, kinematics=GEOMETRIC)
    tilt = Tilt(0.3, TILTING_STIFFNESS, 0.0)
    gears = tuple(replace(gear, body=replace(gear.body, tilt=tilt)) for gear in layout.gears)
    return make_machine(replace(layout, gears=gears), torque=700.0, tail_share=0.0, error=0.0)


def stiff_rims_on_springs(radius):
    """Return the machine with bodies whose only wave is that tilt."""
    layout, way = make_layout(gear_bearing=2e8, kinematics=GEOMETRIC), np.array([radius, 0.0, 0.0, 1.0])
    static, leaning = np.zeros((2, 3, 3)), np.zeros((2, 4))
    static[1] = np.outer(way[:3], way[:3]) / TILTING_STIFFNESS
    leaning[1] = way / TILTING_STIFFNESS
    own = ReducedBody(
        order=np.array([1]),
        frequency=np.array([1000.0]),
        coriolis=np.zeros((1, 1)),
        stiffening=np.zeros((1, 1)),
        mesh=way[:3, None],
        hub=np.zeros((2, 1)),
        hub_spin=np.zeros(1),
        round=np.zeros(1),
        static=static,
        damping_ratio=np.array(0.0),
        slope=np.ones(1),
        leaning=leaning,
    )
    machine = make_machine(layout, torque=700.0, tail_share=0.0, error=0.0)
    return replace(machine, bodies=ElasticGears(layout, {0: own, 1: own}))


@against(
    "analytic",
    "a rigid gear that tilts as much",
    capability="operating_pose",
    module="facegear.machine.poses.mesh_poses",
)
def test_a_rim_whose_only_wave_is_a_tilt_has_the_poses_of_a_rigid_gear_that_tilts(surface):
    """Offset, axial shift and shaft angle with their signs, on both gears; forces and energies as well."""
    rigid = operating_pose(rocking_machine(), surface)
    bent = operating_pose(stiff_rims_on_springs(surface.pair.mean_radius), surface)
    assert np.abs(rigid.poses.shaft_angle_error).max() > 1e-4
    for part, unit in POSE.items():
        expected = getattr(rigid.poses, part)
        agrees(
            f"{part.replace('_', ' ')}, {unit}",
            getattr(bent.poses, part),
            expected,
            absolute=1e-6 * np.abs(expected).max(),
        )
    agrees("forces, N", bent.forces, rigid.forces, relative=1e-7)
    agrees("energies, J", bent.energy, rigid.energy, relative=1e-7)


def test_modes_of_a_body_lean_its_rim_as_its_static_answer_does(surface):
    """The body's only compliance is that of its modes: poses from either coordinates are the same."""
    own = stiff_rims_on_springs(surface.pair.mean_radius).bodies.bodies[0]
    frequency = np.sqrt(TILTING_STIFFNESS) / (2.0 * np.pi)
    machine = stiff_rims_on_springs(surface.pair.mean_radius)
    own = replace(own, frequency=np.array([frequency]))
    machine = replace(machine, bodies=ElasticGears(machine.layout, {0: own, 1: own}))
    posed, influence = operating_pose(machine, surface).machine, []
    for linear in (posed.linear, at_rest(posed).linear):
        added = slice(machine.layout.dof, None)
        rows = np.concatenate([linear.rows[:, added], *linear.slopes[:, :, added]])
        influence.append(rows / np.sqrt(np.diagonal(linear.stiffness)[added]))
    whole = [rows @ rows.T for rows in influence]
    np.testing.assert_allclose(whole[0], whole[1], atol=1e-9 * np.abs(whole[1]).max())


def test_bodies_a_thousand_times_stiffer_lean_less_in_proportion(surface):
    """And a machine without poses has no slopes at all."""
    layout, angles = make_layout(gear_bearing=2e8, kinematics=GEOMETRIC), []
    machine = make_machine(layout, torque=700.0, tail_share=0.0, error=0.0)
    for stiffer in (1e3, 1e4):
        own = replace(body(), static=body().static / stiffer, leaning=body().leaning / stiffer)
        bent = replace(machine, bodies=ElasticGears(layout, {0: own, 1: own}))
        angles.append(operating_pose(bent, surface).angle)
    assert 0.0 < np.abs(angles[1]).max() < 1e-6
    np.testing.assert_allclose(angles[0], 10.0 * angles[1], rtol=1e-2, atol=1e-3 * np.abs(angles[0]).max())
    assert at_rest(bent).linear.slopes is None
