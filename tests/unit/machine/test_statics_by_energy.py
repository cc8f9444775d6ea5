"""Statics with rings of play against a general minimiser of the elastic energy, over random machines."""

from dataclasses import replace

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from lumped_machines import make_layout, make_machine
from references import against, agrees
from scipy.optimize import minimize

from facegear.harmonics import Harmonics
from facegear.machine.flanks import flank_edges
from facegear.machine.imperfections import perfect
from facegear.machine.kinematics import GEOMETRIC
from facegear.machine.layout import Body, Role, Side
from facegear.machine.linear_model import bearing_diagonal, flank_jacobian
from facegear.machine.statics import bearing_forces, mean_equilibrium

K = 4.1e8
FLAT = Harmonics(np.zeros(1), np.array([K]))


@st.composite
def machines(draw):
    """One to three pinions with bearings, rings of play, places and meshes of their own."""
    count = draw(st.integers(1, 3))
    roles = [Role.INPUT, *(draw(st.sampled_from(list(Role))) for _ in range(count - 1))]
    places = tuple((f"p{i}", role, 45.0 * i) for i, role in enumerate(roles))
    sides = draw(st.sampled_from([(Side.LOWER, Side.UPPER), (Side.UPPER,)]))
    layout = make_layout(places, sides, 1.0, 10.0 ** draw(st.floats(8, 10)), GEOMETRIC)
    bearings = [10.0 ** draw(st.floats(7, 10)) for _ in range(count)]
    pinions = tuple(
        replace(pinion, body=Body(1.2, 0.002, (k, k, 0.0)))
        for pinion, k in zip(layout.pinions, bearings, strict=True)
    )
    layout = replace(layout, pinions=pinions)
    random = np.random.default_rng(draw(st.integers(0, 2**31)))
    flaws = replace(
        perfect(layout),
        bearing_clearance=random.uniform(1e-6, 40e-6, count),
        error=15e-6 * random.normal(size=len(layout.meshes)),
        position=15e-6 * random.normal(size=(count, 2)),
        stiffness=random.uniform(0.7, 1.4, len(layout.meshes)),
    )
    torque, backlash = draw(st.floats(100.0, 3000.0)), draw(st.floats(1e-6, 2e-4))
    options = {"tail_share": draw(st.floats(0.0, 0.4)), "stiffness": FLAT, "error": 0.0}
    return make_machine(layout, torque, backlash=backlash, imperfections=flaws, **options)


def potential(machine):
    """Energy over 1e-6 J and its gradient, in micrometres and turns at the mesh."""
    layout, flaws = machine.layout, machine.imperfections
    scale = np.ones(layout.dof)
    scale[layout.spins] = 1.0 / layout.pinion_radius
    directions = flank_jacobian(layout)
    gap = flank_edges(machine)
    stiffness = K * np.tile(flaws.stiffness, 2)
    bearing = bearing_diagonal(layout)
    pinions = len(layout.pinions)
    ring = np.array([pinion.body.bearing[0] for pinion in layout.pinions])
    bearing[: 4 * pinions] = 0.0
    applied = np.zeros(layout.dof)
    applied[layout.spins] = machine.torques

    def energy(moved):
        place = 1e-6 * scale * moved
        over = np.maximum(directions @ place - gap, 0.0)
        sideways = place[: 4 * pinions].reshape(-1, 4)[:, :2]
        way = np.maximum(np.hypot(*sideways.T), 1e-30)
        beyond = np.maximum(way - flaws.bearing_clearance, 0.0)
        value = 0.5 * (stiffness @ over**2 + bearing @ place**2 + ring @ beyond**2) - applied @ place
        force = directions.T @ (stiffness * over) + bearing * place - applied
        force[: 4 * pinions].reshape(-1, 4)[:, :2] += (ring * beyond / way)[:, None] * sideways
        return 1e6 * value, force * scale

    return energy, 1e-6 * scale


@against(
    "third-party program",
    "scipy.optimize.minimize (BFGS) of the elastic energy",
    capability="hunting load_sharing_reference",
    module="facegear.machine.statics",
)
@settings(max_examples=25, deadline=None)
@given(machines())
def test_with_bearing_clearance_the_statics_are_the_least_energy_that_a_general_minimiser_finds(machine):
    energy, to_si = potential(machine)
    found = mean_equilibrium(machine)
    ours = found.displacements[0] / to_si
    least, slope = energy(ours)
    size = max(np.abs(machine.torques / machine.layout.pinion_arm).max(), found.flank_forces.max())
    assert np.abs(slope).max() < 1e-9 * size
    # From rest, without knowing where the statics end.
    other = minimize(
        energy, np.zeros(ours.size), jac=True, method="BFGS", options={"maxiter": 4000, "gtol": 1e-7}
    )
    assert np.abs(other.jac).max() < 1e-4 * size
    assert least <= other.fun + 1e-9 * abs(least)
    agrees("elastic energy, uJ", other.fun, least, relative=1e-6, absolute=1e-6 * size)
    over = flank_jacobian(machine.layout) @ (to_si * other.x) - flank_edges(machine)
    forces = K * np.tile(machine.imperfections.stiffness, 2) * np.maximum(over, 0.0)
    agrees("flank force, N", forces, found.flank_forces[0], relative=1e-7, absolute=5e-3 * size)
    count = len(machine.layout.pinions)
    way = (to_si * other.x)[: 4 * count].reshape(-1, 4)[:, :2]
    beyond = np.maximum(np.hypot(*way.T) - machine.imperfections.bearing_clearance, 0.0)
    ring = np.array([pinion.body.bearing[0] for pinion in machine.layout.pinions])
    held = np.hypot(*bearing_forces(machine, found)[0, :count, :2].T)
    agrees("force of a bearing with play, N", ring * beyond, held, relative=1e-7, absolute=5e-3 * size)
