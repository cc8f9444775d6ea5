"""Pinions on shafts that bend, and engines and rotors behind torsional springs, in the whole machine."""

from dataclasses import replace

import gear_bodies
import numpy as np
import pytest
import scipy.linalg
from drive_lines import CHAINS, TILT_INERTIA, driven, on_bearings
from lumped_machines import make_layout, make_machine
from references import against, agrees

from facegear.machine import statics
from facegear.machine.drive_line import DriveLine, TurningMass
from facegear.machine.elastic_gears import ElasticGears
from facegear.machine.kinematics import GEOMETRIC
from facegear.machine.loaded_modes import loaded_modes
from facegear.machine.modes import modes_of, name_modes
from facegear.machine.statics import equilibria, mean_equilibrium, static_bearing_forces

CYCLES = np.array([0.0, 0.3, 0.71])
SHAFTS = pytest.mark.parametrize(
    "shaft", [on_bearings(1.5e8, 2.5e8), on_bearings(1.5e8, 2.5e8, coupled=2e6)], ids=["even", "coupled"]
)


def swings(inertia, chain, held=0.0):
    """Frequencies (Hz) of a body of this inertia (kg m2) and a chain, the body on a spring (N m/rad)."""
    layout = make_layout(kinematics=GEOMETRIC)
    pinion = replace(layout.pinions[0], body=replace(layout.pinions[0].body, inertia=inertia))
    layout = replace(layout, pinions=(pinion, *layout.pinions[1:]))
    linear = replace(make_machine(layout), drive_line=DriveLine(layout, {}, {0: chain})).linear
    own = np.array([3, *range(28, 28 + len(chain))])
    assert not np.delete(linear.stiffness[own], own, axis=1).any()
    matrix = linear.stiffness[np.ix_(own, own)]
    matrix[0, 0] += held
    return np.sqrt(scipy.linalg.eigvalsh(matrix, linear.mass[np.ix_(own, own)]).clip(0.0)) / (2.0 * np.pi)


@against(
    "analytic",
    "masses on torsional springs by their characteristic equations, bodies.md 6",
    capability="shafts",
    module="facegear.machine.drive_line",
)
def test_masses_on_torsional_springs_swing_at_the_roots_of_their_closed_form():
    engine, pinion = TurningMass("engine", 2.5e4, 0.08), TurningMass("pinion", 6e5, 0.002)
    free, alone = swings(0.002, (engine,)), swings(0.9, (pinion, engine))
    held = swings(0.002, (engine,), 2.0 * 4.1e8 * make_layout(kinematics=GEOMETRIC).pinion_arm ** 2)
    agrees("engine and pinion, Hz", free[1], 569.688, relative=2e-6)
    agrees("three masses in a row, Hz", alone[1:], [90.9625, 2816.424], relative=1e-6)
    agrees("engine and pinion in two meshes, Hz", held, [88.0951, 4022.630], relative=1e-6)


@SHAFTS
def test_statics_with_shafts_and_turning_masses_are_those_of_dense_algebra(shaft, monkeypatch):
    machine = driven(shaft, masses=CHAINS)
    quick = equilibria(machine, CYCLES)
    monkeypatch.setattr(statics, "static_blocks", lambda machine: None)
    dense = equilibria(machine, CYCLES)
    np.testing.assert_allclose(quick.flank_forces, dense.flank_forces, atol=1e-5)
    # The rigid rotation is nobody's; all else is the same.
    line = machine.drive_line
    held = np.concatenate([line.motions(i) for i in line.tilting])
    sizes = np.abs(dense.displacements[:, held]).max()
    np.testing.assert_allclose(quick.displacements[:, held], dense.displacements[:, held], atol=1e-8 * sizes)
    assert (quick.displacements[:, line.motions(2)[2]] != 0.0).all() == line.seats[2].couples_axially
    assert quick.residual.max() < 1e-12


@pytest.mark.parametrize("tilting", [False, True])
def test_at_rest_a_shaft_is_its_deflection_by_a_force_and_its_bearings_carry_the_pinion(tilting):
    shaft = on_bearings(1.5e8, 2.5e8)
    machine = driven(shaft, tilting)
    plain = replace(machine, drive_line=None)
    found, expected = mean_equilibrium(machine), mean_equilibrium(plain)
    np.testing.assert_allclose(found.flank_forces, expected.flank_forces, rtol=1e-12, atol=1e-9)
    forces = static_bearing_forces(machine)
    np.testing.assert_allclose(forces, static_bearing_forces(plain), atol=1e-6)
    if tilting:
        slope = found.displacements[0, machine.drive_line.tilts(2)]
        fm = shaft.compliance[0, 4]
        np.testing.assert_allclose(slope, [-fm * forces[2, 1], fm * forces[2, 0]], rtol=1e-9)


def test_a_torque_twists_its_branch_and_passes_it_whole():
    machine = driven(masses=CHAINS)
    at, line = mean_equilibrium(machine).displacements[0], machine.drive_line
    plain = mean_equilibrium(replace(machine, drive_line=None))
    np.testing.assert_allclose(plain.flank_forces, mean_equilibrium(machine).flank_forces, rtol=1e-12)
    twist = 800.0 / 6e5
    coupling, engine, alone = at[28:31]
    assert coupling - at[4 * 2 + 3] == pytest.approx(twist, rel=1e-12)
    assert engine - coupling == pytest.approx(800.0 / 2.5e4, rel=1e-12)
    assert alone - at[4 * 3 + 3] == pytest.approx(800.0 / 2.5e4, rel=1e-12)
    assert at[31] - at[4 * 6 + 3] == pytest.approx(machine.torques[6] / 5e6, rel=1e-12)
    np.testing.assert_array_equal(machine.linear.torques[machine.torque_coordinates], machine.torques)
    assert np.count_nonzero(machine.linear.torques) == np.count_nonzero(machine.torques)
    assert line.torque_coordinates()[[2, 3, 6]].tolist() == [29, 30, 31]


def test_stiff_shafts_give_the_machine_on_its_bearings_alone():
    """Differences shrink as the shaft's compliance does, in frequencies and in forces."""
    rigid = on_bearings(1.5e8, 2.5e8, young=1e12)
    reference = driven(rigid)
    base = loaded_modes(reference, 7500.0).frequencies
    forces = mean_equilibrium(reference).forces[0]
    away = {}
    for factor in (1e3, 1e4):
        machine = driven(on_bearings(1.5e8, 2.5e8, young=factor))
        frequencies = loaded_modes(machine, 7500.0).frequencies
        away[factor] = np.array(
            [
                np.abs(frequencies / np.maximum(base, 1.0) - (base > 1.0))[base > 1.0].max(),
                np.abs(mean_equilibrium(machine).forces[0] - forces).max() / np.abs(forces).max(),
            ]
        )
    assert (away[1e4] < 1e-4).all() and (away[1e3] > 1e-6).all()
    np.testing.assert_allclose(away[1e3] / away[1e4], 10.0, rtol=0.02)


def test_stiff_torsion_gives_the_machine_with_the_masses_on_its_gears():
    masses = {2: (TurningMass("engine", 2.5e4, 0.004),), 6: (TurningMass("rotor", 5e6, 2.0),)}
    heavy = driven()
    pinion, gear = heavy.layout.pinions[2], heavy.layout.gears[1]
    pinion = replace(pinion, body=replace(pinion.body, inertia=0.002 + 0.004))
    gear = replace(gear, body=replace(gear.body, inertia=0.54 + 2.0))
    pinions = (*heavy.layout.pinions[:2], pinion, *heavy.layout.pinions[3:])
    layout = replace(heavy.layout, pinions=pinions, gears=(heavy.layout.gears[0], gear))
    base = loaded_modes(replace(heavy, layout=layout)).frequencies
    away = []
    for factor in (1e7, 1e8):
        stiff = {
            body: tuple(replace(part, stiffness=factor * part.stiffness) for part in chain)
            for body, chain in masses.items()
        }
        found = loaded_modes(driven(masses=stiff)).frequencies[: base.size]
        away.append(np.abs(found - base)[base > 1.0] / base[base > 1.0])
    assert away[1].max() < 1e-4
    assert away[0].max() / away[1].max() == pytest.approx(10.0, rel=0.05)


def test_without_shafts_and_turning_masses_the_machine_is_what_it_was_to_the_bit():
    plain = driven()
    empty = replace(plain, drive_line=DriveLine(plain.layout, {}, {}))
    for name in ("mass", "stiffness", "rows", "torques", "forces", "lengths", "dampers"):
        np.testing.assert_array_equal(getattr(empty.linear, name), getattr(plain.linear, name))
    assert empty.linear.labels == plain.linear.labels and empty.linear.spin is None


def test_lumped_damping_acts_on_no_branch():
    machine = driven(masses=CHAINS)
    line, linear = machine.drive_line, machine.linear
    springs = line.springs()
    for row in np.arange(28, linear.size):
        expected = np.zeros(linear.size)
        for spring in springs:
            if row in (spring.first, spring.second):
                expected[[spring.first, spring.second]] -= spring.damping
                expected[row] += 2.0 * spring.damping
        np.testing.assert_allclose(linear.damping[row], expected, atol=1e-9)
    assert springs[2].damping == pytest.approx(2 * 0.0 * 1.0)
    reduced = 0.002 * 0.002 / 0.004
    assert springs[0].damping == pytest.approx(2 * 0.02 * np.sqrt(6e5 * reduced))


def test_forward_whirl_of_a_pinion_turns_against_its_z_as_its_spin_does_and_is_the_faster():
    machine = driven(on_bearings(1.5e8, 2.5e8))
    tilts = machine.drive_line.tilts(2)
    free = modes_of(machine.linear, np.zeros_like(machine.linear.mass), 60000.0 * np.pi / 30.0)
    moves = np.abs(free.shapes[tilts]).max(axis=0) > 1e-6
    conical = np.flatnonzero(moves & (free.frequencies > 3000.0))
    turns = {False: [], True: []}
    for mode in conical:
        about_x, about_y = free.shapes[tilts, mode]
        # cos(w t) about x and -sin(w t) about y turn against z.
        turns[abs(about_x - 1j * about_y) > abs(about_x + 1j * about_y)].append(free.frequencies[mode])
    forward, backward = max(turns[True]), max(turns[False])
    still = np.sqrt(machine.drive_line.seats[2].shaft.stiffness[3, 3] / TILT_INERTIA) / (2.0 * np.pi)
    assert backward < still < forward


def test_tilts_and_turning_masses_are_named_in_the_modes_that_they_move_in():
    machine = driven(on_bearings(1.5e8, 2.5e8), masses=CHAINS)
    modes = loaded_modes(machine)
    symbols = {name.symbols for name in name_modes(machine.layout, machine.linear, modes)}
    assert any("tilt" in symbol for symbol in symbols)
    assert any("engine" in symbol for symbol in symbols) and any("rotor" in symbol for symbol in symbols)
    assert np.count_nonzero(modes.frequencies == 0.0) >= 1


def test_gears_that_bend_take_pinions_on_shafts_and_masses_behind_springs(monkeypatch):
    machine = driven(on_bearings(1.5e8, 2.5e8), masses=CHAINS)
    elastic = ElasticGears(machine.layout, dict.fromkeys((0, 1), gear_bodies.small_body()))
    bending = replace(machine, bodies=elastic, softening=elastic.softening())
    quick = mean_equilibrium(bending)
    linear, first = bending.linear, machine.linear.size
    assert linear.labels[:first] == machine.linear.labels
    np.testing.assert_array_equal(linear.stiffness[:first, :first], machine.linear.stiffness)
    np.testing.assert_array_equal(linear.spin.gyroscopic[:first, :first], machine.linear.spin.gyroscopic)
    monkeypatch.setattr(statics, "static_blocks", lambda machine: None)
    np.testing.assert_allclose(quick.forces, mean_equilibrium(bending).forces, atol=1e-4)
    modes = loaded_modes(bending)
    assert modes.frequencies.size == linear.size
