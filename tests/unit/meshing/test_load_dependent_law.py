"""The load-dependent law by itself: what statics, motion and tangents ask of it is one function."""

from dataclasses import replace

import numpy as np
import pytest
from force_tables import power_table, two_pairs
from hypothesis import given
from hypothesis import strategies as st

from facegear.machine.block_statics import Springs, settle_all
from facegear.meshing.force_table import ForceTable, shift_tables
from facegear.meshing.load_dependent import load_dependent_law

AMOUNTS = np.append(np.linspace(0.0, 5.0, 83), [1e-6, 3e-5])
LAW = load_dependent_law(shift_tables(2 * [power_table(12, 0.3)], [0.0, 0.2]))


def test_the_table_gives_forces_and_slopes_of_its_levels_back():
    table = two_pairs(9, 6, 1.5)
    law = load_dependent_law([table])
    phases = np.array([0.0, 0.13, 0.7])
    for part, found in (
        (table.forces, law.force(phases, np.repeat(table.levels[:, None, None], 3, axis=1))),
        (table.slopes[1:], law.slope(phases, np.repeat(table.levels[1:, None, None], 3, axis=1))),
    ):
        angle = 2.0 * np.pi * np.outer(np.arange(part.shape[2]), phases)
        wanted = part[:, 0] @ np.sin(angle) + part[:, 1] @ np.cos(angle)
        np.testing.assert_allclose(found[..., 0], wanted, rtol=0, atol=1e-13)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_slopes_are_the_derivatives_of_forces_and_are_continuous_at_the_levels(side):
    cycle, step = np.array([0.37]), 1e-7
    beyond = side * np.stack([AMOUNTS, AMOUNTS], axis=1)[1:, None]
    difference = (LAW.force(cycle, beyond + step) - LAW.force(cycle, beyond - step)) / (2.0 * step)
    inner = np.abs(beyond) > 1e-4
    np.testing.assert_allclose(difference[inner], LAW.slope(cycle, beyond)[inner], rtol=0, atol=1e-6)
    level = side * LAW.levels[1:, None]
    around = [LAW.slope(cycle, level * (1.0 + sign * 1e-12)) for sign in (1.0, -1.0)]
    np.testing.assert_allclose(around[0], around[1], rtol=0, atol=1e-9)


def pressed(held, forces, amounts):
    """Forces (K, M) that statics finds where M pinions, each on a bearing and one flank, are pressed in."""
    count, bearing = amounts.size, 0.5
    lines = np.zeros((count, 3))
    lines[:, 0] = 1.0
    settled = []
    for phase, own in enumerate(forces):
        loads = np.zeros(3 * count)
        loads[::3] = own + bearing * amounts
        springs = Springs(
            jacobian=lines,
            pinion=3 * np.arange(count),
            gear=np.full(count, 3 * count),
            pinion_bearing=np.tile([bearing, 0.0, 1.0], (count, 1)),
            clearance=np.zeros(count),
            core_row=np.zeros(0, int),
            core_column=np.zeros(0, int),
            core_value=np.zeros(0),
            loads=loads,
        )
        at_phase = held._replace(
            **{name: getattr(held, name)[[phase]] for name in ("stiffness", "cosine", "sine")}
        )
        settled.append(settle_all(springs, at_phase, np.zeros((1, count)), 1e-14, np.zeros(3 * count))[1][0])
    return np.array(settled)


def test_compiled_statics_see_the_same_law():
    cycles, law = np.array([0.1, 0.85]), replace(LAW, kind=np.arange(AMOUNTS.size - 1) % 2)
    forces = law.force(cycles, np.tile(AMOUNTS[1:], (2, 1)))
    found = pressed(law.statics_law(cycles), forces, AMOUNTS[1:])
    np.testing.assert_allclose(found, forces, rtol=1e-12, atol=1e-12)


@given(st.floats(0.0, 1.0), st.floats(1e-9, 6.0), st.floats(-1.0, 1.0))
def test_a_table_that_comes_later_or_runs_backwards_is_the_same_function_of_the_phase(cycle, amount, lag):
    (table,) = shift_tables([two_pairs(9, 6, 1.5)], [0.1])
    first, later = shift_tables(2 * [table], [0.0, lag])

    def force(of: ForceTable, phase):
        return load_dependent_law([of]).force(np.array([phase]), np.array([[amount]]))[0, 0]

    assert force(first, cycle) == pytest.approx(force(table, cycle), abs=1e-11)
    assert force(later, cycle) == pytest.approx(force(table, cycle - lag), abs=1e-11)
    assert force(table.mirror(), cycle) == pytest.approx(force(table, -cycle), abs=1e-11)


@given(st.floats(0.0, 1.0), st.floats(-6.0, 6.0))
def test_no_slope_exceeds_the_bound_and_the_force_of_a_power_law_never_falls(cycle, amount):
    slope = LAW.slope(np.array([cycle]), np.full((1, 2), amount))[0]
    assert (slope <= LAW.steepest * (1.0 + 1e-12)).all()
    assert (slope >= 0.0).all()


def test_mean_and_fixed_phase_are_those_of_the_forces():
    phases = np.arange(64) / 64
    beyond = np.full((64, 2), 0.7)
    held = LAW.at_phase(0.3).force(phases, beyond)
    np.testing.assert_allclose(held, np.repeat(LAW.force(np.array([0.3]), beyond[:1]), 64, 0), rtol=1e-13)
    mean = LAW.force(phases, beyond).mean(0)
    np.testing.assert_allclose(LAW.mean().force(phases[:1], beyond[:1])[0], mean, rtol=1e-13)


@pytest.mark.parametrize(
    ("levels", "at_first"), [([0.0], 0.0), ([0.1, 0.2], 0.0), ([0.0, 0.2, 0.2], 0.0), ([0.0, 1.0], 1.0)]
)
def test_levels_that_do_not_rise_from_zero_and_forces_at_zero_are_refused(levels, at_first):
    forces = np.zeros((len(levels), 2, 1))
    forces[0, 1] = at_first
    with pytest.raises(ValueError, match="must"):
        ForceTable(np.array(levels), forces, forces)


def test_a_table_without_any_force_has_no_harmonics_and_no_breaks():
    nothing = np.zeros((3, 2, 4))
    law = load_dependent_law([ForceTable(np.array([0.0, 1.0, 2.0]), nothing, nothing)])
    np.testing.assert_array_equal(law.harmonic_fractions, np.zeros(4))
    assert law.breaks.size == 0


def test_contacts_are_evaluated_as_if_each_stood_alone():
    """Contacts are open throughout, in one piece, or in many: none changes the force of another one."""
    phases = np.linspace(0.0, 1.0, 40, endpoint=False)
    tables = shift_tables(4 * [two_pairs(9, 6, 1.5)], [0.0, 0.2, 0.5, 0.7])
    last = tables[0].levels[-1]
    beyond = np.zeros((2, 40, 4))
    beyond[..., 1] = 0.1 * tables[0].levels[1]
    beyond[..., 2] = 1.2 * last * np.sin(2.0 * np.pi * phases)
    beyond[1, :, 3] = np.linspace(0.0, 2.0 * last, 40)
    law = load_dependent_law(tables)
    for name in ("force", "slope"):
        found = getattr(law, name)(phases, beyond)
        for m, table in enumerate(tables):
            alone = load_dependent_law([table])
            for row, k in np.ndindex(2, 40):
                here = getattr(alone, name)(phases[k : k + 1], beyond[row, k : k + 1, m : m + 1])
                assert found[row, k, m] == pytest.approx(here[0, 0], rel=1e-12, abs=1e-15)
        assert not found[:, :, 0].any()
