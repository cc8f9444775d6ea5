"""Wrenches of meshes on what carries a machine: rolling bearings, and a casing that moves as a whole."""

from dataclasses import replace
from math import radians

import numpy as np
import pytest
from public_casing import mount_public
from rolling_machines import S1, machine_on, public_layout
from seated_machines import make_small_layout, make_small_machine, place_on
from wrench_machines import (
    Teeth,
    flank_rows,
    make_layout,
    random_teeth,
)

from facegear.machine.casing import body_axes
from facegear.machine.layout import Tilt
from facegear.machine.statics import mean_equilibrium
from facegear.rigid_body import carry_motion


def agree(computed, expected, relative=0.0, absolute=0.0):
    np.testing.assert_allclose(computed, expected, rtol=relative, atol=absolute)


@pytest.mark.parametrize("helix", [12.0, -12.0])
def test_rolling_bearings_carry_the_whole_wrench_of_a_helical_pinion(helix):
    teeth = Teeth(20, 60, 3e-3, (radians(25), radians(23)), radians(helix), radians(1), middle=0.095)
    spur = public_layout()
    layout = make_layout(teeth, spur.pinions, spur.gears)
    machine = machine_on({0: S1, 2: S1}, (600.0, 0.0, 0.0), layout, {0: 1.5e-3, 2: 1.5e-3})
    found = mean_equilibrium(machine)
    wrenches = -flank_rows(machine, teeth).T @ found.flank_forces[0]
    size = found.flank_forces.max()
    for pinion in (0, 2):
        loads = found.shafts[pinion].forces[0]
        carried = sum(load @ carry_motion(at - 0.06) for load, at in zip(loads, (0.01, 0.12), strict=True))
        agree(carried, wrenches[machine.drive_line.motions(pinion)], absolute=1e-9 * size)
    assert abs(wrenches[2]) > 0.1 * size


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("tilts", [False, True])
def test_no_flank_feels_a_casing_that_moves_as_a_whole_with_all_bodies(seed, tilts):
    rng = np.random.default_rng([60, seed])
    spur = make_small_layout()
    teeth = replace(random_teeth(rng), pinion=20, gear=60)
    gears = spur.gears
    if tilts:
        gears = tuple(replace(g, body=replace(g.body, tilt=Tilt(0.3, 1e7, 0.01))) for g in gears)
    layout = make_layout(teeth, spur.pinions, gears)
    machine = make_small_machine(layout, place_on(mount_public(modes=0), layout))
    casing, linear = machine.casing, machine.linear
    shift, turn = rng.normal(size=3) * 1e-3, rng.normal(size=3) * 1e-2
    moved = np.zeros(linear.size)
    first = linear.size - casing.size
    for at in casing.mounted.seats.values():
        number = at.start // 6
        seat = shift + np.cross(turn, casing.mounted.seat_positions[number])
        moved[first + at.start : first + at.stop] = [*seat, *turn]
    moved[:first] = casing.relative_motions(linear.labels[:first], None) @ moved[first:]
    # Bodies turn with the rest about their own axes, which the casing leaves free.
    for body in range(len(layout.bodies)):
        own = body_axes(layout, body)[0][2]
        ahead = -1.0 if body < 3 else layout.gears[body - 3].sign
        moved[4 * body + 3] = ahead * turn @ own
    assert np.abs(linear.rows @ moved).max() < 1e-12
