"""Extremes of forces do not depend on how densely a motion is sampled."""

import numpy as np
import pytest
from lumped_machines import make_layout, make_machine
from references import against, agrees

from facegear.machine.kinematics import GEOMETRIC
from facegear.motion.bearing_forces import bearing_table
from facegear.motion.between_samples import finer, located_by_cycle, located_extremes
from facegear.motion.plan import Settings
from facegear.motion.steady_state.simulate import build_model, simulate
from facegear.sharing.running_machine import Running
from facegear.strength.duty_loads import history_of

RPM, GEOMETRIC_RPM = 6500.0, 2500.0
"""Speeds at which the machine of either kinematics moves periodically."""


def responding(samples, geometric=False):
    """A machine of the paper's layout and its response."""
    options, rpm = ({"kinematics": GEOMETRIC}, GEOMETRIC_RPM) if geometric else ({}, RPM)
    model = build_model(make_machine(make_layout(**options), 1500.0))
    return model, simulate(model, rpm, Settings(tolerance=1e-10, samples=samples))


def waves(phase, samples=32):
    """Two columns over one period: the first three orders, and a pulse that opens."""
    angle = 2.0 * np.pi * np.arange(samples) / samples + phase
    smooth = np.cos(angle) + 0.5 * np.cos(2.0 * angle + 1.0) + 0.2 * np.sin(3.0 * angle)
    return np.stack([smooth, np.maximum(0.3 + np.cos(angle), 0.0)], axis=1)


@pytest.mark.parametrize("phase", [0.0, 0.03, 0.11, 1.7])
def test_extremes_of_a_smooth_wave_are_found_between_its_samples(phase):
    dense = waves(0.0, 2**16)
    minimum, maximum = located_extremes(waves(phase), True)
    assert maximum == pytest.approx(dense.max(axis=0), rel=1e-5)
    assert minimum == pytest.approx(dense.min(axis=0), abs=1e-5)
    assert np.ptp(dense[:, 0]) - np.ptp(waves(phase)[:, 0]) > -1e-12


def test_an_extreme_at_the_seam_is_found_only_where_the_period_closes():
    values = waves(0.5 * np.pi / 16)
    whole, cut = (located_extremes(np.roll(values, 16, axis=0)[:, 1:], wraps)[1] for wraps in (True, False))
    assert whole == cut  # the top of the pulse lies in the middle here
    at_seam, beside = (located_extremes(values[:, 1:], wraps)[1] for wraps in (True, False))
    assert at_seam == pytest.approx([1.3], rel=1e-5)
    assert beside == values[:, 1:].max(axis=0)


def test_each_cycle_has_its_own_largest_value():
    sizes = np.array([1.0, 2.0, 1.5])[:, None, None]
    found = located_by_cycle(sizes * waves(2.5), True)
    assert found == pytest.approx(sizes[:, 0] * waves(0.0, 2**16).max(axis=0), rel=1e-4)


def test_a_contact_that_is_open_at_two_samples_is_open_between_them():
    pulse = waves(0.03)[:, 1]
    dense = finer(pulse, 8, True)
    assert dense[::8] == pytest.approx(pulse, abs=1e-12)
    assert dense.min() == 0.0
    assert dense.max() == pytest.approx(1.3, rel=1e-4)


@against(
    "own convergence",
    "4096 samples a mesh period",
    capability="dynamics_response dynamics_sweep",
    module="facegear.motion.between_samples",
)
@pytest.mark.parametrize("geometric", [False, True])
def test_the_largest_elastic_force_does_not_depend_on_the_samples(geometric):
    (_, coarse), (_, dense) = (responding(samples, geometric) for samples in (64, 4096))
    assert coarse.period == dense.period > 0
    expected = np.abs(dense.forces).max(axis=0)
    assert np.abs(np.abs(coarse.forces).max(axis=0) / expected - 1.0).max() > 1e-3
    agrees("largest elastic force, N", coarse.largest_forces, expected, relative=2e-5)


def test_the_peak_of_a_bearing_force_does_not_depend_on_the_samples():
    coarse, dense = (
        bearing_table(*responding(samples)).set_index(["body", "direction"]) for samples in (32, 2048)
    )
    large = dense["peak_n"] > 1e-3 * dense["peak_n"].max()
    assert coarse["peak_n"][large].to_numpy() == pytest.approx(dense["peak_n"][large].to_numpy(), rel=2e-4)


def test_a_duty_cycle_has_the_largest_force_between_the_samples():
    model, dense = responding(4096, geometric=True)
    coarse = history_of(model.machine, GEOMETRIC_RPM, Settings(tolerance=1e-10, samples=64))
    expected = np.maximum(dense.forces.max(axis=0), 0.0)
    assert coarse.largest.max(axis=0)[: expected.size] == pytest.approx(expected, rel=1e-4)


def test_the_largest_load_of_a_followed_machine_lies_between_its_positions():
    model, dense = responding(4096, geometric=True)
    _, coarse = responding(64, geometric=True)
    flanks = np.concatenate([np.maximum(coarse.forces, 0.0), np.maximum(-coarse.forces, 0.0)], axis=1)
    twice = np.tile(flanks, (2, 1))
    moving = Running(model.machine, 64, np.arange(len(twice)) / 64, twice, GEOMETRIC_RPM, 0, 0.0)
    assert moving.largest_loads == pytest.approx(np.abs(dense.forces).max(axis=0), rel=1e-4)
