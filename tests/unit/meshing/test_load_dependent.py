"""Tables of forces from contact solutions, here of a formula: what they meet, and what they say of errors."""

import numpy as np
import pytest
from references import against, agrees

from facegear.arrays import Array
from facegear.errors import FacegearError
from facegear.meshing.fitted_law import (
    CROWDING,
    PIECES,
    FlankContacts,
    fitted_tables,
    force_table,
    forces_over_pitch,
    law_arrays,
    law_torques,
    level_table,
    table_error,
)
from facegear.meshing.load_dependent import load_dependent_law

PHASES = np.arange(32) / 32
C, N = 2.4e11, 1.5


def contacts(largest=24e3, depth=0.05) -> FlankContacts:
    """C (1 + depth cos) x^N solved for x at the forces of `law_torques`."""
    forces = np.array(law_torques(largest))
    factor = C * (1.0 + depth * np.cos(2.0 * np.pi * PHASES))
    deflections = (forces[:, None] / factor) ** (1.0 / N)
    return FlankContacts(forces, deflections, N * forces[:, None] / deflections)


def exact(amounts: Array) -> Array:
    return C * (1.0 + 0.05 * np.cos(2.0 * np.pi * PHASES)) * amounts**N


def test_torques_begin_with_a_light_touch_and_end_beyond_what_the_law_is_to_reach():
    torques = np.array(law_torques(1000.0))
    assert torques[-1] > 1000.0
    assert torques[0] < 0.05 * torques[-1]
    assert (np.diff(torques) > 0.0).all()


@against(
    "manufactured",
    "contacts solved from a formula of the force",
    capability="mesh_law",
    module="facegear.meshing.fitted_law",
)
def test_a_table_meets_the_law_that_its_contacts_come_from_and_reaches_the_torque_at_every_phase():
    (table,), (error,) = fitted_tables([contacts()], 8)
    assert error.excess <= 1.0
    law = load_dependent_law([table])
    for amount in np.linspace(table.levels[4], table.levels[-1], 23):
        found = law.force(PHASES, np.full((32, 1), amount))[:, 0]
        agrees(
            "force of the table, N",
            found,
            exact(np.full(32, amount)),
            absolute=1.3 * error.largest * error.force,
        )
    reached = law.force(PHASES, np.full((32, 1), table.levels[-1]))
    assert reached.min() >= 24e3


@against(
    "manufactured",
    "contacts solved from a formula of the force",
    capability="mesh_law",
    module="facegear.meshing.fitted_law",
)
def test_below_the_first_solution_the_force_falls_with_the_exponent_that_it_has_there():
    (table,), _ = fitted_tables([contacts()], 8)
    law = load_dependent_law([table])
    for part in (0.5, 0.25, 0.14):
        amount = np.full(32, part * table.levels[4])
        found = law.force(PHASES, amount[:, None])[:, 0]
        agrees("force below the first solution, N", found, exact(amount), relative=1e-2)


def test_a_table_of_more_levels_is_taken_only_where_fewer_miss_the_aim():
    """The slope jumps by two thirds at a deflection, like where a second pair joins."""
    smooth, forces = contacts(depth=0.0), np.array(law_torques(24e3))
    x = np.linspace(0.0, 1e-4, 20001)
    over = np.maximum(x - 2e-5, 0.0)
    reached = np.interp(forces, C * (x**N + 4e-3 * over), x)[:, None].repeat(32, axis=1)
    stiffness = C * (N * reached ** (N - 1.0) + 4e-3 * (reached > 2e-5))
    kinked = FlankContacts(forces, reached, stiffness)
    counts = [fitted_tables([one], 8)[0][0].levels.size for one in (smooth, kinked)]
    assert counts[0] < counts[1]


def test_the_error_is_that_at_torques_which_the_table_was_not_made_from():
    """Every second solution is off by 1 %: the table meets the others, and says how far it misses these."""
    scattered = contacts()
    scattered.deflections[1::2] *= 1.01
    _, (error,) = fitted_tables([scattered], 8)
    assert error.excess > 1.0
    parts = scattered.forces[1::2] / error.force
    expected = N * 0.01 * np.sqrt((parts**2).mean())
    assert error.rms == pytest.approx(expected, rel=0.05)


def test_the_error_of_a_table_falls_with_the_number_of_its_cubics():
    """On a smooth formula; on contact the kinks where pairs join decide."""
    fine = contacts(depth=0.0)
    errors = [
        table_error(force_table(fine.at(range(0, 13, 2)), pieces, 1.5, 4), fine.at(range(1, 13, 2))).rms
        for pieces in (1, 2, 4)
    ]
    assert errors[0] > 5.0 * errors[1] > 25.0 * errors[2]


@pytest.mark.parametrize("crowding", CROWDING)
@pytest.mark.parametrize("pieces", PIECES)
def test_a_table_moves_by_no_more_than_rounding_where_its_contacts_do(pieces, crowding):
    solved, draw = contacts().at(range(0, 13, 2)), np.random.default_rng(pieces)
    off = 1.0 + 1e-14 * draw.standard_normal((2, *solved.slopes.shape))
    moved = FlankContacts(solved.forces, off[0] * solved.deflections, off[1] * solved.slopes)
    first, second = (force_table(each, pieces, crowding, 8) for each in (solved, moved))
    for values, others in ((first.forces, second.forces), (first.slopes, second.slopes)):
        np.testing.assert_allclose(others, values, rtol=0.0, atol=1e-11 * np.abs(values).max())


def test_contacts_whose_force_falls_are_refused():
    wrong = contacts()
    with pytest.raises(FacegearError, match="falls"):
        fitted_tables([FlankContacts(wrong.forces, wrong.deflections, -wrong.slopes)], 8)


def test_every_flank_has_its_table_in_arrays_and_in_csv():
    tables, errors = fitted_tables([contacts(), contacts(depth=0.2)], 4)
    numbers = np.array([[0, 1], [0, 0]])
    arrays = law_arrays(tables, numbers)
    np.testing.assert_array_equal(arrays["level_m"][1], tables[1].levels)
    forces = forces_over_pitch(arrays, 1, PHASES, np.array([tables[1].levels[-1]]))
    assert forces.mean() == pytest.approx(tables[1].forces[-1, 1, 0])
    rows = level_table(tables, errors, numbers, 0.04)
    assert len(rows) == 4 * tables[0].levels.size
    back = rows.query("gear == 'upper' and flank == 'back'")
    np.testing.assert_allclose(back["force_n"], tables[1].forces[:, 1, 0])
    np.testing.assert_allclose(back["torque_n_m"], 0.04 * tables[1].forces[:, 1, 0])
