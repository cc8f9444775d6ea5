"""Samples depend on their number alone, and have the distributions that were asked for."""

import numpy as np
import pytest
import scipy.stats
from hypothesis import given, settings
from hypothesis import strategies as st
from references import against, agrees

from facegear.studies.sampling import Cause, Distribution, Population, Shape, changes, index_samples, samples

SHAPES = {
    "normal": Distribution(Shape.NORMAL, centre=2.0, spread=3.0),
    "uniform": Distribution(Shape.UNIFORM, limits=(-1.0, 4.0)),
    "rayleigh": Distribution(Shape.RAYLEIGH, spread=2.0),
    "choice": Distribution(Shape.CHOICE, values=(1.0, 2.0, 5.0)),
}


def population(correlation=None, seed=1):
    causes = tuple(Cause(name, shape, ((name, 1.0),), "test") for name, shape in SHAPES.items())
    return Population(causes, seed, correlation)


INDEFINITE = np.eye(4) + 0.9 * (np.eye(4, k=1) + np.eye(4, k=-1))


@pytest.mark.parametrize("draw", [samples, index_samples])
@settings(max_examples=10, deadline=None)
@given(size=st.integers(1, 97), start=st.integers(0, 500))
def test_a_sample_is_the_same_to_the_bit_in_any_chunk(draw, size, start):
    whole = draw(population(), start, 120)
    parts = [draw(population(), start + at, min(size, 120 - at)) for at in range(0, 120, size)]
    assert np.array_equal(np.vstack(parts), whole)


def test_correlated_samples_are_the_same_to_the_bit_in_any_chunk():
    correlation = 0.3 + 0.7 * np.eye(4)
    whole = samples(population(correlation), 0, 100)
    parts = [samples(population(correlation), at, 1) for at in range(100)]
    assert np.array_equal(np.vstack(parts), whole)


@against(
    "third-party program",
    "scipy.stats",
    capability="tolerances_chunk tolerances",
    module="facegear.studies.sampling",
)
def test_samples_have_the_quantiles_of_their_distributions():
    found = samples(population(), 0, 4096)
    exact = [scipy.stats.norm(2.0, 3.0), scipy.stats.uniform(-1.0, 5.0), scipy.stats.rayleigh(scale=2.0)]
    for column, frozen in enumerate(exact):
        for level in (0.05, 0.5, 0.95):
            agrees(
                "share of samples below a quantile",
                np.mean(found[:, column] <= frozen.ppf(level)),
                level,
                absolute=2e-3,
            )
    assert {1.0, 2.0, 5.0} == set(found[:, 3])


@against(
    "third-party program",
    "scipy.stats.truncnorm",
    capability="tolerances_chunk tolerances",
    module="facegear.studies.sampling",
)
def test_normal_tolerance_cut_at_its_limits_keeps_them_and_its_shape():
    cut = Distribution(Shape.NORMAL, centre=0.0, spread=1.0, limits=(-1.0, 2.0))
    values = cut.quantile(np.linspace(1e-9, 1.0 - 1e-9, 1001))
    exact = scipy.stats.truncnorm(-1.0, 2.0).ppf(np.linspace(1e-9, 1.0 - 1e-9, 1001))
    agrees("quantile of a normal distribution that is cut", values, exact, absolute=1e-9)


@against(
    "analytic",
    "Spearman's rank correlation of a Gaussian copula",
    capability="tolerances_chunk tolerances",
    module="facegear.studies.sampling",
)
def test_rank_correlation_of_the_samples_is_the_one_asked_for():
    correlation = np.eye(4)
    correlation[0, 1] = correlation[1, 0] = 0.8
    found = samples(population(correlation), 0, 4096)
    exact = 6.0 / np.pi * np.arcsin(0.4)  # Spearman's rank correlation of a Gaussian copula
    agrees(
        "rank correlation", scipy.stats.spearmanr(found[:, 0], found[:, 1]).statistic, exact, absolute=5e-3
    )
    agrees(
        "rank correlation of independent causes",
        scipy.stats.spearmanr(found[:, 0], found[:, 2]).statistic,
        0.0,
        absolute=5e-3,
    )


def test_one_cause_moves_all_its_keys_by_their_gains():
    cause = Cause("shaft", SHAPES["normal"], (("a", 1.0), ("b", -2.0)), "test")
    other = Cause("rim", SHAPES["normal"], (("b", 1.0),), "test")
    assert changes(Population((cause, other), 1), [3.0, 5.0]) == {"a": 3.0, "b": -1.0}


def test_correlation_that_no_samples_can_have_is_refused():
    with pytest.raises(np.linalg.LinAlgError):
        population(INDEFINITE)


def test_sobol_design_takes_one_cause_at_a_time_from_the_second_point():
    rows = index_samples(population(), 0, 6 * 8).reshape(8, 6, 4)
    for cause in range(4):
        others = [column for column in range(4) if column != cause]
        assert np.array_equal(rows[:, 2 + cause, cause], rows[:, 1, cause])
        assert np.array_equal(rows[:, 2 + cause][:, others], rows[:, 0][:, others])
