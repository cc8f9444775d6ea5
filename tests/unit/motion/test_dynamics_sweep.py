from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import hypothesis.extra.numpy as hnp
import numpy as np
import pandas as pd
import pytest
from free_machines import natural_modes
from hypothesis import given
from hypothesis import strategies as st
from lumped_machines import make_machine
from scipy.signal import find_peaks

from facegear.io import arrays
from facegear.motion.between_samples import local_maxima
from facegear.motion.plan import JumpRange, Settings, SweepPlan
from facegear.motion.requests import alone
from facegear.motion.steady_state.simulate import build_model, simulate, start_run
from facegear.motion.sweeps.sweep import Piece, collect, run_chunk, run_speeds, tighter
from facegear.motion.sweeps.sweep_tables import jump_table, maxima, resonance, resonance_table, sweep_table
from facegear.motion.sweeps.whole_sweep import (
    SHAPES,
    SeamKind,
    assemble,
    from_arrays,
    jump_margin,
    to_arrays,
    whole_sweep,
)
from facegear.motion.symmetries import mesh_images
from facegear.report.figures.campbell import campbell
from validation.dynamics.convergence import LongRuns, convergence_table, not_converged, watched_longer

AS_THEY_ARE = np.arange(10)[None]
"""Images of a machine without symmetries."""
SETTINGS = Settings(tolerance=1e-5, settle=256, window=64, periodic_residual=1e-7, extensions=0)


def plan(chunks, overlap=4, directions=("up", "down")):
    return SweepPlan(4200.0, 5600.0, 15, directions, chunks, overlap, 1.0, SETTINGS)


@pytest.fixture(scope="module")
def model():
    return build_model(make_machine())


@pytest.fixture(scope="module")
def whole(model):
    one = plan(1)
    return whole_sweep(model, one, {name: [run_chunk(model, one, name, 0)] for name in one.directions})


def test_the_resonance_of_mode_17_hardens_with_a_jump_up_beyond_the_jump_down(model, whole):
    modes = natural_modes(model.machine.layout, 4.1e8)
    up = max(whole["up"].jumps, key=lambda jump: jump.before.ac_rms.max() / jump.after.ac_rms.max())
    down = max(whole["down"].jumps, key=lambda jump: jump.after.ac_rms.max() / jump.before.ac_rms.max())
    assert up.before.ac_rms.max() > 1.3 * up.after.ac_rms.max()
    assert up.before.speed > down.after.speed
    assert abs(up.after.speed - up.before.speed) <= 1.0
    # The branch ends in a fold: periodic with a multiplier near one, or passing slowly where the orbit was.
    assert up.before.multiplier > 0.95 or up.before.label == "not settled"
    found = resonance(whole["up"].piece, up.largest, modes, 23)
    assert (found.mode, found.order) == (17, 1.0)
    assert found.fraction > 0.8


@pytest.mark.parametrize(("speed", "direction"), [(4950.0, "down"), (5200.0, "up")])
def test_the_margin_of_a_speed_is_its_distance_from_the_nearest_jump_of_the_sweep(
    model, whole, speed, direction
):
    (jump,) = whole[direction].jumps
    between = 0.5 * (jump.before.speed + jump.after.speed)
    found = jump_margin(model, speed, JumpRange(400.0, 50.0, 1.0, SETTINGS))
    assert found == pytest.approx(abs(between - speed), abs=1.0)


def test_the_margin_is_0_at_a_jump_and_the_range_where_none_lies_in_it(model, whole):
    up = whole["up"].jumps[0]
    inside = 0.5 * (up.before.speed + up.after.speed)
    assert jump_margin(model, inside, JumpRange(400.0, 100.0, 1.0, SETTINGS)) < 1.0
    assert jump_margin(model, 4500.0, JumpRange(300.0, 100.0, 1.0, SETTINGS)) == 300.0


@given(st.floats(1.0, 1e5), st.floats(1.0, 1e4), st.floats(0.1, 1e3))
def test_jumps_are_looked_for_on_both_sides_in_steps_that_are_not_too_long(speed, reach, step):
    plan = JumpRange(reach, step, 1.0, SETTINGS).plan(speed)
    assert plan.first_rpm == max(speed - reach, 1.0) and plan.last_rpm == speed + reach
    assert plan.points >= 3 and np.diff(plan.speeds).max() <= step * (1.0 + 1e-9)


@pytest.mark.parametrize("chunks", [2, 5])
def test_chunks_joined_give_the_whole_sweep(model, whole, chunks):
    pieces = plan(chunks)
    for name in pieces.directions:
        joined, seams = assemble(
            model, pieces, name, [run_chunk(model, pieces, name, k) for k in range(chunks)]
        )
        reference = whole[name].piece
        np.testing.assert_array_equal(joined.speeds, reference.speeds)
        both = joined.periodic & reference.periodic
        assert (joined.periodic == reference.periodic).all() or any(
            seam.kind is SeamKind.IRREGULAR for seam in seams
        )
        difference = np.abs(joined.deflection_ac_rms - reference.deflection_ac_rms)[both]
        assert difference.max() < 1e-3 * reference.deflection_ac_rms.max()


def test_a_chunk_that_starts_on_another_branch_is_run_again(model, whole):
    split = plan(2, overlap=0, directions=("up",))
    chunks = [run_chunk(model, split, "up", k) for k in range(2)]
    joined, seams = assemble(model, split, "up", chunks)
    assert seams[0].kind is SeamKind.RERUN and seams[0].rerun >= 1
    both = joined.periodic & whole["up"].piece.periodic
    difference = np.abs(joined.deflection_ac_rms - whole["up"].piece.deflection_ac_rms)[both]
    assert difference.max() < 1e-3 * joined.deflection_ac_rms.max()


def test_a_stored_chunk_run_again_is_the_same_file(model, tmp_path):
    small = replace(plan(5), points=10)
    for name in ("first", "second"):
        before, own = run_chunk(model, small, "up", 2)
        arrays.write(tmp_path / f"{name}.npz", **to_arrays(before, own))
    assert (tmp_path / "first.npz").read_bytes() == (tmp_path / "second.npz").read_bytes()
    _, back = from_arrays(arrays.read(tmp_path / "first.npz", SHAPES))
    for field in Piece.__dataclass_fields__:
        np.testing.assert_array_equal(getattr(back, field), getattr(own, field))


def test_two_threads_give_the_same_results_as_one(model):
    speeds = (4500.0, 5000.0, 6000.0, 7500.0)

    def found(speed):
        return simulate(model, speed, SETTINGS).deflections

    with ThreadPoolExecutor(2) as pool:
        for speed, beside in zip(speeds, pool.map(found, speeds), strict=True):
            np.testing.assert_array_equal(beside, found(speed))


def test_rms_of_periodic_motions_does_not_move_when_tolerance_is_halved_and_dwell_doubled(model, whole):
    piece = whole["up"].piece
    for position in np.flatnonzero(piece.periodic)[::3]:
        speed = piece.speeds[position : position + 1]
        again = collect(model, run_speeds(model, speed, tighter(SETTINGS), piece.state(position)))
        np.testing.assert_allclose(
            again.deflection_ac_rms[0],
            piece.deflection_ac_rms[position],
            atol=1e-3 * piece.deflection_ac_rms[position].max(),
        )


def test_each_speed_starts_where_the_first_watch_of_the_one_before_has_ended(model):
    hasty = replace(SETTINGS, settle=64, window=32)
    speeds, state = np.array([4300.0, 15_000.0, 15_050.0]), None
    for speed, (same, response) in zip(speeds, run_speeds(model, speeds, hasty, None), strict=True):
        motion = alone(start_run(model, speed, hasty, state))
        expected, state = alone(motion.follow()), motion.state
        assert same == speed
        assert response.label == expected.label
        np.testing.assert_array_equal(response.deflections, expected.deflections)
        if response.period:
            np.testing.assert_array_equal(response.state.displacement, state.displacement)
        else:
            assert not np.array_equal(response.state.displacement, state.displacement)


def test_tables_name_every_mesh_and_unit(model, whole):
    layout = model.machine.layout
    table = sweep_table(layout, "up", whole["up"].piece)
    columns = ["direction", "speed_rpm", "quantity", "body_or_mesh", "value", "class", "periodic"]
    columns += ["after_irregular", "symmetry_broken"]
    assert list(table.columns) == columns
    assert (table["periodic"] == table["class"].str.startswith("period-")).all()
    assert set(layout.mesh_names) <= set(table["body_or_mesh"])
    shares = table[table["quantity"].isin(["open_fraction", "drive_fraction", "back_fraction"])]
    total = shares.groupby(["speed_rpm", "body_or_mesh"])["value"].sum()
    np.testing.assert_allclose(total, 1.0, atol=1e-9)
    jumps = jump_table(layout, "up", whole["up"], natural_modes(layout, 4.1e8))
    assert (jumps["speed_after_rpm"] - jumps["speed_before_rpm"]).abs().max() <= 1.0


def test_directions_that_move_by_rounding_alone_are_no_rows_of_the_table(model, whole):
    layout, piece = model.machine.layout, whole["up"].piece
    moved = piece.translation_rms.copy()
    moved[:, 0, 2] = 1e-15 * moved.max()
    noisy = sweep_table(layout, "up", replace(piece, translation_rms=moved))
    moved[:, 0, 2] = 0.0
    still = sweep_table(layout, "up", replace(piece, translation_rms=moved))
    pd.testing.assert_frame_equal(noisy, still)
    moved[:, 0, 2] = 1e-9 * moved.max()
    rows = sweep_table(layout, "up", replace(piece, translation_rms=moved))
    assert "z_rms_um" in set(rows["quantity"][rows["body_or_mesh"] == layout.body_names[0]])


def test_the_campbell_diagram_marks_a_resonance_at_its_order_of_the_mesh_frequency(model, whole):
    layout, modes = model.machine.layout, natural_modes(model.machine.layout, 4.1e8)
    jumps = jump_table(layout, "up", whole["up"], modes)
    found = resonance(whole["up"].piece, whole["up"].jumps[0].largest, modes, layout.pinion_teeth)
    assert (jumps["mode"][0], jumps["order"][0]) == (found.mode, found.order)
    assert jumps["periodic_before"][0] == (whole["up"].jumps[0].before.period > 0)
    peaks = resonance_table(layout, "up", whole["up"].piece, modes)
    frequencies = pd.DataFrame({"frequency_hz": [750.0], "class": ["pinion"]})
    # The text of a name is for readers: the marks come from the numbers beside it.
    figure = campbell(frequencies, peaks.assign(order=2.0), jumps.iloc[:0], layout.pinion_teeth, 5600.0)
    marks = next(mark for mark in figure.panels[0].marks if getattr(mark, "name", "") == "peaks")
    np.testing.assert_allclose(1e3 * marks.y, 2.0 * layout.pinion_teeth * marks.x / 60.0)


@given(hnp.arrays(float, st.integers(3, 30), elements=st.integers(0, 9).map(float)))
def test_a_maximum_stands_15_percent_over_the_minimum_on_either_side_before_a_larger_value(curve):
    curve = curve + 1e-3 * np.arange(curve.size) ** 0.5  # no plateaus
    expected = []
    for i in range(1, curve.size - 1):
        sides = [curve[:i][::-1], curve[i + 1 :]]
        higher = [np.append(np.flatnonzero(side > curve[i]), side.size)[0] for side in sides]
        reached = [side[:count] for side, count in zip(sides, higher, strict=True)]
        valley = max(part.min() if part.size else curve[i] for part in reached)
        if curve[i] > 1.15 * valley and curve[i] > 0.1 * curve.max():
            expected.append(i)
    assert maxima(curve) == expected


@given(hnp.arrays(float, st.integers(1, 30), elements=st.integers(-4, 4).map(float) | st.just(float("nan"))))
def test_maxima_and_how_far_they_stand_out_are_those_of_scipys_peaks(curve):
    """Few different values, so that many neighbours are equal."""
    positions, prominences = local_maxima(curve)
    expected, found = find_peaks(curve, prominence=0.0)
    assert positions.tolist() == expected.tolist()
    assert prominences.tolist() == found["prominences"].tolist()


def test_irregular_motion_has_a_positive_exponent_and_an_interval_on_its_rms(model):
    settings = Settings(tolerance=1e-6, window=512)
    response = simulate(model, 7500.0, settings)
    assert response.label == "chaotic"
    assert response.exponent[0] > response.exponent[1] > 0
    piece = collect(model, iter([(7500.0, response)]))
    interval = piece.deflection_ac_rms_interval[0]
    assert (interval > 0).all()
    other = simulate(model, 7500.0, settings, response.state)
    second = collect(model, iter([(7500.0, other)]))
    gap = np.abs(second.deflection_ac_rms[0] - piece.deflection_ac_rms[0])
    doubt = interval + second.deflection_ac_rms_interval[0]
    assert (gap < 3.0 * doubt).mean() >= 0.8


def test_convergence_names_the_speeds_that_moved_or_changed_class(model, whole):
    piece = whole["up"].piece
    first, second, third = np.flatnonzero(piece.periodic)[:3]
    ac_rms, period = piece.deflection_ac_rms.copy(), piece.period.copy()
    ac_rms[first] *= 1.02
    period[second], period[third] = 7, 0
    watched = {
        second: LongRuns(("period-1",) * 4, 1, piece.deflection_ac_rms[second] * 1.0001),
        third: LongRuns(("period-1", "period-1", "chaotic", "period-1"), None, ac_rms[third]),
    }
    finer = replace(piece, deflection_ac_rms=ac_rms, period=period)
    table = convergence_table("up", piece, finer, watched, mesh_images(model.system))
    assert table["verdict"][first] == "moved"
    assert table["rms_change"][first] == pytest.approx(0.02)
    assert (table["verdict"][second], table["verdict"][third]) == ("converged", "sensitive")
    assert table["rms_change"][second] == pytest.approx(1e-4)
    rest = table.drop([first, second, third])
    assert set(rest["verdict"]) <= {"converged", "irregular"}
    reported = not_converged(table)
    assert f"up {piece.speeds[first]:.0f} rpm" in reported and f"up {piece.speeds[third]:.0f} rpm" in reported
    assert reported.count("rpm") == 2


@pytest.mark.parametrize(
    ("label", "period", "in_all_four", "verdict"),
    [
        ("chaotic", 0, 3, "transient"),
        ("not settled", 0, 3, "not settled"),
        ("period-2", 2, 1, "wrong"),
        ("period-2", 2, 0, "wrong"),
        ("chaotic", 0, 0, "irregular"),
    ],
)
def test_a_class_that_changes_is_judged_by_what_four_long_runs_agree_on(
    whole, label, period, in_all_four, verdict
):
    piece = whole["up"].piece.part(slice(0, 1))
    named = "periodic" if period else label
    piece = replace(piece, motion=np.array([named]), period=np.array([period]))
    watched = LongRuns(("any",) * 4, in_all_four, piece.deflection_ac_rms[0])
    finer = replace(piece, period=np.array([in_all_four or 5]))
    assert convergence_table("up", piece, finer, {0: watched}, AS_THEY_ARE)["verdict"][0] == verdict


def test_an_orbit_that_one_run_took_for_another_is_watched_longer_from_both_states(model, whole):
    piece = whole["up"].piece.part(slice(0, 1))
    other = replace(piece, period=np.array([2]))
    watched = watched_longer(model, piece, other, SETTINGS)[0]
    assert watched.labels == ("period-1",) * 4 and watched.period == 1
    np.testing.assert_allclose(watched.ac_rms, piece.deflection_ac_rms[0], rtol=1e-3)


def test_convergence_counts_the_mirror_image_of_a_motion_as_the_same(model, whole):
    piece = whole["up"].piece.part(slice(0, 1))
    uneven = piece.deflection_ac_rms * np.linspace(1.0, 1.1, piece.deflection_ac_rms.shape[1])
    image = mesh_images(model.system)[1]
    first, other = (
        replace(piece, deflection_ac_rms=uneven),
        replace(piece, deflection_ac_rms=uneven[:, image]),
    )
    verdicts = [
        convergence_table("up", first, other, {}, images)["verdict"][0]
        for images in (mesh_images(model.system), AS_THEY_ARE)
    ]
    assert verdicts == ["converged", "moved"]
