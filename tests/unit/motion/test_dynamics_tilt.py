"""Face gears that rock, in motion: a lever's response, the square gear as its limit, balance of moments."""

from dataclasses import replace

import numpy as np
import pytest
from lumped_machines import make_layout, make_machine
from recorded_motion import record
from references import against, agrees

from facegear.harmonics import Harmonics
from facegear.machine.flank_errors import error_series
from facegear.machine.flanks import flank_law
from facegear.machine.kinematics import GEOMETRIC
from facegear.machine.layout import Role, Side, Tilt
from facegear.machine.machine import OpenFlanks
from facegear.motion.integrator.kernel_system import TAU
from facegear.motion.plan import Settings
from facegear.motion.steady_state.simulate import build_model, simulate, static_start

K = 4.1e8
FLAT = Harmonics(np.zeros(1), np.array([K]))
ONE = (("engine", Role.INPUT, 17.0),)
INERTIA = 0.3


def tilting(layout, stiffness, inertia=INERTIA):
    tilt = Tilt(inertia, stiffness)
    gears = tuple(replace(gear, body=replace(gear.body, tilt=tilt)) for gear in layout.gears)
    return replace(layout, gears=gears)


@against(
    "analytic",
    "linear response with the rim's lever, by hand",
    capability="dynamics_response",
    module="facegear.motion.steady_state.simulate",
)
def test_a_gear_that_rocks_answers_an_error_as_a_lever():
    """One mesh kept in contact: the linear response, with the rim's lift R sin a times the tilt by hand."""
    layout = make_layout(ONE, (Side.UPPER,), kinematics=GEOMETRIC)
    options = {"error": 3e-6, "stiffness": FLAT, "open_flanks": OpenFlanks.CONTACT_ONLY}
    machine = make_machine(tilting(layout, 4e6), 1500.0, 0.0, **options)
    model = build_model(machine)
    found = simulate(model, 2600.0, Settings(tolerance=1e-12))
    assert found.period == 1 and (found.forces > 0.0).all()
    cosine, sine = np.cos(layout.pressure_angle), np.sin(layout.pressure_angle)
    angle, radius = layout.angles[0], 3.75e-3 * 143 / 2
    # Pinion x, y, turn; gear x, y, z, turn; tilts.
    row = np.array([cosine, sine, layout.pinion_radius])
    row = np.append(row, [-cosine * np.cos(angle), -cosine * np.sin(angle), -sine, -layout.gear_radius])
    row = np.append(row, sine * radius * np.array([np.cos(angle), np.sin(angle)]))
    mass = np.diag([1.199, 1.199, 0.002, 7.795, 7.795, 7.795, 0.54, INERTIA, INERTIA])
    bearing = np.diag([6.5e7, 6.5e7, 0.0, 8.7e9, 8.7e9, 8.7e9, 0.0, 4e6, 4e6])
    damping = 800.0 * mass + 2e-6 * bearing + 1200.0 * np.outer(row, row)
    omega = found.frequency
    dynamic = bearing + K * np.outer(row, row) + 1j * omega * damping - omega**2 * mass
    moved = np.linalg.solve(dynamic, row * (K + 1200.0j * omega) * 3e-6)
    swing = K * (row @ moved - 3e-6)
    by_hand = 1500.0 / layout.pinion_radius + (swing * np.exp(TAU * 1j * found.phases)).real
    agrees("mesh force, N", found.forces[:, 0], by_hand, relative=1e-7, absolute=2e-7 * by_hand.max())


def test_a_gear_that_hardly_tilts_moves_as_one_that_cannot():
    layout = make_layout(kinematics=GEOMETRIC)
    omega, phases = TAU * 1400.0, np.linspace(0.0, TAU, 40)
    model = build_model(make_machine(layout, 1500.0))
    square = record(model.system, omega, static_start(model), 1, Settings(tolerance=1e-13)).at(phases)[1]
    gaps = []
    for stiffness in (1e11, 1e13, 1e17):
        # Inertia in proportion: the gear rocks at one frequency, ever less.
        model = build_model(make_machine(tilting(layout, stiffness, 1e-9 * stiffness), 1500.0))
        run = record(model.system, omega, static_start(model), 1, Settings(tolerance=1e-13))
        gaps.append(np.abs(run.at(phases)[1] - square).max() / model.system.scale)
    assert gaps[1] == pytest.approx(0.01 * gaps[0], rel=0.3)
    assert gaps[2] < 1e-9


@against(
    "analytic",
    "impulse and moment of momentum of the rim",
    capability="dynamics_response",
    module="facegear.motion.integrator.integrator",
)
def test_moments_about_both_diameters_are_balanced_in_motion():
    """I dw + (lambda I + beta k) dtilt + k integral of tilt = integral of r x F over the rim."""
    layout = tilting(make_layout(kinematics=GEOMETRIC), 2e7)
    machine = make_machine(layout, 800.0, error=20e-6)
    model = build_model(machine)
    system, omega = model.system, TAU * 2300.0
    run = record(system, omega, static_start(model), 2, Settings(tolerance=1e-14))
    phases, weights = run.quadrature(16)
    coordinates, deflections = run.at(phases)
    step = np.searchsorted(run.starts, phases, side="right") - 1
    order = np.arange(1, run.coordinates.shape[1])
    ahead = (phases - run.starts[step])[:, None]
    rates = order * ahead ** (order - 1)
    rate = omega * np.einsum("kp,kpm->km", rates, run.deflections[step][:, 1:])
    k = flank_law(machine).stiffness(phases / TAU)
    # Damping across open flanks is shared by the two; the error's rate is in the deflection's already.
    force = k * np.maximum(deflections - system.upper, 0.0) + 0.5 * machine.damping.mesh * rate
    assert error_series(machine)[0].order == 1
    drive, back = np.split((weights / omega) @ force, 2)
    axial = (drive + back) * np.sin(layout.pressure_angle)
    ends = []
    for at, ahead_ in ((0, 0.0), (-1, run.lengths[-1])):
        powers = np.arange(run.coordinates.shape[1])
        place = ahead_**powers @ run.coordinates[at]
        speed = omega * (order * ahead_ ** (order - 1)) @ run.coordinates[at][1:]
        ends.append((model.reduction.basis @ place, model.reduction.basis @ speed))
    tilts = (weights / omega) @ (coordinates @ model.reduction.basis.T)
    for g, gear in enumerate(layout.gears):
        at = slice(28 + 2 * g, 30 + 2 * g)
        moved, gained = (ends[1][part][at] - ends[0][part][at] for part in (0, 1))
        held = 2e7 * tilts[at] + (800.0 * INERTIA + 2e-6 * 2e7) * moved + INERTIA * gained
        rim = layout.mesh_radius * np.stack([np.sin(layout.angles), -np.cos(layout.angles)])
        lift = gear.sign * axial[5 * g : 5 * g + 5]
        moments = np.array([rim[1] @ lift, -rim[0] @ lift])
        agrees(
            "moment over two periods, N m s",
            held,
            moments,
            relative=1e-7,
            absolute=1e-8 * layout.mesh_radius * np.abs(axial).max(),
        )
