"""Vibration at the orders of turns: counted as teeth are, slow limit, and the motion followed in time."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lumped_machines import make_layout, make_machine
from references import against, agrees

from facegear.harmonics import Harmonics
from facegear.machine.flank_errors import slow_errors
from facegear.machine.imperfections import Runout, ToothErrors, perfect
from facegear.machine.kinematics import GEOMETRIC
from facegear.machine.layout import Role
from facegear.machine.shaft_orders import loaded_machine, mesh_amplitudes, turn_orders
from facegear.motion.hunting_motion import follow
from facegear.motion.steady_state.simulate import build_model
from facegear.sharing.hunting import hunting_cycle

LAYOUT = make_layout((("engine", Role.INPUT, 0.0), ("idler", Role.IDLER, 35.5)), kinematics=GEOMETRIC)
CONSTANT = Harmonics(np.zeros(1), np.array([4.1e8]))
POSITIONS, SAMPLES = 8, 32


def curve(count, tooth, early):
    """A tooth that comes early, smoothly falling to nothing at its neighbours."""
    places = np.arange(count * POSITIONS) / POSITIONS
    away = np.clip(np.abs((places - tooth + count / 2) % count - count / 2), 0.0, 1.0)
    return early * np.cos(0.5 * np.pi * away) ** 2


def machine_with(pinion=0.0, gear=0.0, **errors):
    """A pinion tooth and a gear tooth that come early by amounts (m), on drive flanks and back flanks."""
    pairs = {
        body: (curve(count, 7, early), curve(count, 3, early))
        for body, count, early in (("pinion", 23, pinion), ("gear", 143, gear))
    }
    flaws = replace(perfect(LAYOUT), teeth=ToothErrors(**pairs), **errors)
    return make_machine(LAYOUT, 1500.0, 0.0, error=0.0, stiffness=CONSTANT, imperfections=flaws)


def spectrum(forces, order, count):
    """Amplitude at an order of so many cycles of forces (cycles x SAMPLES, meshes)."""
    return np.abs(2.0 * np.fft.rfft(forces, axis=0)[order * (len(forces) // SAMPLES) // count]) / len(forces)


@pytest.mark.parametrize(("early", "turning"), [((5e-6, 0.0), {"pinion"}), ((0.0, 4e-6), {"face_gear"})])
def test_a_single_tooth_shows_at_the_orders_that_counting_its_teeth_gives_and_at_no_other(early, turning):
    """And at those about the mesh frequency, a turn's order to either side: k of 23, l of 143."""
    orders = turn_orders(machine_with(*early))
    assert set(orders.turning) == turning
    count = orders.teeth[0]
    near = orders.order[np.abs(orders.order - count) <= 3].tolist()
    assert set(near) >= {count - 2, count - 1, count + 1, count + 2}
    assert set(orders.order.tolist()) >= {1, 2, 3}
    values = slow_errors(machine_with(*early), np.arange(3 * count * SAMPLES) / SAMPLES)
    lines = np.abs(np.fft.rfft(values, axis=0)).max(axis=1)
    between = np.arange(lines.size) % 3 != 0
    assert lines[between].max() < 1e-9 * lines.max()


def test_both_gears_add_up_and_each_keeps_its_own_orders():
    both, first, second = (machine_with(*early) for early in ((5e-6, 4e-6), (5e-6, 0.0), (0.0, 4e-6)))
    orders, parts = turn_orders(both), [turn_orders(first), turn_orders(second)]
    assert orders.turning == [*parts[0].turning, *parts[1].turning]
    np.testing.assert_allclose(orders.error, np.concatenate([part.error for part in parts]), atol=1e-18)


@against(
    "analytic",
    "a runout is a sine of the angle of turn",
    capability="shaft_orders",
    module="facegear.machine.shaft_orders",
)
@settings(max_examples=10, deadline=None)
@given(st.floats(1e-6, 2e-5), st.floats(0.0, 6.0))
def test_a_runout_is_the_first_order_of_its_turn_alone(amplitude, phase):
    machine = machine_with(pinion_runout=(Runout(amplitude, phase), Runout()))
    orders = turn_orders(machine)
    assert orders.turning == ["pinion"] and orders.order.tolist() == [1]
    angle = LAYOUT.pressure_angle
    drive = np.abs(orders.error[0, : len(LAYOUT.meshes)])
    own = np.array([i == 0 for i, _ in LAYOUT.meshes])
    agrees("amplitude of the error, m", drive[own], amplitude, relative=1e-9)
    assert drive[~own].max() < 1e-18 and 0.0 < angle < 1.0


@against(
    "second implementation",
    "equilibria of the machine turned slowly",
    capability="shaft_orders",
    module="facegear.machine.shaft_orders",
)
def test_turned_slowly_the_forces_are_those_of_the_equilibria():
    machine = machine_with(5e-6)
    orders, loaded = turn_orders(machine), loaded_machine(machine)
    found = mesh_amplitudes(loaded.at_rest(orders), loaded.contact_mask)
    still = hunting_cycle(machine, SAMPLES)
    assert (still.loads > 0.0).all()
    for row in (0, 1, 4, np.flatnonzero(orders.order == 22)[0]):
        expected = spectrum(still.loads, orders.order[row], 23)
        agrees("force at an order, N", found[row], expected, relative=1e-6, absolute=1e-3)
    slow = mesh_amplitudes(loaded.forces(orders, 0.1, 23), loaded.contact_mask)
    np.testing.assert_allclose(slow, found, rtol=1e-4, atol=1e-3)


@against(
    "second implementation",
    "the motion followed in time until the start is forgotten",
    capability="shaft_orders",
    module="facegear.machine.shaft_orders",
)
def test_running_the_forces_are_those_of_the_motion_followed_in_time():
    """While no flank parts and the mesh stiffness is constant."""
    machine, speed = machine_with(5e-6), 2500.0
    orders, loaded = turn_orders(machine), loaded_machine(machine)
    found = mesh_amplitudes(loaded.forces(orders, speed, 23), loaded.contact_mask)
    run = follow(build_model(machine), speed, 0, 23, SAMPLES)
    assert run.memory < 1e-6
    drive, back = np.split(run.flank_forces, 2, axis=1)
    forces = np.maximum(drive, back)
    assert (forces > 0.0).all()
    still = mesh_amplitudes(loaded.at_rest(orders), loaded.contact_mask)
    for order in (1, 2, 3, 5, 22, 24):
        row = int(np.flatnonzero(orders.order == order)[0])
        agrees("force at an order, N", found[row], spectrum(forces, order, 23), relative=0.01, absolute=0.5)
    assert np.abs(found / still - 1.0).max() > 0.2
