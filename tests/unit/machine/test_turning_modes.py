"""Modes of turning machines with damping: waves in space, decay at rest, growth beyond a wave's speed."""

from dataclasses import replace

import gear_bodies
import numpy as np
import pytest
from lumped_machines import make_layout, make_machine
from references import against, agrees

from facegear.harmonics import Harmonics
from facegear.machine.elastic_gears import ElasticGears
from facegear.machine.kinematics import GEOMETRIC
from facegear.machine.turning_modes import (
    campbell_crossings,
    campbell_table,
    machine_at_speeds,
    turning_modes,
    wave_table,
)
from facegear.parts.reduced_body import ReducedBody

pytestmark = pytest.mark.xdist_group("reference_body")  # solved once a process
RPM = np.pi / 30


def held_gears(damping_ratio=0.0):
    """The paper's layout with both gears' hubs fixed by heavy masses and no mesh damping: bodies alone."""
    layout = make_layout(kinematics=GEOMETRIC)
    gears = tuple(replace(gear, body=replace(gear.body, mass=1e9, inertia=1e9)) for gear in layout.gears)
    layout = replace(layout, gears=gears)
    body = replace(gear_bodies.reference_modes(), damping_ratio=np.array(damping_ratio))
    machine = make_machine(layout, stiffness=Harmonics(np.zeros(1), np.array([4.1e8])), mass_damping=0.0)
    return replace(machine, bodies=ElasticGears(layout, {0: body, 1: body}))


def modes_at(machine, gear_rpm):
    """Modes with all meshes open."""
    none = np.zeros(len(machine.linear.rows))
    return turning_modes(machine.linear, np.diag(none), none, gear_rpm * RPM * gear_bodies.TEETH / 23)


@against(
    "second implementation",
    "Fourier elements extrapolated, hexahedra of a whole gear",
    capability="gear_waves",
    module="facegear.machine.turning_modes",
)
def test_waves_pass_a_point_in_space_at_the_frequencies_that_another_program_has_and_are_kept_apart():
    machine = held_gears()
    table = wave_table(machine.layout, machine.linear, modes_at(machine, 1206.29))
    slowest = {}
    for gear in ("lower", "upper"):
        for name, forward in (("forward", True), ("backward", False)):
            own = table[(table["gear"] == gear) & (table["energy_fraction"] > 0.4)]
            own = own[own["forward_fraction"] > 0.99 if forward else own["forward_fraction"] < 0.01]
            slowest[gear, name] = [
                own[own["nodal_diameters"] == n]["frequency_hz"].min() for n in range(2, 7)
            ]
    for gear in ("lower", "upper"):
        agrees(
            "forward wave, Hz",
            slowest[gear, "forward"],
            [733.61, 943.14, 1401.23, 2048.54, 2846.38],
            relative=1e-3,
        )
        agrees(
            "backward wave, Hz",
            slowest[gear, "backward"],
            [655.08, 824.24, 1242.05, 1849.14, 2606.77],
            relative=1e-3,
        )


def test_both_waves_damp_alike_at_rest_and_gears_of_steel_stay_damped_at_speed():
    machine = held_gears(damping_ratio=0.01)
    table = wave_table(machine.layout, machine.linear, modes_at(machine, 0.0))
    bodies = table[table["energy_fraction"] > 0.4]
    assert len(bodies) > 100 and np.allclose(bodies["damping_ratio"], 0.01, rtol=1e-6)
    assert (modes_at(machine, 3217.0).damping_ratios > 0.0).all()


@against(
    "analytic",
    "Jeffcott rotor with damping in its shaft: l^2 + d l + w^2 - i W d = 0",
    capability="gear_waves",
    module="facegear.machine.turning_modes",
)
def test_damping_that_turns_makes_a_mass_on_a_shaft_grow_beyond_its_natural_frequency():
    """One mode that moves sideways as a rigid whole: n M + g = 0 and S - P = -M."""
    w, ratio = 2 * np.pi * 50.0, 0.02
    shaft = ReducedBody(
        order=np.array([1]),
        frequency=np.array([50.0]),
        coriolis=np.array([[-1.0]]),
        stiffening=np.array([[-1.0]]),
        mesh=np.array([[0.0], [1.0], [0.0]]),
        hub=np.zeros((2, 1)),
        hub_spin=np.zeros(1),
        round=np.zeros(1),
        static=np.zeros((2, 3, 3)),
        damping_ratio=np.array(ratio),
    )
    machine = held_gears()
    machine = replace(machine, bodies=ElasticGears(machine.layout, {1: shaft}))
    for speed in (0.97, 1.03):
        modes = modes_at(machine, speed * w / RPM)
        roots = np.concatenate(
            [np.roots([1, 2 * ratio * w, w**2 + turn * 2j * ratio * w * speed * w]) for turn in (-1, 1)]
        )
        near = modes.exponents[np.abs(modes.frequencies - 50.0) < 1.0]
        agrees("l over w", np.sort(near.real) / w, np.sort(roots[roots.imag > 0].real) / w, absolute=1e-9)
        assert (modes.damping_ratios.min() < -1e-5) == (speed > 1.0)


def two_waves():
    """Modes of two and three nodal diameters that nothing couples with the hub."""
    return ReducedBody(
        order=np.array([2, 3]),
        frequency=np.array([650.0, 800.0]),
        coriolis=np.diag([-0.2, -0.1]),
        stiffening=np.diag([4.0, 6.0]),
        mesh=np.array([[0.2, 0.1], [0.02, 0.01], [0.0, 0.0]]),
        hub=np.zeros((2, 2)),
        hub_spin=np.zeros(2),
        round=np.zeros(2),
        static=np.zeros((2, 3, 3)),
        damping_ratio=np.array(0.0),
    )


@against(
    "analytic",
    "waves of one mode in space: sqrt(w^2 + (B + c^2) W^2) +- (n + c) W",
    capability="gear_waves",
    module="facegear.machine.turning_modes",
)
def test_lines_over_speed_follow_the_waves_of_a_gear_that_nothing_couples():
    machine = held_gears()
    machine = replace(machine, bodies=ElasticGears(machine.layout, {1: two_waves()}))
    gear_rpm = [300.0, 600.0, 1200.0, 2400.0]
    modes = [modes_at(machine, speed) for speed in gear_rpm]
    table = campbell_table(machine.layout, machine.linear, gear_rpm, modes)
    bending = table[table["energy_fraction"] > 0.9]
    lines = [line for _, line in bending.groupby("line")]
    assert len(lines) == 4 and all(len(line) == len(gear_rpm) for line in lines)
    turned = np.array(gear_rpm) * RPM
    for line in lines:
        order, forward = line["nodal_diameters"].iloc[0], line["forward_fraction"].to_numpy()
        assert (forward > 0.99).all() or (forward < 0.01).all()
        c, b, f = {2: (-0.2, 4.0, 650.0), 3: (-0.1, 6.0, 800.0)}[order]
        middle = np.sqrt((2 * np.pi * f) ** 2 + (b + c**2) * turned**2)
        wave = (middle + np.where(forward > 0.5, 1, -1) * (order + c) * turned) / (2 * np.pi)
        agrees("frequency of a line, Hz", line["frequency_hz"], wave, relative=1e-6)


def test_modes_over_speed_are_those_of_each_speed_and_meet_harmonics_where_both_have_one_frequency():
    layout = make_layout(kinematics=GEOMETRIC)
    machine = make_machine(layout, stiffness=Harmonics(np.zeros(1), np.array([4.1e8])))
    machine = replace(machine, bodies=ElasticGears(layout, {0: two_waves(), 1: two_waves()}))
    speeds = [0.0, 1000.0, 2000.0, 4000.0]
    table = campbell_table(layout, machine.linear, speeds, machine_at_speeds(machine, speeds))
    for speed in speeds[:2]:
        (alone,) = machine_at_speeds(machine, [speed])
        own = table[table["speed_rpm"] == speed]
        assert np.array_equal(own["frequency_hz"], alone.frequencies)
        assert np.array_equal(own["damping_ratio"], alone.damping_ratios)
    assert table.groupby("speed_rpm")["line"].nunique().equals(table.groupby("speed_rpm")["line"].size())
    met = campbell_crossings(table, (23, gear_bodies.TEETH), layout.angles)
    assert len(met) and np.allclose(met["frequency_hz"], met["harmonic"] * 23 * met["speed_rpm"] / 60.0)
    assert met["phase_factor"].between(0.0, len(layout.angles)).all()
