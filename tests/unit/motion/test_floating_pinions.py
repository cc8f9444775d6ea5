"""Pinions of any teeth that float along their axes and tilt, in motion: SciPy, and balance of energy."""

import numpy as np
import pytest
from floating_machines import KINDS, MESH_DAMPING, ByHand, make_floating_machine, motion_at
from recorded_motion import record
from scipy.integrate import solve_ivp
from scipy_motions import kicked

from facegear.motion.integrator.kernel_system import TAU
from facegear.motion.plan import Settings
from facegear.motion.steady_state.simulate import build_model


@pytest.mark.parametrize("moving", [False, True])
@pytest.mark.parametrize("name", KINDS)
def test_floating_and_tilting_pinions_move_as_scipy_says(name, moving):
    teeth, omega = KINDS[name], TAU * 2100.0
    machine = make_floating_machine(teeth, moving)
    model, by_hand = build_model(machine), ByHand(machine, teeth, omega)
    start = kicked(model, 0.05)
    phases = np.linspace(0.0, 2.0 * TAU, 41)
    run = record(model.system, omega, start, 2, Settings(tolerance=1e-13))
    coordinates, deflections = run.at(phases)
    states = run.states[:, :4]
    assert (states > 0).any() and (run.states == 0).any()
    basis = model.reduction.basis
    found = solve_ivp(
        by_hand.slope,
        (0.0, phases[-1] / omega),
        np.concatenate([basis @ start.displacement, basis @ start.velocity]),
        "DOP853",
        phases / omega,
        rtol=1e-12,
        atol=1e-15,
        max_step=1e-6,
    )
    moved = np.split(found.y.T, 2, axis=1)[0]
    rotation = by_hand.rotation
    for mine, expected in ((coordinates @ basis.T, moved),):
        apart = mine - expected
        apart -= np.outer(apart @ (by_hand.mass * rotation), rotation) / (
            rotation @ (by_hand.mass * rotation)
        )
        lengths = machine.linear.lengths
        assert np.abs(apart * lengths).max() < 1e-6 * np.abs(expected * lengths).max()
    errors = np.array([by_hand.law(phase / omega)[1] for phase in phases])
    bent = moved @ by_hand.rows.T - errors
    assert np.abs(deflections[:, :8] - bent).max() < 1e-6 * np.abs(bent).max()
    # Axial floats and tilts do move.
    assert np.ptp(moved[:, [2, 6, 20, 21]], axis=0).min() > 1e-7


@pytest.mark.parametrize("moving", [False, True])
@pytest.mark.parametrize("name", KINDS)
def test_the_energy_of_floating_and_tilting_pinions_is_balanced(name, moving):
    """Energy changes by the work of torques and dampers, and of the flanks' varying stiffness and shape."""
    teeth, omega = KINDS[name], TAU * 2100.0
    machine = make_floating_machine(teeth, moving)
    model, by_hand = build_model(machine), ByHand(machine, teeth, omega)
    run = record(model.system, omega, kicked(model, 0.05), 2, Settings(tolerance=1e-14))
    basis = model.reduction.basis

    phases, weights = run.quadrature(16)
    step = np.searchsorted(run.starts, phases, side="right") - 1
    work = np.zeros(4)
    for phase, weight, moved, speed in zip(
        phases, weights / omega, *motion_at(run, basis, omega, phases, step), strict=True
    ):
        t = phase / omega
        stiffness, over, closing, by_place = by_hand.flanks(t, moved, speed)
        error_rate, growth = by_hand.law(t)[2], omega * by_place
        force = stiffness * over
        lost = speed @ by_hand.damping @ speed + MESH_DAMPING * closing @ (by_hand.rows @ speed)
        given = 0.5 * growth @ over**2 - force @ error_rate
        work += weight * np.array([by_hand.load @ speed, -lost, given, speed @ by_hand.gyroscopic @ speed])
    last = run.starts[-1] + run.lengths[-1]
    ends = []
    for phase, number in ((0.0, 0), (last, -1)):
        moved, speed = (part[0] for part in motion_at(run, basis, omega, np.array([phase]), [number]))
        ends.append(by_hand.energy(phase / omega, moved, speed))
    assert abs(work[3]) < 1e-12 * np.abs(work).max()
    assert abs(ends[1] - ends[0] - work.sum()) < 1e-8 * max(np.abs(work).max(), ends[0])
