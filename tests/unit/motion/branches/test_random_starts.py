"""Random starts of a machine: where they lie."""

from dataclasses import replace

import numpy as np
from lumped_machines import make_machine

from facegear.build.plans import branch_plan
from facegear.motion.branches import machine
from facegear.motion.branches.machine import random_starts, scattered
from facegear.motion.integrator.system import machine_system
from facegear.motion.steady_state.simulate import build_model

SPEED = 6200.0


def in_basis(model, turn):
    """Return the same model in other coordinates: those of its basis times `turn` (n, n)."""
    reduced = replace(
        model.reduction,
        basis=model.reduction.basis @ turn,
        mesh_jacobian=model.reduction.mesh_jacobian @ turn,
        load=model.reduction.load @ turn,
    )
    return replace(model, reduction=reduced, system=machine_system(model.machine, reduced))


def turned_within_groups(omega_squared):
    """Coordinates of one frequency mixed by a random turn, then every second one's sign changed."""
    random, turn = np.random.default_rng(3), np.eye(omega_squared.size)
    for value in np.unique(omega_squared.round(3)):
        group = np.flatnonzero(omega_squared.round(3) == value)
        turn[np.ix_(group, group)] = np.linalg.qr(random.normal(size=(group.size, group.size)))[0]
    return turn * (-1.0) ** np.arange(omega_squared.size)


def test_starts_do_not_depend_on_the_basis_that_the_processor_gives_the_modes(monkeypatch):
    """They were drawn in its coordinates: on another processor other motions were found."""
    seen = []

    def places(period_map, value, starts, settings, step):
        states = [period_map.state(z, float(np.log(value))) for z in starts]
        seen.append([[one.displacement, one.velocity] for one in states])
        return []

    monkeypatch.setattr(machine, "explore", places)
    model = build_model(make_machine())
    turn = turned_within_groups(model.reduction.omega_squared)
    assert np.abs(turn - np.diag(np.diagonal(turn))).max() > 0.1
    other = in_basis(model, turn)
    for one in (model, other):
        random_starts(one, branch_plan(None, SPEED), SPEED)
    first, second = (np.array(q) @ one.reduction.basis.T for q, one in zip(seen, (model, other), strict=True))
    for i in range(2):
        assert np.abs(first[:, i]).max() > 0.0
        assert np.abs(second[:, i] - first[:, i]).max() < 1e-12 * np.abs(first[:, i]).max()


def test_starts_fill_a_box_of_displacements_and_of_rotations_at_the_mesh_radius():
    """Motions that no mesh feels are left out: a start is the nearest one, by the masses, to a point of the
    box.
    """
    model = build_model(make_machine())
    linear, basis = model.machine.linear, model.reduction.basis
    found = scattered(model, 2e-5, 4000, 1) @ basis.T
    inside = linear.momentum(basis) @ basis.T
    expected = (2e-5) ** 2 / 3.0 * (inside.T / linear.lengths**2 @ inside)
    for part in (found[:, 0], found[:, 1]):
        size = np.sqrt(np.outer(np.diagonal(expected), np.diagonal(expected)))
        assert (np.abs(part.T @ part / len(part) - expected) <= 0.1 * size + 1e-25).all()
