"""Machines on rolling bearings: public numbers, a second program for the whole energy, and hard cases."""

from dataclasses import replace

import numpy as np
import pytest
from references import against, agrees
from rolling_bearings import P1, P2, P3
from rolling_machines import MESH_STIFFNESS, S1, STEEL, machine_on, random_machine, supports_of
from whole_energy import WholeMachine

from facegear.bearings.life import reference_life
from facegear.bearings.response import element_loads
from facegear.bearings.shaft import RollingShaft, find_shaft_equilibrium
from facegear.machine.flanks import flank_edges
from facegear.machine.layout import Role
from facegear.machine.loaded_modes import loaded_modes
from facegear.machine.mean_load import at_mean_load
from facegear.machine.statics import bearing_forces, mean_equilibrium
from facegear.machine.supports import shaft_elements
from facegear.parts.shafts import Segment
from facegear.sharing.path_changes import with_scaled_bearings


@pytest.fixture(scope="module")
def public():
    """The machine of the notes with its first pinion on shaft S1, linearised at its load, and its statics."""
    machine = at_mean_load(machine_on({0: S1}))
    return machine, mean_equilibrium(machine)


@against(
    "second implementation",
    "public bearings: a program of its own",
    capability="bearing_life",
    module="facegear.machine.statics",
)
def test_mesh_forces_on_rolling_bearings_are_the_public_numbers(public):
    lower, upper = np.abs(public[1].forces[0]).reshape(2, 3)
    agrees("forces of the lower meshes, N", lower, [10424.510, 4612.010, 5812.501], absolute=5.01e-4)
    agrees("forces of the upper meshes, N", upper, [26354.754, 4612.010, 5812.501], absolute=5.01e-4)


@against(
    "second implementation",
    "public bearings: a program of its own",
    capability="bearing_life",
    module="facegear.bearings.life",
)
def test_both_bearings_carry_the_public_loads_and_have_the_public_lives(public):
    loads = public[1].shafts[0]
    first, second = loads.forces[0]
    agrees("load of the ball bearing, N", first[:3], [-7858.977, -3663.779, 0.0], absolute=5.01e-4)
    agrees("load of the roller bearing, N", second[:3], [-6578.727, -3068.632, 0.0], absolute=5.01e-4)
    lives = [
        reference_life(bearing, element_loads(bearing, ring[None]))[0]
        for bearing, ring in zip((P1, P3), loads.rings[0], strict=True)
    ]
    agrees("reference lives L10r, million turns", lives, [61.8026, 3957.77], relative=2e-6)


@against(
    "second implementation",
    "public bearings: a program of its own",
    capability="modal",
    module="facegear.machine.loaded_modes",
)
def test_tangent_modes_are_the_public_numbers(public):
    expected = [0.0, 621.301, 1266.245, 1452.879, 1452.879, 1520.109, 1556.023]
    agrees(
        "modes about the mean load, Hz", loaded_modes(public[0]).frequencies[:7], expected, absolute=5.01e-4
    )


def test_the_pinion_loads_its_shaft_with_what_its_bearings_carry(public):
    machine, at_rest = public
    on_shaft = bearing_forces(machine, at_rest)[0, 0]
    assert np.allclose(on_shaft, at_rest.shafts[0].forces[0, :, :3].sum(axis=0), rtol=0, atol=1e-8)


@against(
    "second implementation",
    "Newton's method over beam elements",
    capability="bearing_life",
    module="facegear.machine.statics",
)
@pytest.mark.parametrize("seed", range(10))
def test_statics_and_tangents_agree_with_newtons_method_over_beams(seed):
    machine = at_mean_load(random_machine(seed))
    found, whole = mean_equilibrium(machine), WholeMachine(machine, MESH_STIFFNESS)
    gaps = flank_edges(machine)
    coordinates = whole.settle(gaps)
    flanks, loads = whole.forces(coordinates, gaps)
    size = flanks.max()
    agrees("mesh forces over the largest", found.flank_forces[0] / size, flanks / size, absolute=1e-8)
    for pinion, shaft in found.shafts.items():
        computed, expected = shaft.forces[0] / size, loads[pinion] / size
        agrees("loads of the bearings over the largest mesh force", computed, expected, absolute=1e-8)
    frequencies, tangent_frequencies = whole.frequencies(coordinates, gaps), loaded_modes(machine).frequencies
    is_elastic = frequencies > 1.0
    assert np.allclose(tangent_frequencies[is_elastic], frequencies[is_elastic], rtol=1e-8, atol=0)
    assert (tangent_frequencies[~is_elastic] < 1.0).all()


PAIR = RollingShaft(
    (Segment(0.03, 0.04), Segment(0.06, 0.045), Segment(0.07, 0.04)),
    STEEL,
    supports_of((0.015, P2), (0.095, replace(P2, direction=-1)), preload=8e-6),
    0.145,
)


def pushed(machine, force):
    """The machine with a force on its first pinion, N."""
    forces = machine.forces.copy()
    forces[0] = force
    return replace(machine, forces=forces)


def test_a_machine_without_load_leaves_a_shaft_loose_in_its_clearance():
    machine = at_mean_load(machine_on({0: S1}, torques=(0.0, 0.0, 0.0)))
    at_rest = mean_equilibrium(machine)
    assert np.abs(at_rest.shafts[0].forces).max() < 1e-9 and not at_rest.flank_forces.any()
    assert not machine.drive_line.seats[0].state.stiffness.any()
    assert np.isfinite(loaded_modes(machine).frequencies).all()


def test_a_pinion_crosses_its_clearance_until_its_bearings_carry():
    wide = replace(S1, supports=supports_of((0.01, replace(P1, clearance=1e-4)), (0.12, P3)))
    loads = mean_equilibrium(machine_on({0: wide})).shafts[0]
    assert np.hypot(*loads.rings[0, 0, :2]) > 5e-5
    assert np.hypot(*loads.forces[0, 0, :2]) > 1000.0


def test_a_pinion_that_floats_inside_wide_clearances_shares_its_load_evenly():
    wide = replace(S1, supports=supports_of((0.01, replace(P1, clearance=4e-4)), (0.12, P3)))
    machine = at_mean_load(machine_on({0: wide}))
    at_rest = mean_equilibrium(machine)
    lower, upper = at_rest.forces[0, [0, 3]]
    assert lower == pytest.approx(upper, rel=1e-10)
    assert np.abs(at_rest.shafts[0].forces).max() < 1e-8
    assert not machine.drive_line.seats[0].state.stiffness.any()


def test_a_bearing_with_play_beside_two_others_carries_nothing():
    third = (0.065, replace(P3, clearance=8e-4))
    shaft = replace(S1, supports=supports_of((0.01, P1), (0.12, P3), third))
    loads, alone = (mean_equilibrium(machine_on({0: each})).shafts[0].forces[0] for each in (shaft, S1))
    assert not loads[2].any()
    assert np.allclose(loads[:2], alone, rtol=0, atol=1e-7)


def test_thrust_that_reverses_goes_from_one_bearing_of_a_pair_to_the_other():
    machine = machine_on({0: PAIR})
    thrusts = []
    for force in (-15_000.0, 15_000.0):
        loads = mean_equilibrium(pushed(machine, (0.0, 0.0, force))).shafts[0].forces[0, :, 2]
        assert loads.sum() == pytest.approx(force, rel=1e-10)
        thrusts.append(loads)
    (first_back, second_back), (first_ahead, second_ahead) = thrusts
    assert second_back < -15_000.0 < 0.0 < first_back
    assert second_ahead < 0.0 < 15_000.0 < first_ahead


def test_a_preload_vanishes_with_load_and_leaves_one_bearing_free():
    machine = machine_on({0: PAIR}, torques=(0.0, 0.0, 0.0))
    preloaded = mean_equilibrium(machine).shafts[0].forces[0, :, 2]
    assert preloaded[0] == pytest.approx(-preloaded[1], rel=1e-9) and preloaded[0] > 100.0
    loaded = mean_equilibrium(pushed(machine, (0.0, 0.0, 20_000.0))).shafts[0].forces[0, :, 2]
    assert loaded[1] == 0.0 and loaded[0] == pytest.approx(20_000.0, rel=1e-9)


def test_a_machine_on_springs_takes_no_new_path(public):
    machine = replace(public[0], drive_line=None)
    assert machine.linear is machine.linear_without_rolling and machine.linear.tangent_loads is None
    assert at_mean_load(machine) is machine and mean_equilibrium(machine).on_shafts is None


def test_the_tangent_of_the_mean_load_gives_the_same_equilibrium(public):
    machine, at_rest = public
    linear = machine.linear
    left_over = at_rest.displacements[0] @ linear.stiffness + at_rest.flank_forces[0] @ linear.rows
    assert np.allclose(left_over, linear.loads, rtol=0, atol=1e-7)


def test_tangents_are_derivatives_of_the_statics_by_a_small_load(public):
    machine, at_rest = public
    step, linear = 0.5, machine.linear
    moved = [mean_equilibrium(pushed(machine, (sign * step, 0.0, 0.0))) for sign in (1.0, -1.0)]
    rows = linear.rows[at_rest.flank_forces[0] > 0.0]
    matrix = linear.stiffness + MESH_STIFFNESS * rows.T @ rows
    load = np.zeros(linear.size)
    load[0] = 2.0 * step
    expected = np.linalg.pinv(matrix, rcond=1e-13, hermitian=True) @ load
    difference = moved[0].displacements[0] - moved[1].displacements[0]
    turned = linear.rows @ (difference - expected)
    assert np.allclose(turned, 0.0, atol=1e-5 * np.abs(linear.rows @ expected).max())


def test_stiffer_bearings_and_shaft_move_the_pinion_less_under_its_load(public):
    machine = public[0]
    stiff = with_scaled_bearings(machine, (Role.INPUT,), 4.0)
    assert with_scaled_bearings(machine, (Role.INPUT,), 1.0) is machine
    load = np.array([5000.0, 2000.0, 0.0, 0.0, 0.0])
    shafts = [made.drive_line.seats[0].rolling for made in (machine, stiff)]
    soft_state, stiff_state = (
        find_shaft_equilibrium(shaft, part * load) for shaft, part in zip(shafts, (1.0, 4.0), strict=True)
    )
    assert np.allclose(stiff_state.pinion, soft_state.pinion, rtol=1e-7, atol=1e-15)
    assert np.allclose(stiff_state.forces, 4.0 * soft_state.forces, rtol=1e-7, atol=1e-6)
    assert mean_equilibrium(stiff).forces[0, 3] > mean_equilibrium(machine).forces[0, 3]
    tangent = at_mean_load(stiff).drive_line.seats[0].state
    assert np.allclose(tangent.stiffness, tangent.stiffness.T)


def test_a_step_that_hardly_moves_anything_has_no_limit():
    """Nearly unloaded machines warned of an overflow on the terminal."""
    ((_, element),) = shaft_elements(machine_on({0: S1}).drive_line)
    outer, inner = np.full((1, element.rows.shape[1]), 1e-315), np.zeros((1, element.inner.shape[1]))
    with np.errstate(over="raise"):
        assert element.longest_step(outer, inner) == np.inf
