"""Machines that run side by side, one in each lane of a vector, move as each does when it runs alone."""

from dataclasses import replace

import numpy as np
import pytest
from force_tables import linear_table, power_table
from hypothesis import given, settings
from hypothesis import strategies as st
from lumped_machines import make_layout, make_machine
from oscillators import backlash_oscillator, mathieu, meissner, one_degree
from random_machines import frequency, machines, speeds
from references import against, agrees
from test_bending_gears import machine as bending_gears
from test_dynamics_hard_cases import CASES

from facegear.errors import NotConverged
from facegear.machine.disturbances import PARTS, MeshFriction
from facegear.machine.imperfections import perfect
from facegear.machine.kinematics import GEOMETRIC, PRINTED_KINEMATICS
from facegear.machine.machine import FlankTables, OpenFlanks
from facegear.meshing.load_dependent import load_dependent_law
from facegear.meshing.moving_law import moving_law
from facegear.meshing.power import PowerLaw
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.requests import WIDTH, RunRequest, _groups, run_many, run_stretches
from facegear.motion.steady_state.simulate import build_model, static_start

SAME = 1e-9


def loaded_in_turn(speed):
    """An oscillator whose load has three harmonics."""
    return one_degree(0.1, load=((0.0, 0.02, 0.0, 0.01), (0.1, 0.05 * speed**2, 0.03, 0.0)))


def moved_in_its_cycle():
    """An oscillator whose motion shifts its place in the cycle of its stiffness."""
    steady = one_degree(0.1, stiffness=((0.0, 0.2), (1.0, 0.1)))
    return replace(steady, law=moving_law(steady.law, 1), phase_shifts=np.array([[0.3]]))


PUSH_ONLY = one_degree(0.1, contact_damping=0.2, push_only=True)
IN_PIECES = meissner(0.05, one_sided=True)
ON_A_TABLE = replace(one_degree(0.1), law=load_dependent_law([linear_table(4, 2.0)]))
TWO_FLANKS = make_layout(kinematics=GEOMETRIC)
CLEARANCE = replace(perfect(TWO_FLANKS), bearing_clearance=np.full(5, 1e-5))
RATIOS = 0.05 * np.random.default_rng(11).normal(size=(10, len(PARTS), 2, 3))
RATIOS[:, :, 0, 0] = 0.0
TABLES = 2 * (FlankTables(*(power_table(9, depth, 2e-6, 4e-4, 2.4e10) for depth in (0.2, 0.1))),)


def two_flanks(**options):
    """The machine with two flanks at each mesh, and what else it has."""
    own = {name: options.pop(name) for name in ("tables", "friction") if name in options}
    return replace(make_machine(TWO_FLANKS, **options), **own)


MACHINES = {
    **CASES,
    "contact lost": (make_machine(), 4500.0),
    "irregular": (make_machine(), 15_000.0),
    "damper in contact only": (make_machine(open_flanks=OpenFlanks.CONTACT_ONLY), 7500.0),
    "two flanks": (two_flanks(), 7500.0),
    "tables": (two_flanks(tables=TABLES), 7500.0),
    "flanks that only push": (two_flanks(mesh_damping=12e3, open_flanks=OpenFlanks.PUSH_ONLY), 7500.0),
    "tables and flanks that only push": (
        two_flanks(tables=TABLES, mesh_damping=12e3, open_flanks=OpenFlanks.PUSH_ONLY),
        15_000.0,
    ),
    "bearing clearance": (two_flanks(imperfections=CLEARANCE, torque=100.0), 4500.0),
    "bearing clearance on tables": (two_flanks(imperfections=CLEARANCE, tables=TABLES, torque=100.0), 4500.0),
    "friction": (two_flanks(friction=MeshFriction(RATIOS)), 7500.0),
    "friction on tables": (two_flanks(friction=MeshFriction(RATIOS), tables=TABLES), 7500.0),
    "gears that bend": (bending_gears(torque=100.0), 6100.0),
}
OSCILLATORS = {
    "backlash": (backlash_oscillator(0.75), 0.75),
    "oscillator's damper in contact only": (backlash_oscillator(0.75, in_gap=0.01), 0.75),
    "load of three harmonics": (loaded_in_turn(0.8), 0.8),
    "parametric": (mathieu(0.3), 1.3),
    "oscillator that only pushes": (PUSH_ONLY, 0.7),
    "stiffness in pieces": (IN_PIECES, 0.8),
    "oscillator on a table": (ON_A_TABLE, 0.8),
    "oscillator on a power law": (replace(one_degree(0.1), law=PowerLaw(depth=0.2)), 0.8),
    "oscillator that moves in its cycle": (moved_in_its_cycle(), 0.8),
}


def integrators(name, count=3):
    """Integrators of a machine at speeds a little apart, with starts (2, n) that open contacts."""
    if name in OSCILLATORS:
        system, speed = OSCILLATORS[name]
        found = [Integrator(system, speed * (1.0 + 0.1 * i)) for i in range(count)]
        return found, [np.array([[0.8 + 0.3 * i], [0.2]]) for i in range(count)]
    machine, speed = MACHINES[name]
    model = build_model(machine)
    found = [Integrator(model.system, frequency(model, speed * (1.0 + 0.02 * i))) for i in range(count)]
    kicks = np.random.default_rng(2).normal(size=(count, 2, model.system.size))
    kicks *= 0.3 * model.system.scale / np.abs(model.reduction.mesh_jacobian).max()
    start = static_start(model)
    return found, [one.by_phase(start) + kick for one, kick in zip(found, kicks, strict=True)]


def apart(found, starts, periods):
    """Largest distance over the length scale of states at ends of periods, side by side and alone."""
    together = run_many(found, starts, periods, fewest=1)
    return max(
        np.abs((run.ends - one.run(start, periods).ends) * one.weights).max() / one.scale
        for one, start, run in zip(found, starts, together, strict=True)
    )


@against(
    "second implementation",
    "the integrator of a single machine, whose vectors hold its meshes",
    capability="branches_starts",
    module="facegear.motion.requests",
)
@pytest.mark.parametrize("name", [*MACHINES, *OSCILLATORS])
def test_a_machine_moves_beside_others_as_it_does_alone(name):
    found, starts = integrators(name)
    assert len(_groups([RunRequest(*each, 3) for each in zip(found, starts, strict=True)])) == 1
    agrees("state beside others, scaled", apart(found, starts, 3), 0.0, absolute=SAME)


@settings(max_examples=12, deadline=None)
@given(machine=machines(kinematics=PRINTED_KINEMATICS), speed=speeds, seed=st.integers(0, 99))
def test_any_lumped_machine_moves_beside_others_as_it_does_alone(machine, speed, seed):
    model = build_model(machine)
    found = [Integrator(model.system, frequency(model, speed * factor)) for factor in (1.0, 1.1)]
    kick = np.random.default_rng(seed).normal(size=(2, model.system.size))
    kick *= 0.2 * model.system.scale / np.abs(model.reduction.mesh_jacobian).max()
    start = static_start(model)
    assert apart(found, [one.by_phase(start) + kick for one in found], 2) < SAME


@pytest.mark.parametrize("name", ["two flanks", "gears that bend"])
def test_machines_whose_jacobians_differ_move_beside_each_other_as_alone(name):
    """Values that all lanes share are read once: where one machine differs each must keep its own."""
    (first, *_), starts = integrators(name)
    jacobian = first.system.mesh_jacobian
    systems = [replace(first.system, mesh_jacobian=factor * jacobian) for factor in (1.0, 1.02, 0.97)]
    found = [Integrator(system, first.frequency) for system in systems]
    assert apart(found, starts, 2) < SAME


def test_more_machines_than_lanes_come_out_in_their_order_with_their_samples():
    count = 2 * WIDTH + 3
    speeds_of = np.linspace(0.5, 1.5, count)
    found = [
        Integrator(backlash_oscillator(0.75), speed, 10.0 ** -(6 + i % 3))
        for i, speed in enumerate(speeds_of)
    ]
    starts = [np.array([[1.0 + 0.05 * i], [0.1]]) for i in range(count)]
    runs = run_many(found, starts, 5, last_periods=2, samples=12)
    for one, start, run in zip(found, starts, runs, strict=True):
        alone = one.run(start, 5, samples=12)
        assert run.ends.shape == (2, 2, 1)
        assert run.steps == alone.steps
        assert np.abs(run.ends - alone.ends[3:]).max() < SAME
        assert np.abs(run.samples - alone.samples).max() < SAME


def test_machines_of_several_structures_run_each_among_its_own():
    mixed = [
        backlash_oscillator(0.75),
        PUSH_ONLY,
        backlash_oscillator(0.8),
        IN_PIECES,
        backlash_oscillator(0.9),
        ON_A_TABLE,
        PUSH_ONLY,
    ]
    found = [Integrator(system, 0.8) for system in mixed]
    starts = [np.array([[1.2], [0.1 * i]]) for i in range(len(mixed))]
    stretches = [RunRequest(one, start, 4) for one, start in zip(found, starts, strict=True)]
    assert sorted(_groups(stretches)) == [[0, 2, 4], [1, 6], [3], [5]]
    assert apart(found, starts, 4) < SAME


def test_a_machine_comes_to_the_same_digits_whichever_machines_run_beside_it():
    """So that a study in parts is the study in one piece."""
    found, starts = integrators("tables", 11)
    together = run_many(found, starts, 2, fewest=1)
    parts = [run_many(found[i : i + 4], starts[i : i + 4], 2, fewest=1) for i in (0, 4, 8)]
    for run, again in zip(together, [run for part in parts for run in part], strict=True):
        assert np.array_equal(run.ends, again.ends) and run.steps == again.steps


def test_a_run_that_leaves_all_bounds_is_refused_beside_others():
    found = [Integrator(backlash_oscillator(0.75), 0.75) for _ in range(4)]
    starts = [np.array([[1.0], [0.0]]) for _ in range(3)]
    with pytest.raises(NotConverged, match="beyond all bounds"):
        run_many(found, [*starts, np.full((2, 1), np.nan)], 2)


ASKED = ("ends", "tangents", "samples", "fractions", "growth")
SUMMED = ("origin", "level", "coordinates", "products", "deflections", "squared", "forces")


def disturbance(one):
    tangent = np.random.default_rng(3).normal(size=(1, 2, one.size))
    return tangent / np.sqrt(((one.weights * tangent) ** 2).sum())


@pytest.mark.parametrize(
    "name",
    [
        *("contact lost", "irregular", "damper in contact only", "backlash", "two flanks", "tables"),
        *("flanks that only push", "bearing clearance", "friction", "gears that bend", "stiffness in pieces"),
    ],
)
def test_a_disturbance_and_averages_beside_others_are_those_alone(name):
    found, starts = integrators(name)
    stretches = [
        RunRequest(one, start, periods, disturbance(one), samples=8, batches=2, growth=True)
        for one, start, periods in zip(found, starts, (4, 2, 3), strict=True)
    ]
    for stretch, run in zip(stretches, run_stretches(stretches, fewest=1), strict=True):
        alone = stretch.run()
        assert run.ends.shape == (stretch.periods, 2, stretch.integrator.size)
        assert run.steps == alone.steps
        for field in ASKED:
            same(getattr(run, field), getattr(alone, field), 1e-6)
        same(run.divergence, alone.divergence)
        for field in SUMMED:
            same(getattr(run.sums, field), getattr(alone.sums, field))
        extremes = ((getattr(one.sums, name) for name in ("minimum", "maximum")) for one in (run, alone))
        for found_one, expected in zip(*extremes, strict=True):
            known = np.isfinite(expected)
            assert np.array_equal(np.isfinite(found_one), known)
            same(found_one[known], expected[known])
        same(run.sums.pull, alone.sums.pull, scale=alone.sums.forces.max() / stretch.periods)


def same(found, expected, within=SAME, scale=0.0):
    assert np.abs(found - expected).max() <= within * max(np.abs(expected).max(), scale)


def test_of_machines_beside_others_only_the_one_that_leaves_all_bounds_fails():
    one = Integrator(backlash_oscillator(0.75), 0.75)
    starts = [np.array([[1.0], [0.0]]), np.full((2, 1), np.nan), np.array([[1.1], [0.0]])]
    runs = run_stretches([RunRequest(one, start, 2) for start in starts], fewest=1)
    assert [isinstance(run, NotConverged) for run in runs] == [False, True, False]
    assert np.abs(runs[2].ends - one.run(starts[2], 2).ends).max() < SAME
