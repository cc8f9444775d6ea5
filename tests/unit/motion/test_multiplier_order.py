"""Order in which Floquet multipliers stand in tables."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from facegear.motion.between_samples import by_modulus


@given(
    angles=st.lists(st.integers(1, 29), min_size=2, max_size=6),
    moduli=st.lists(st.sampled_from([0.2, 0.5, 0.9]), min_size=6, max_size=6),
    seed=st.integers(0, 1000),
)
def test_rounding_of_a_matrix_does_not_decide_the_order_of_its_multipliers(angles, moduli, seed):
    values = np.array([r * np.exp(0.1j * a) for r, a in zip(moduli, angles, strict=False)])
    values = np.concatenate([values, values.conj(), [0.5, -0.5, 0.9]])
    random = np.random.default_rng(seed)
    moved = values * (1.0 + 1e-14 * random.uniform(-1.0, 1.0, len(values)))
    moved = moved[random.permutation(len(values))]
    np.testing.assert_allclose(moved[by_modulus(moved)], values[by_modulus(values)], rtol=0, atol=1e-12)


def test_a_motion_without_multipliers_has_none_to_order():
    assert by_modulus(np.zeros(0, dtype=complex)).size == 0
