"""Rows of a tooth section from its surface to its centre line."""

from itertools import pairwise

from hypothesis import given
from hypothesis import strategies as st

from facegear.teeth.section_topology import coarsening_levels, depth_rows


@given(st.floats(0.01, 0.75), st.floats(0.01, 2.0), st.floats(0.3, 3.0), st.none() | st.floats(0.1, 0.5))
def test_no_size_inside_the_tooth_makes_the_first_row_deeper_than_it_is_long(share, thickness, depth, second):
    """With half the thickness of medium meshes it was twice as deep, and root stress 2.7 % too low."""
    profile = share * depth
    rows = depth_rows(
        profile, thickness, depth, coarsening_levels(profile, thickness, depth), second and second * profile
    )
    assert rows[0].t0 == 0.0 and rows[-1].t1 == 1.0
    assert rows[0].t1 * depth <= 1.5 * profile
    assert all(row.t1 > row.t0 for row in rows)
    assert all(one.t1 == other.t0 for one, other in pairwise(rows))
