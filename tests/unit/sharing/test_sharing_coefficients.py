import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays
from references import against, agrees

from facegear.sharing.even_shares import lost_contact, sharing_coefficient

FORCE = st.floats(-1e6, 1e6, allow_subnormal=False).map(lambda x: 0.0 if abs(x) < 1e-3 else x)
LOADS = array_shapes(min_dims=2, max_dims=2, min_side=2, max_side=6).flatmap(
    lambda shape: arrays(float, shape, elements=FORCE)
)


@given(LOADS)
def test_coefficient_lies_between_one_and_the_number_of_paths(forces):
    value = sharing_coefficient(forces)
    defined = ~np.isnan(value)
    assert (value[defined] >= 1.0).all()
    assert (value[defined] <= forces.shape[-1]).all()


@given(LOADS)
def test_coefficient_is_undefined_only_where_nothing_carries_load(forces):
    value = sharing_coefficient(forces)
    np.testing.assert_array_equal(np.isnan(value), (forces == 0.0).all(axis=-1))


@given(LOADS, st.randoms(use_true_random=False))
def test_permuting_paths_changes_nothing(forces, random):
    order = list(range(forces.shape[-1]))
    random.shuffle(order)
    np.testing.assert_allclose(sharing_coefficient(forces[:, order]), sharing_coefficient(forces), rtol=1e-14)


@given(LOADS, st.floats(1e-3, 1e3))
def test_coefficient_ignores_flank_and_scale_of_the_load(forces, factor):
    np.testing.assert_allclose(sharing_coefficient(-factor * forces), sharing_coefficient(forces), rtol=1e-13)


@against(
    "analytic",
    "definition of the coefficient at its limits",
    capability="load_sharing",
    module="facegear.sharing.even_shares",
)
@pytest.mark.parametrize("paths", [2, 3, 7])
@given(force=st.floats(1e-2, 1e6))
def test_equal_loads_give_one_and_a_single_carrier_gives_the_number_of_paths(paths, force):
    agrees("coefficient of equal loads", sharing_coefficient(np.full(paths, force)), 1.0, absolute=1e-15)
    alone = np.zeros(paths)
    alone[-1] = -force
    agrees("coefficient of a single carrier", sharing_coefficient(alone), paths, relative=1e-15)


@against(
    "external source",
    "the paper, equations 25 and 26",
    capability="load_sharing",
    module="facegear.sharing.even_shares",
)
def test_equations_25_and_26_by_hand():
    agrees("coefficient of two paths", sharing_coefficient(np.array([300.0, -100.0])), 1.5, relative=1e-6)
    agrees(
        "coefficient of three paths", sharing_coefficient(np.array([-30.0, -20.0, 10.0])), 1.5, relative=1e-6
    )


def test_lost_contact_counts_a_path_without_force():
    np.testing.assert_array_equal(lost_contact(np.array([[1.0, 0.0], [1.0, -2.0]])), [True, False])
