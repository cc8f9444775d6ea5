from dataclasses import replace

import numpy as np
import pytest
from lumped_machines import make_machine

from facegear.dynamics.motion import Settings
from facegear.dynamics.steady_state.simulate import build_model, simulate, simulate_many
from facegear.dynamics.sweeps.assemble import SeamKind, assemble
from facegear.dynamics.sweeps.campbell import resonance
from facegear.dynamics.sweeps.plan import SweepPlan
from facegear.dynamics.sweeps.stored import SHAPES, from_arrays, to_arrays
from facegear.dynamics.sweeps.sweep import DEFLECTION, Piece, collect, run_chunk, run_speeds, tighter
from facegear.dynamics.sweeps.sweep_tables import jump_table, sweep_table
from facegear.dynamics.sweeps.whole_sweep import whole_sweep
from facegear.io import arrays
from facegear.transmission.modes import natural_modes
from facegear.validation.dynamics.convergence import convergence_table, not_converged

SETTINGS = Settings(tolerance=1e-5, settle=256, window=64, periodic_residual=1e-7, extensions=0)
AC_RMS = DEFLECTION.index("ac_rms")


def plan(chunks, overlap=4, directions=("up", "down")):
    return SweepPlan(4200.0, 5600.0, 15, directions, chunks, overlap, 1.0, SETTINGS)


@pytest.fixture(scope="module")
def model():
    return build_model(make_machine())


@pytest.fixture(scope="module")
def whole(model):
    one = plan(1)
    return whole_sweep(model, one, {name: [run_chunk(model, one, name, 0)] for name in one.directions})


def periodic(piece):
    return np.array([label.startswith("period-") for label in piece.labels])


def test_the_resonance_of_mode_17_hardens_with_a_jump_up_beyond_the_jump_down(model, whole):
    modes = natural_modes(model.machine.layout, 4.1e8)
    up = max(whole["up"].jumps, key=lambda jump: jump.before.max() / jump.after.max())
    down = max(whole["down"].jumps, key=lambda jump: jump.after.max() / jump.before.max())
    assert up.before.max() > 1.3 * up.after.max()
    assert up.speed_before > down.speed_after
    assert abs(up.speed_after - up.speed_before) <= 1.0
    # The branch ends in a fold: periodic with a multiplier near one, or passing slowly where the orbit was.
    assert up.multiplier > 0.95 or up.label_before == "not settled"
    found = resonance(whole["up"].piece, up.largest, modes, 23)
    assert (found.mode, found.order) == (17, 1.0)
    assert found.share > 0.8


@pytest.mark.parametrize("chunks", [2, 5])
def test_chunks_joined_give_the_whole_sweep(model, whole, chunks):
    pieces = plan(chunks)
    for name in pieces.directions:
        joined, seams = assemble(
            model, pieces, name, [run_chunk(model, pieces, name, k) for k in range(chunks)]
        )
        reference = whole[name].piece
        np.testing.assert_array_equal(joined.speeds, reference.speeds)
        both = periodic(joined) & periodic(reference)
        assert (periodic(joined) == periodic(reference)).all() or any(
            seam.kind is SeamKind.IRREGULAR for seam in seams
        )
        difference = np.abs(joined.deflection - reference.deflection)[both, AC_RMS]
        assert difference.max() < 1e-3 * reference.deflection[:, AC_RMS].max()


def test_a_chunk_that_starts_on_another_branch_is_run_again(model, whole):
    split = plan(2, overlap=0, directions=("up",))
    chunks = [run_chunk(model, split, "up", k) for k in range(2)]
    joined, seams = assemble(model, split, "up", chunks)
    assert seams[0].kind is SeamKind.RERUN and seams[0].rerun >= 1
    both = periodic(joined) & periodic(whole["up"].piece)
    difference = np.abs(joined.deflection - whole["up"].piece.deflection)[both, AC_RMS]
    assert difference.max() < 1e-3 * joined.deflection[:, AC_RMS].max()


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
    jobs = [(model, speed) for speed in (4500.0, 5000.0, 6000.0, 7500.0)]
    for one, two in zip(simulate_many(jobs, SETTINGS), simulate_many(jobs, SETTINGS, threads=2), strict=True):
        np.testing.assert_array_equal(one.deflections, two.deflections)


def test_rms_of_periodic_motions_does_not_move_when_tolerance_is_halved_and_dwell_doubled(model, whole):
    piece = whole["up"].piece
    for position in np.flatnonzero(periodic(piece))[::3]:
        speed = piece.speeds[position : position + 1]
        again = collect(model, run_speeds(model, speed, tighter(SETTINGS), piece.state(position)))
        np.testing.assert_allclose(
            again.deflection[0, AC_RMS],
            piece.deflection[position, AC_RMS],
            atol=1e-3 * piece.deflection[position, AC_RMS].max(),
        )


def test_tables_name_every_mesh_and_unit(model, whole):
    layout = model.machine.layout
    table = sweep_table(layout, "up", whole["up"].piece)
    assert list(table.columns) == ["direction", "speed_rpm", "quantity", "body_or_mesh", "value", "class"]
    assert set(layout.mesh_names) <= set(table["body_or_mesh"])
    shares = table[table["quantity"].isin(["open_share", "drive_share", "back_share"])]
    total = shares.groupby(["speed_rpm", "body_or_mesh"])["value"].sum()
    np.testing.assert_allclose(total, 1.0, atol=1e-9)
    jumps = jump_table(layout, "up", whole["up"], natural_modes(layout, 4.1e8))
    assert (jumps["speed_after_rpm"] - jumps["speed_before_rpm"]).abs().max() <= 1.0


def test_irregular_motion_has_a_positive_exponent_and_an_interval_on_its_rms(model):
    settings = Settings(tolerance=1e-6, window=512)
    response = simulate(model, 7500.0, settings)
    assert response.label == "chaotic"
    assert response.exponent[0] > response.exponent[1] > 0
    piece = collect(model, iter([(7500.0, response)]))
    interval = piece.deflection[0, DEFLECTION.index("ac_rms_interval")]
    assert (interval > 0).all()
    other = simulate(model, 7500.0, settings, response.state)
    second = collect(model, iter([(7500.0, other)]))
    gap = np.abs(second.deflection[0, AC_RMS] - piece.deflection[0, AC_RMS])
    doubt = interval + second.deflection[0, DEFLECTION.index("ac_rms_interval")]
    assert (gap < 3.0 * doubt).mean() >= 0.8


def test_convergence_names_the_speeds_that_moved_or_changed_class(whole):
    piece = whole["up"].piece
    first, second = np.flatnonzero(periodic(piece))[:2]
    deflection, labels = piece.deflection.copy(), piece.labels.astype("<U16")
    deflection[first] *= 1.02
    labels[second] = "period-7"
    table = convergence_table("up", piece, replace(piece, deflection=deflection, labels=labels))
    assert table["verdict"][first] == "moved"
    assert table["rms_change"][first] == pytest.approx(0.02)
    assert table["verdict"][second] == "other class"
    rest = table.drop([first, second])
    assert set(rest["verdict"]) <= {"converged", "irregular"}
    reported = not_converged(table)
    assert (
        f"up {piece.speeds[first]:.0f} rpm" in reported and f"up {piece.speeds[second]:.0f} rpm" in reported
    )
    assert reported.count("rpm") == 2
