"""The running machine while its runouts turn: slow limit, exactness of the slow part, forgetting, cutting."""

import numpy as np
import pytest
from lumped_machines import make_layout, make_machine
from references import against, agrees

from facegear.machine.flank_errors import slow_errors
from facegear.machine.imperfections import Imperfections, Runout, perfect
from facegear.machine.kinematics import GEOMETRIC
from facegear.machine.layout import Role
from facegear.motion.hunting_motion import follow, slow_polynomials
from facegear.motion.integrator.kernel_system import TAU
from facegear.motion.plan import Settings
from facegear.motion.steady_state.simulate import build_model, simulate
from facegear.sharing.hunting import hunting_cycle
from facegear.sharing.running_machine import running, running_table

LAYOUT = make_layout((("engine", Role.INPUT, 0.0), ("idler", Role.IDLER, 35.5)), kinematics=GEOMETRIC)
TURNING = {
    "pinion_runout": (Runout(9e-6, 0.4), Runout(7e-6, 2.0)),
    "gear_runout": (Runout(15e-6, 1.0), Runout()),
}


def machine_with(**errors):
    flaws = Imperfections(**{**vars(perfect(LAYOUT)), **errors})
    return make_machine(LAYOUT, 1500.0, 0.0, error=4e-6, imperfections=flaws)


@against(
    "analytic",
    "runouts as sines of the angles of turn",
    capability="following",
    module="facegear.motion.hunting_motion",
)
def test_the_slow_part_of_the_error_is_that_of_the_statics_and_has_no_jumps():
    model = build_model(machine_with(**TURNING))
    cycles = np.arange(-3, 40)
    table = slow_polynomials(model, cycles)
    for share in (0.0, 0.17, 0.5, 0.93):
        powers = (TAU * share) ** np.arange(table.shape[1])
        exact = slow_errors(model.machine, cycles + share)
        agrees(
            "slow part of the error, m",
            np.einsum("p,cpf->cf", powers, table),
            exact,
            relative=1e-7,
            absolute=1e-13,
        )
    ends = np.einsum("p,cpf->cf", TAU ** np.arange(table.shape[1]), table)
    np.testing.assert_allclose(ends[:-1], table[1:, 0], atol=1e-18)


def test_running_slowly_is_the_quasi_static_hunting_cycle():
    machine = machine_with(**TURNING)
    still = hunting_cycle(machine, 16)
    part = slice(0, 46 * 16)
    gaps = []
    for speed in (400.0, 100.0):
        found = follow(build_model(machine), speed, 0, 46)
        assert found.memory < 1e-6
        gaps.append(np.abs(found.flank_forces - still.flank_forces[part]).max() / still.loads.max())
    assert gaps[1] < 1e-3 and gaps[1] < 0.5 * gaps[0]


@against(
    "analytic",
    "without anything that turns the motion is the periodic one",
    capability="following",
    module="facegear.motion.hunting_motion",
)
def test_with_nothing_that_turns_the_followed_motion_is_the_steady_state():
    machine = machine_with()
    model = build_model(machine)
    steady = simulate(model, 2500.0, Settings(tolerance=1e-10))
    assert steady.label == "period-1"
    found = follow(model, 2500.0, 5, 3, 16, Settings(tolerance=1e-10))
    drive, back = np.split(found.flank_forces, 2, axis=1)
    every = steady.per_period // 16
    expected = np.tile(steady.forces[::every], (3, 1))
    agrees("mesh force, N", drive - back, expected, relative=1e-7, absolute=2e-4 * expected.max())


@against(
    "own convergence",
    "tolerance 1e-11, and the same cycles a turn later",
    capability="following",
    module="facegear.motion.hunting_motion",
)
def test_the_followed_motion_does_not_depend_on_the_step_and_repeats_after_the_turns():
    machine = machine_with(pinion_runout=TURNING["pinion_runout"])
    model = build_model(machine)
    found = follow(model, 3000.0, 0, 23 + 4)
    one, again = found.flank_forces[: 4 * 16], found.flank_forces[23 * 16 :]
    agrees("flank force a turn later, N", one, again, relative=1e-7, absolute=1e-3 * one.max())
    finer = follow(model, 3000.0, 0, 4, 16, Settings(tolerance=1e-11))
    agrees(
        "flank force at a finer tolerance, N",
        finer.flank_forces,
        one,
        relative=1e-7,
        absolute=1e-3 * one.max(),
    )


def test_the_table_says_what_cutting_the_hunting_cycle_costs():
    machine = machine_with(**TURNING)
    still = hunting_cycle(machine, 8)
    table = running_table(running(machine, 1200.0, 30, 8), still)
    assert (table["cut"] <= 1e-12).all() or table["cut"].abs().max() < 0.2
    assert table["mesh_cycles"].eq(30).all() and (table["memory"] < 1e-3).all()
    row = table.iloc[0]
    assert row["k_gamma_static"] == pytest.approx(row["k_gamma_static_whole"] * (1.0 + row["cut"]))
    assert row["k_gamma"] == pytest.approx(row["k_gamma_static"], rel=0.2)
