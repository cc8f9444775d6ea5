"""Machines of helical, tapered, offset and asymmetric teeth at their poses are at rest in a potential."""

from dataclasses import replace

import numpy as np
import pytest
from references import against, agrees
from test_energy import generalized_forces, model_of, sixth_order, work_and_energy
from test_poses_of_every_kind import layout_of, pair_of
from wrench_machines import random_shaft

from facegear.harmonics import Harmonics
from facegear.machine.drive_line import DriveLine, Seat
from facegear.machine.flanks import flank_edges
from facegear.machine.machine import Damping, Machine
from facegear.machine.poses.fixed_point import TOLERANCE, operating_pose
from facegear.machine.poses.posed_flanks import flank_surfaces, mesh_energy
from facegear.machine.poses.surface import STIFFNESS, PoseSurface, surface_nodes
from facegear.machine.static_gears import at_rest as static
from facegear.machine.statics import mean_equilibrium
from facegear.machine.torques import balanced_torques
from facegear.pipeline.stages.poses import surface_pairs
from facegear.sharing import sensitivity
from facegear.teeth.conjugate import PairNumbers

KINDS = ["P1", "P2", "P3 at 92 deg", "P4 at 5 mm"]


def surface_of(pair):
    """Return a surface whose stiffness is a smooth function of path, angle and torque on every flank."""
    pairs, numbers = surface_pairs(pair, ("upper", "lower"))
    surfaces = []
    for number, design in enumerate(pairs.values()):
        pair_numbers = PairNumbers.of_design(design)
        nodes = surface_nodes(pair_numbers, design.assembly, 5000.0, tilting=True)
        nodes = replace(nodes, angles=4.0 * nodes.angles)
        angle, path, torque = np.meshgrid(nodes.angles, nodes.paths, np.log(nodes.torques), indexing="ij")
        along = (path - nodes.paths[3]) / 0.01
        logs = 20.0 + 0.1 * number - 0.1 * along**2 + 0.05 * along - 30.0 * angle + 0.1 * (torque - 6.0)
        surfaces.append(PoseSurface(pair_numbers, design.assembly, nodes, {STIFFNESS: np.exp(logs)}, 600.0))
    return replace(surfaces[0], further=tuple(surfaces[1:]), flank_numbers=numbers)


def machine_of(pair, torque=400.0, pinions=2):
    """Return a machine of an input, and of an idler, on shafts that tilt, between two gears that tilt."""
    layout = layout_of(pair)
    idler = replace(layout.pinions[0], name="two", role="idler", pitches=47.3)
    layout = replace(layout, pinions=(layout.pinions[0], idler)[:pinions])
    shafts = {i: Seat(random_shaft(np.random.default_rng(7 + i)), 1e-3) for i in range(pinions)}
    return Machine(
        layout=layout,
        torques=balanced_torques(layout, np.array([torque, 0.0])[:pinions]),
        stiffness=Harmonics(np.zeros(1), np.array([4.2e8])),
        error=Harmonics(np.zeros(1), np.zeros(1)),
        half_backlash=np.full(2 * pinions, 2e-5),
        damping=Damping(1000.0, 500.0, 1e-6),
        drive_line=DriveLine(layout, shafts, {}),
    )


def pressed_motion(machine, model, seed):
    """Return displacements with which bodies move by up to 30 um and both meshes of a pinion are pressed."""
    generator, layout, meshes = np.random.default_rng(seed), machine.layout, 2
    moved = 3e-5 / model.lengths * generator.uniform(-1.0, 1.0, model.size)
    missing = generator.uniform(15e-6, 50e-6, meshes) - model.rows[:meshes] @ moved
    for gear in range(meshes):
        moved[4 * (1 + gear) + 3] -= missing[gear] / layout.gear_arm
    return moved


@pytest.mark.parametrize("name", KINDS)
def test_forces_of_posed_meshes_of_every_kind_have_an_energy(name):
    """The Jacobian is symmetric and the force is the energy's slope, with tilts of pinions and gears."""
    pair = pair_of(name)
    machine, surface, seed = machine_of(pair, pinions=1), surface_of(pair), KINDS.index(name)
    model = model_of(machine, surface)
    at, generator = pressed_motion(machine, model, seed), np.random.default_rng(seed)
    first, second = (generator.normal(size=at.size) / model.lengths for _ in range(2))

    def along(one, other):
        return sixth_order(lambda d: generalized_forces(machine, surface, at + d * one)[0] @ other, 5e-8)

    crossed = along(first, second), along(second, first)
    size = 4e8 * np.abs(model.rows[:2] @ np.stack([first, second], axis=1)).max(axis=0).prod()
    assert abs(crossed[0] - crossed[1]) < 1e-6 * size
    force = generalized_forces(machine, surface, at)[0] @ first
    energy = sixth_order(lambda d: generalized_forces(machine, surface, at + d * first)[1], 4e-7)
    assert energy == pytest.approx(force, rel=1e-7, abs=1e-3)


@against(
    "analytic",
    "work of the loads on a machine that is at rest in a potential",
    capability="operating_pose",
    module="facegear.machine.poses.fixed_point",
)
@pytest.mark.parametrize("name", KINDS)
def test_loads_do_the_work_that_springs_and_meshes_of_every_kind_store(name):
    pair = pair_of(name)
    machine, surface = machine_of(pair, 700.0), surface_of(pair)
    work, stored = work_and_energy(machine, surface, 0.7, 1.0)
    agrees("energy of springs and meshes, J", stored, work, relative=2e-6)


@pytest.mark.parametrize("name", KINDS)
def test_a_converged_pose_of_every_kind_has_its_own_forces_and_compression(name):
    """Idlers press their back flank at the lower gear, whose surface is another one."""
    pair = pair_of(name)
    machine, surface = machine_of(pair), surface_of(pair)
    result = operating_pose(machine, surface)
    at_rest = mean_equilibrium(static(result.machine))
    assert result.change < TOLERANCE
    np.testing.assert_allclose(at_rest.forces[0], result.forces, rtol=1e-6)
    assert (result.forces > 0.0).tolist() == [True, False, True, True]
    surfaces, meshes = flank_surfaces(machine, surface), len(result.forces)
    over = static(result.machine).linear.rows @ at_rest.displacements[0] - flank_edges(result.machine)
    for mesh in range(meshes):
        flank = mesh + meshes * int(result.forces[mesh] < 0.0)
        at = float(result.torque[mesh]), float(result.path[mesh]), float(result.angle[mesh])
        scale = machine.stiffness.mean / surface.reference_stiffness
        known = mesh_energy(surfaces[flank], *at).approach / scale
        assert over[flank] == pytest.approx(known, rel=1e-6)


@pytest.mark.parametrize("name", ["spur", "P1"])
def test_bearings_are_scanned_for_a_machine_at_its_pose_whose_gears_tilt(name, monkeypatch):
    """Gears of the scan do not tilt: directions of the pose failed on the coordinates that are gone."""
    monkeypatch.setattr(sensitivity, "BEARINGS", (1e8,))
    pair = replace(pair_of("P2"), taper_angle=0.0) if name == "spur" else pair_of(name)
    posed = operating_pose(machine_of(pair), surface_of(pair)).machine
    assert np.isfinite(sensitivity.bearing_scan(posed)["k_gamma"]).all()
