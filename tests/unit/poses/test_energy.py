"""Law, force and reactions of a mesh over its pose come from one energy."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lumped_machines import PLACES, make_layout, make_machine

from facegear.geometry.conjugate import contact_at
from facegear.geometry.conjugate_slopes import conjugate_slopes
from facegear.geometry.design import AssemblyErrors
from facegear.poses.energy import mesh_energy
from facegear.poses.fixed_point import operating_pose, pose_at
from facegear.poses.surface import STIFFNESS, Nodes, PoseSurface
from facegear.poses.tables import scaled_load
from facegear.transmission.layout import Role, Side, Tilt
from facegear.transmission.statics import Equilibria, mean_equilibrium
from facegear.transmission.teeth import GEOMETRIC
from validation.poses.measure import SURFACE

ANGLE = float(np.radians(0.05))
PINION_BASE = 3.75e-3 * 23 / 2 * np.cos(np.radians(25.0))
paths, angles, torques = st.floats(0.2605, 0.2775), st.floats(-8e-4, 8e-4), st.floats(5.0, 1195.0)


@pytest.fixture(scope="module")
def surface():
    """The contact of config/concentric.yaml, with a stiffness that falls by 1.5 to 2.3 % in 0.05 deg."""
    with np.load(SURFACE) as stored:
        known = PoseSurface.of_arrays(dict(stored))
    fall = np.linspace(0.015, 0.023, known.nodes.paths.size)[:, None]
    both = np.concatenate([known.values[STIFFNESS] * np.exp(sign * fall) for sign in (1.0, -1.0)])
    nodes = Nodes(np.array([-ANGLE, ANGLE]), known.nodes.paths, known.nodes.torques)
    return replace(known, nodes=nodes, values={STIFFNESS: both})


def sixth_order(function, step):
    """Derivative at 0 from differences whose error falls with the sixth power of the step."""
    parts = [function(n * step) - function(-n * step) for n in (1, 2, 3)]
    return (45.0 * parts[0] - 9.0 * parts[1] + parts[2]) / (60.0 * step)


@settings(max_examples=10, deadline=None)
@given(torques, paths, angles)
def test_approach_and_reactions_are_the_derivatives_of_the_energy(surface, torque, path, angle):
    """G = F x - U: x by the force, G_y and G_g by the pose, and U_xy is one number from law or reaction."""
    here = mesh_energy(surface, torque, path, angle)

    def complementary(torque, path, angle):
        at = mesh_energy(surface, torque, path, angle)
        return at.force * at.approach - at.stored

    by_force = sixth_order(lambda d: complementary(torque + d, path, angle), 1e-3 * torque) * PINION_BASE
    assert by_force == pytest.approx(here.approach, rel=1e-8)
    by_path = sixth_order(lambda d: complementary(torque, path + d, angle), 2e-5)
    assert by_path == pytest.approx(here.by_path, rel=1e-6, abs=1e-6 * here.stored / 1e-3)
    by_angle = sixth_order(lambda d: complementary(torque, path, angle + d), 2e-6)
    assert by_angle == pytest.approx(here.by_angle, rel=1e-6)
    law = sixth_order(lambda d: mesh_energy(surface, torque, path + d, angle).approach, 2e-5)
    reaction = sixth_order(lambda d: mesh_energy(surface, torque + d, path, angle).by_path, 1e-3 * torque)
    assert reaction * PINION_BASE == pytest.approx(law, rel=1e-6, abs=1e-6 * here.approach / 1e-3)


@settings(max_examples=10, deadline=None)
@given(st.floats(-2.5e-4, 2e-4), st.floats(-1e-4, 1e-4), angles)
def test_slopes_of_the_exact_unloaded_contact_are_its_differences(surface, offset, shift, angle):
    """Of transmission error and path; the errors of differences are those of 2 um and 2e-6 rad."""
    errors = np.array([offset, shift, angle])

    def contact(moved):
        return contact_at(surface.pair, AssemblyErrors(moved[0], moved[2], moved[1]))

    slopes = conjugate_slopes(surface.pair, AssemblyErrors(offset, angle, shift), contact(errors))
    for which, direction in enumerate(np.eye(3)):
        for name, slope in (("transmission_error", slopes.transmission_error), ("y", slopes.path)):
            along = sixth_order(lambda d: getattr(contact(errors + d * direction), name), 2e-6)  # noqa: B023
            assert slope[which] == pytest.approx(along, rel=2e-7, abs=1e-9)


def tilting_machine(places, sides=(Side.LOWER, Side.UPPER)):
    """Pinions at gears that rock on soft bearings, all of them free to move."""
    layout = make_layout(places=places, sides=sides, gear_bearing=2e8, kinematics=GEOMETRIC)
    tilt = Tilt(0.3, 4e6, 0.01)
    gears = tuple(replace(gear, body=replace(gear.body, tilt=tilt)) for gear in layout.gears)
    return make_machine(replace(layout, gears=gears), torque=700.0, tail_share=0.0, error=0.0)


def generalized_forces(machine, surface, displacements):
    """Of drive flanks on all coordinates, with the force of the law where each stands; and their energy."""
    meshes = len(machine.layout.meshes)
    rows, logs, misses = machine.linear.rows[:meshes], [np.full(meshes, 9.0)], []
    for _ in range(20):
        forces = np.concatenate([np.exp(logs[-1]), np.zeros(meshes)])[None]
        at_rest = Equilibria(displacements[None], np.zeros((1, meshes)), forces, np.zeros(1))
        result = pose_at(machine, surface, at_rest)
        pressed = rows @ displacements + result.closing[:meshes]
        misses.append(np.log(machine.stiffness.mean * result.factor * pressed) - logs[-1])
        if len(logs) == 1:
            logs.append(logs[-1] + misses[-1])
        elif np.abs(misses[-1]).max() < 1e-14:
            break
        else:
            step = logs[-1] - logs[-2]
            rise = np.where(step == 0.0, -1.0, (misses[-1] - misses[-2]) / np.where(step == 0.0, 1.0, step))
            logs.append(logs[-1] - misses[-1] / np.minimum(rise, -0.1))
    return forces[0, :meshes] @ result.machine.linear.rows[:meshes], float(result.stored.sum())


def random_motion(machine, seed):
    """Bodies moved by up to 80 um and gears rocked by 1e-4, meshes pressed in by 15 to 50 um."""
    generator, layout = np.random.default_rng(seed), machine.layout
    moved = np.where(machine.linear.lengths == 1.0, 8e-5, 0.0) * generator.uniform(-1.0, 1.0, layout.dof)
    for first in layout.first_tilts.values():
        moved[first : first + 2] = generator.uniform(-1e-4, 1e-4, 2)
    meshes = len(layout.meshes)
    missing = generator.uniform(15e-6, 50e-6, meshes) - machine.linear.rows[:meshes] @ moved
    for mesh, (_, gear) in enumerate(layout.meshes):
        moved[4 * (len(layout.pinions) + gear) + 3] = -missing[mesh] / layout.gear_arm
    return moved


@settings(max_examples=4, deadline=None)
@given(st.integers(0, 10**6), st.sampled_from(Side))
def test_forces_of_posed_meshes_have_an_energy_so_that_their_jacobian_is_symmetric(surface, seed, side):
    """u J v = v J u for any two motions, and the force is the energy's slope.

    To 1e-9, or to 1e-6 where differences reach over a node of the splines.
    """
    machine = tilting_machine((("one", Role.INPUT, 11.0),), (side,))
    at, generator = random_motion(machine, seed), np.random.default_rng(seed)
    scale = 1.0 / machine.linear.lengths
    first, second = (scale * generator.normal(size=at.size) for _ in range(2))

    def along(one, other):
        return sixth_order(lambda d: generalized_forces(machine, surface, at + d * one)[0] @ other, 5e-8)

    crossed = along(first, second), along(second, first)
    size = 4e8 * np.abs(machine.linear.rows[:1] @ np.stack([first, second], axis=1)).max(axis=0).prod()
    assert abs(crossed[0] - crossed[1]) < 1e-6 * size
    force = generalized_forces(machine, surface, at)[0] @ first
    energy = sixth_order(lambda d: generalized_forces(machine, surface, at + d * first)[1], 4e-7)
    assert energy == pytest.approx(force, rel=1e-7, abs=1e-3)


def work_and_energy(machine, surface):
    """Work of the loads from 40 to 100 % of them, Gauss points between, and what springs and meshes gain."""

    def at(fraction):
        loaded = scaled_load(machine, fraction)
        result = operating_pose(loaded, surface)
        moved = mean_equilibrium(result.machine).displacements[0]
        springs = 0.5 * moved @ machine.linear.stiffness @ moved
        return moved, springs + result.stored.sum()

    points, weights = np.polynomial.legendre.leggauss(6)
    first, last = 0.4, 1.0
    loads = machine.linear.loads
    # by parts: the integral of f L . dq is [f L . q] less the integral of L . q df
    between = [loads @ at(first + 0.5 * (last - first) * (point + 1.0))[0] for point in points]
    (start, before), (end, after) = at(first), at(last)
    work = last * loads @ end - first * loads @ start - 0.5 * (last - first) * (weights @ between)
    return work, after - before


def test_loads_do_the_work_that_springs_and_meshes_store(surface):
    """Along a load path of the converged machine: 2.8 J. Ideal normals would make 1e-3 of it of nothing."""
    machine = tilting_machine(PLACES)
    work, stored = work_and_energy(machine, surface)
    assert stored == pytest.approx(work, rel=2e-6)
