"""A law behind a spring: what stands at an amount is the force that teeth and spring share there."""

from functools import cache

import numpy as np
import pytest
from force_tables import power_table, two_pairs
from hypothesis import given
from hypothesis import strategies as st

from facegear.meshing.force_table import ForceTable
from facegear.meshing.load_dependent import LoadDependentLaw, load_dependent_law, soften_table

ONE_WAVE = power_table(16, 0.2, first=0.05)
SMOOTH = ForceTable(
    ONE_WAVE.levels, *(np.pad(part, ((0, 0), (0, 0), (0, 6))) for part in (ONE_WAVE.forces, ONE_WAVE.slopes))
)
PAIRS = two_pairs(17, 12, 1.5)
COMPLIANCES = (0.01, 0.2, 2.0, 10.0)


@cache
def behind(table: ForceTable, compliance: float) -> LoadDependentLaw:
    return load_dependent_law([soften_table(table, compliance)])


@pytest.mark.parametrize(("table", "accuracy"), [(SMOOTH, 5e-4), (PAIRS, 5e-4)])
@given(st.floats(0.0, 1.0), st.floats(0.0, 1.0), st.sampled_from(COMPLIANCES))
def test_force_behind_a_spring_stands_where_teeth_and_spring_have_given_way(
    table, accuracy, cycle, fraction, compliance
):
    amount = np.array([[fraction * table.levels[-1]]])
    phase = np.array([cycle])
    force = load_dependent_law([table]).force(phase, amount)
    soft = behind(table, compliance)
    largest = load_dependent_law([table]).force(phase, table.levels[-1:, None])[0, 0]
    found = soft.force(phase, amount + compliance * force)
    assert found[0, 0] == pytest.approx(force[0, 0], abs=accuracy * largest)


def test_spring_makes_every_slope_softer_than_itself_and_keeps_forces_rising():
    for table in (SMOOTH, PAIRS):
        soft = soften_table(table, 0.5)
        assert soft.levels.size == 2 * table.levels.size - 1 and not soft.forces[0].any()
        assert soft.steepest < min(1.0 / 0.5, table.steepest) and soft.min_slope >= table.min_slope
        assert soften_table(table, 0.0) is table
