"""Percentiles and indices against closed forms, with intervals that cover them."""

import numpy as np
import pytest
import scipy.stats
from references import against, agrees

from facegear.studies.sampling import Cause, Distribution, Population, Shape, index_samples, samples
from facegear.studies.statistics import HALVINGS, fraction_of, loosest, percentile, sobol_indices
from validation.scenarios.errors import statistics_errors

SPREADS = np.array([3.0, 2.0, 1.0])


def causes(shape, seed=1):
    named = (Cause(str(i), one, ((str(i), 1.0),), "test") for i, one in enumerate(shape))
    return Population(tuple(named), seed)


def linear(seed=1):
    return causes([Distribution(Shape.NORMAL, spread=spread) for spread in SPREADS], seed)


@against(
    "analytic",
    "normal distribution of a sum",
    capability="tolerances tolerances_map",
    module="facegear.studies.statistics",
)
def test_p95_of_a_linear_machine_with_normal_errors_is_that_of_the_closed_form():
    exact = scipy.stats.norm.ppf(0.95) * np.sqrt((SPREADS**2).sum())
    errors = {count: [] for count in (512, 8192)}
    for count, of_count in errors.items():
        for seed in range(8):
            found = percentile(samples(linear(seed), 0, count).sum(axis=1), 0.95)
            assert found.low < exact < found.high
            of_count.append(found.value / exact - 1.0)
    spread = {count: np.sqrt(np.mean(np.square(of_count))) for count, of_count in errors.items()}
    agrees("error of the 95th percentile, relative", errors[8192], 0.0, absolute=0.02)
    assert spread[8192] < spread[512] / np.sqrt(16.0)  # at least as fast as independent samples


@against(
    "analytic",
    "variance of a sum",
    capability="tolerances",
    module="facegear.studies.statistics",
)
def test_sobol_indices_of_a_linear_machine_are_shares_of_variance():
    values = index_samples(linear(), 0, 5 * 2048).sum(axis=1)
    found, exact = sobol_indices(values, 3), SPREADS**2 / (SPREADS**2).sum()
    for estimates in (found.first, found.total):
        agrees("Sobol index of a sum", [one.value for one in estimates], exact, absolute=0.02)


@against(
    "analytic",
    "Ishigami and Homma's function",
    capability="tolerances",
    module="facegear.studies.statistics",
)
def test_sobol_indices_of_ishigamis_function_are_the_known_ones():
    population = causes([Distribution(Shape.UNIFORM, limits=(-np.pi, np.pi))] * 3)
    x, y, z = index_samples(population, 0, 5 * 2048).T
    found = sobol_indices(np.sin(x) + 7.0 * np.sin(y) ** 2 + 0.1 * z**4 * np.sin(x), 3)
    for estimates, exact in ((found.first, (0.3139, 0.4424, 0.0)), (found.total, (0.5576, 0.4424, 0.2437))):
        agrees("Sobol index of Ishigami's function", [one.value for one in estimates], exact, absolute=0.02)
        assert all(one.low < value < one.high for one, value in zip(estimates, exact, strict=True))


def test_block_with_a_failed_sample_is_left_out_and_counted():
    values = index_samples(linear(), 0, 5 * 256).sum(axis=1)
    values[7] = np.nan
    found = sobol_indices(values, 3)
    assert (found.blocks, found.failed_blocks) == (128, 1)
    with pytest.raises(ValueError, match="whole"):
        sobol_indices(np.full(5, np.nan), 3)


def test_interval_of_a_percentile_covers_it_as_often_as_stated():
    rng = np.random.default_rng(5)
    exact = scipy.stats.norm.ppf(0.95)
    found = [percentile(rng.standard_normal(400), 0.95) for _ in range(400)]
    assert np.mean([one.low <= exact <= one.high for one in found]) >= 0.93
    assert percentile(rng.standard_normal(20), 0.99).high == np.inf


def test_share_comes_with_an_interval_that_never_leaves_zero_to_one():
    none = fraction_of(np.zeros(50, dtype=bool))
    assert (none.value, none.low) == (0.0, 0.0)
    assert 0.0 < none.high < 0.12


@pytest.mark.parametrize(("counts", "count"), [(0, 1), (1, 1), (3, 7), (50, 50), (999, 1000)])
@pytest.mark.parametrize("confidence", [0.8, 0.95])
def test_interval_of_a_fraction_is_wilsons(counts, count, confidence):
    computed = fraction_of(np.arange(count) < counts, confidence)
    expected = scipy.stats.binomtest(counts, count).proportion_ci(confidence, method="wilson")
    assert (computed.low, computed.high) == pytest.approx((expected.low, expected.high), rel=1e-14)


def test_errors_of_percentiles_and_indices_fall_as_docs_cluster_tells():
    few, many = statistics_errors([128, 8192]).itertuples()
    assert few.p95_error < 0.1 and many.p95_error < 0.01 and many.p99_error < 0.02
    assert few.total_index_error < 0.02 and many.total_index_error < 0.002


@against(
    "manufactured",
    "a quantity linear in the scale",
    capability="loosest_tolerances",
    module="facegear.studies.statistics",
)
def test_the_interval_of_the_loosest_scale_is_that_of_the_percentile_turned_round():
    deviations = np.random.default_rng(5).standard_normal(400)
    found = loosest(lambda scale: 1.0 + scale * deviations, 3.0, 0.9, 4.0)
    at_one = percentile(deviations, 0.9)
    agrees("scale of the tolerances", found.scale, 2.0 / at_one.value, absolute=4.0 / 2**HALVINGS)
    agrees("interval of the scale", found.interval, (2.0 / at_one.high, 2.0 / at_one.low), relative=1e-9)
    few = loosest(lambda scale: 1.0 + scale * deviations[:20], 3.0, 0.99, 4.0)
    assert few.interval[0] == 0.0, "twenty samples do not bound their 99th percentile from above"
    assert loosest(lambda scale: 1.0 + scale * deviations, 99.0, 0.9, 4.0).interval == (np.inf, np.inf)
