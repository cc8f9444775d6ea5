from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from lumped_machines import make_layout, make_machine
from references import against, agrees

from facegear.harmonics import Harmonics
from facegear.machine.imperfections import Runout, perfect
from facegear.machine.kinematics import GEOMETRIC
from facegear.motion.plan import Settings
from facegear.motion.steady_state.simulate import build_model, simulate
from facegear.motion.track import SampledTrack, periodic_track
from facegear.sharing.even_shares import sharing_coefficient
from facegear.sharing.groups import SharingOptions, SpeedRange
from facegear.sharing.reference import reference_table, slow_forces, speed_range_table, static_forces
from facegear.sharing.run import load_sharing, load_sharing_of_many, measured_motion
from facegear.sharing.statistics import densely_sampled, same_orbit
from facegear.sharing.tables import CURVE_COLUMNS, SUMMARY_COLUMNS, curve_table, summary_table

OPTIONS = SharingOptions(64, 24, 2, 2e-5, 0, 0.95, 60.0, SpeedRange(2000.0, 9000.0, 3))
SETTINGS = Settings(tolerance=1e-4, settle=128)
SILENT = Harmonics(np.zeros(1), np.zeros(1))


@pytest.fixture(scope="module")
def tight(paper_machine):
    """Without backlash and transmission error: linear with periodic stiffness."""
    return replace(paper_machine, half_backlash=np.zeros(10), error=SILENT)


def test_quasi_static_coefficient_tends_to_the_static_one_as_speed_falls(tight):
    static = sharing_coefficient(static_forces(tight, 64)[..., [2, 7]])
    off = [
        np.abs(sharing_coefficient(slow_forces(tight, SETTINGS, rpm)[..., [2, 7]]) - static).max()
        for rpm in (400.0, 200.0, 100.0)
    ]
    assert off[1] < 0.7 * off[0]
    assert off[2] < 0.7 * off[1]
    assert off[2] < 0.01


@against(
    "analytic",
    "runouts and backlash of single meshes are in no standing coefficient",
    capability="load_sharing_reference",
    module="facegear.sharing.reference",
)
def test_what_a_run_is_held_against_leaves_out_what_it_says_of_every_mesh():
    """Runouts are in neither static nor slow motion; own e(t) and backlash go with the common ones."""
    layout = make_layout(kinematics=GEOMETRIC)
    flaws = replace(
        perfect(layout),
        pinion_runout=(Runout(2e-5, 0.3),) * 5,
        series={7: Harmonics(np.zeros(2), np.array([0.0, 2e-5]))},
    )
    plain, quick = make_machine(layout, 1500.0, 0.05, error=4e-6), replace(OPTIONS, slow_rpm=600.0)
    loose = np.where(np.arange(10) == 2, 40e-6, plain.half_backlash)
    table = reference_table(
        replace(plain, half_backlash=loose, imperfections=flaws), SETTINGS, quick
    ).set_index("quantity")
    exact = reference_table(plain, SETTINGS, quick).set_index("quantity")
    only_runout = replace(plain, imperfections=replace(flaws, series={}))
    still = reference_table(only_runout, SETTINGS, quick).set_index("quantity")
    agrees("static coefficient", still.loc["static", "mean"], exact.loc["static", "mean"], relative=1e-12)
    tight = "no_error_no_backlash"
    agrees(
        "coefficient without errors and backlash",
        table.loc[tight, "mean"],
        exact.loc[tight, "mean"],
        relative=1e-12,
    )


def test_without_errors_no_constant_error_and_no_pinion_out_of_place_is_left():
    """`no_error` kept both."""
    layout = make_layout(kinematics=GEOMETRIC)
    flaws = replace(perfect(layout), error=np.linspace(-8e-6, 8e-6, 10), position=np.full((5, 2), 5e-6))
    plain = make_machine(layout, 1500.0, 0.05, error=4e-6)
    clean, flawed = (
        reference_table(one, SETTINGS, replace(OPTIONS, slow_rpm=600.0)).set_index("quantity")["mean"]
        for one in (plain, replace(plain, imperfections=flaws))
    )
    for quantity in ("no_error", "no_error_no_backlash"):
        np.testing.assert_allclose(flawed[quantity], clean[quantity], rtol=1e-12)
    assert not np.allclose(flawed["static"], clean["static"], rtol=1e-4)


@against(
    "analytic",
    "mirror symmetry",
    capability="load_sharing",
    module="facegear.sharing.run",
)
def test_left_and_right_inputs_share_alike_where_the_machine_is_symmetric(tight):
    sharing = load_sharing(tight, 3000.0, SETTINGS, OPTIONS)
    right, left = (group.average.mean for group in sharing.groups[:2])
    assert sharing.response.label == "period-1"
    agrees("mean coefficient of an input", right, left, relative=1e-9)


def test_static_start_and_disturbed_starts_meet_where_only_one_motion_exists(tight):
    sharing = load_sharing(tight, 3000.0, SETTINGS, OPTIONS)
    for group in sharing.groups:
        assert group.starts_high - group.starts_low < 1e-4


def test_averages_belong_to_the_start_that_is_asked_for_and_the_range_to_all(paper_machine):
    """At 9500 rpm the second start ends on another motion than the first."""
    groups = [load_sharing(paper_machine, 9500.0, SETTINGS, OPTIONS, start).groups[0] for start in (0, 1)]
    means = sorted(group.average.mean for group in groups)
    assert means[1] - means[0] > 0.05
    for group in groups:
        assert [group.starts_low, group.starts_high] == pytest.approx(means, rel=1e-3)


def test_machines_side_by_side_share_as_each_does_by_itself(paper_machine):
    """Starts lead to one of two motions, which the range over the starts shows."""
    speeds = (3000.0, 5000.0, 6000.0, 7500.0, 9500.0, 10_000.0)
    together = load_sharing_of_many([(paper_machine, speed) for speed in speeds], SETTINGS, OPTIONS)
    for speed, many in zip(speeds, together, strict=True):
        one = load_sharing(paper_machine, speed, SETTINGS, OPTIONS)
        assert many.motions == one.motions
        assert many.response.period
        for group, expected in zip(many.groups, one.groups, strict=True):
            shares = [[part.average.mean, part.starts_low, part.starts_high] for part in (group, expected)]
            np.testing.assert_allclose(shares[0], shares[1], rtol=1e-9)


def test_places_alone_ask_for_no_slopes_of_a_motion_without_a_period():
    """A spline through all samples was made, and thrown away."""
    lone = SampledTrack(np.array([[1.0, 2.0]]), 1.0)
    assert lone.along(np.eye(2), np.zeros((2, 2))).tolist() == [[1.0], [2.0]]


def test_lost_contact_shows_where_a_coefficient_reaches_its_bound(paper_machine):
    sharing = load_sharing(paper_machine, 7500.0, SETTINGS, OPTIONS)
    inputs = sharing.groups[0]
    at_bound = inputs.coefficients == 2.0
    np.testing.assert_array_equal(at_bound, inputs.lost_contact & ~np.isnan(inputs.coefficients))


@against(
    "analytic",
    "143 teeth at 7500 rpm of 23",
    capability="load_sharing",
    module="facegear.sharing.tables",
)
def test_tables_hold_one_cycle_of_each_group_inside_its_envelope(paper_machine):
    sharing = load_sharing(paper_machine, 7500.0, SETTINGS, OPTIONS)
    curve, summary = curve_table(sharing), summary_table(sharing)
    assert tuple(curve.columns) == CURVE_COLUMNS
    assert tuple(summary.columns) == SUMMARY_COLUMNS
    assert curve.groupby("group").size().tolist() == [64, 64, 64]
    defined = curve.dropna()
    assert (defined["envelope_low"] <= defined["coefficient"]).all()
    assert (defined["coefficient"] <= defined["envelope_high"]).all()
    agrees("mesh period, s", curve["time_s"].max() * 64 / 63, 3.4783e-4, absolute=5e-9)


@against(
    "analytic",
    "limit of no speed: static equilibrium",
    capability="load_sharing_reference",
    module="facegear.sharing.reference",
)
def test_without_backlash_and_error_dynamics_vanish_at_low_speed_in_every_group(tight):
    table = reference_table(tight, SETTINGS, OPTIONS).set_index(["quantity", "group"])["mean"]
    for group in ("right input", "left input", "idlers"):
        agrees(
            "coefficient of the machine run slowly",
            table["quasi_static", group],
            table["static", group],
            absolute=1e-4,
        )
        agrees(
            "coefficient without errors and backlash",
            table["no_error_no_backlash", group],
            table["static", group],
            relative=1e-9,
        )


def test_speed_range_holds_every_speed_and_group(tight):
    table = speed_range_table(tight, SETTINGS, OPTIONS)
    assert sorted(set(table["speed_rpm"])) == [2000.0, 5500.0, 9000.0]
    assert (table["mean"] <= table["maximum"]).all()


def test_a_slow_approach_to_an_orbit_is_not_called_a_torus(paper_machine):
    """After 64 cycles this machine seems quasi-periodic; it comes to rest on a period-2 orbit."""
    machine = replace(
        paper_machine,
        torques=0.3 * paper_machine.torques,
        half_backlash=1.42 * paper_machine.half_backlash,
    )
    options = replace(OPTIONS, cycles=32, starts=1)
    sharing = load_sharing(machine, 8200.0, Settings(tolerance=1e-5), options)
    assert sharing.motions == ("period-2",)
    found = sharing.response
    assert found.periods_run > 3 * 32
    later = replace(found, coordinates=np.roll(found.coordinates, found.per_period, axis=0))
    assert same_orbit(found, later), "begun a cycle later"
    assert not same_orbit(found, replace(later, period=4))
    assert not same_orbit(found, replace(later, coordinates=1.01 * later.coordinates))


@against(
    "own convergence",
    "4096 samples a cycle",
    capability="load_sharing",
    module="facegear.motion.track",
)
@pytest.mark.parametrize("speed", [5000.0, 10_000.0])
def test_the_mean_of_a_periodic_motion_that_loses_contact_does_not_hang_on_its_samples(paper_machine, speed):
    few, many = (
        load_sharing(paper_machine, speed, SETTINGS, replace(OPTIONS, starts=1, samples=samples))
        for samples in (64, 4096)
    )
    for one, other in zip(few.groups, many.groups, strict=True):
        assert one.average.half_width == 0.0 < one.average.lost_fraction
        agrees("mean coefficient", one.average.mean, other.average.mean, absolute=1e-3)
        assert one.coefficients.shape[1] == 64


@against(
    "manufactured",
    "a sum of sines and cosines",
    capability="load_sharing",
    module="facegear.motion.track",
)
@given(
    waves=st.lists(st.tuples(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0)), min_size=1, max_size=7),
    factor=st.integers(1, 8),
)
def test_instants_between_the_samples_of_a_band_limited_series_are_exact(waves, factor):
    def series(count):
        cycles = np.arange(count)[:, None] / count
        return sum(
            a * np.sin(2 * np.pi * j * cycles) + b * np.cos(2 * np.pi * j * cycles)
            for j, (a, b) in enumerate(waves)
        )

    agrees(
        "value between the samples",
        periodic_track(series(16), 1.0, factor).along(np.ones((1, 1)), np.zeros((1, 1)))[0],
        series(16 * factor)[:, 0],
        relative=1e-7,
        absolute=1e-13,
    )


def test_a_machine_is_judged_by_the_motion_that_its_load_sharing_is_taken_from(tight):
    """Without what the groups make of it, which nobody asks for there."""
    model, single = build_model(tight), replace(OPTIONS, starts=1)
    alone = measured_motion(model, 6000.0, SETTINGS, single)
    shared = load_sharing(model, 6000.0, SETTINGS, single).motion
    np.testing.assert_array_equal(alone.response.coordinates, shared.response.coordinates)
    np.testing.assert_array_equal(alone.forces, shared.forces)


def test_forces_between_the_samples_are_those_of_a_run_with_as_many_samples(tight):
    model, precise = build_model(tight), replace(SETTINGS, tolerance=1e-9)
    few, many = (simulate(model, 6000.0, replace(precise, samples=samples)) for samples in (256, 2048))
    assert few.label == many.label == "period-1" and many.per_period == 2048
    dense = densely_sampled(few)
    np.testing.assert_allclose(dense.forces.T, many.forces, rtol=0, atol=1e-5 * np.abs(many.forces).max())
