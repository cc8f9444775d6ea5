"""Jumps of a symmetric machine lie where its motion is lost, on any grid, with any chunks and threads."""

from functools import cache

import numpy as np
import pytest
from references import against, agrees
from symmetric_machine import build_symmetric_model, load_gearbox, make_plan

from facegear.motion.branches.continuation import ContinuationSettings
from facegear.motion.branches.family import speed_family
from facegear.motion.branches.period_map import PeriodMap
from facegear.motion.branches.special import Kind
from facegear.motion.branches.switching import through
from facegear.motion.sweeps.sweep import collect, join_pieces, run_chunk, run_speeds
from facegear.motion.sweeps.whole_sweep import whole_sweep

GRIDS = [
    (9200.0, 9700.0, 6),
    (9480.0, 9640.0, 17),
    (9210.0, 9717.0, 9),
    (9000.0, 9710.0, 4),
    (9333.0, 9650.0, 11),
    (9250.0, 9990.0, 8),
]
FROM_ABOVE = [9700.0, 9600.0, 9500.0, 9400.0]
"""Speeds (rpm) that lead to one of the mirrored motions, which are stable beside the symmetric one."""


@cache
def find_branch_point(direction):
    """Speed (rpm) at which the branch of the sweep's motion breaks its symmetry, by continuation.

    Branches are followed with the speed unknown at a tolerance of 1e-10, and share no code with the search
    for jumps but the integrator.
    """
    speeds = np.array([9200.0, 9450.0] if direction == "up" else [9700.0, 9600.0])
    settings = make_plan(direction, GRIDS[0]).settings
    *_, (speed, response) = run_speeds(build_symmetric_model(), speeds, settings, None)
    period_map = PeriodMap(speed_family(build_symmetric_model()), 1, 1e-10)
    branch = through(period_map, response.state, speed, ContinuationSettings(9430.0, 9620.0))
    (special,) = branch.of(Kind.BRANCH)
    return special.point.value


def find_jump(direction, grid, chunks=1, threads=1):
    model, plan = build_symmetric_model(), make_plan(direction, grid, chunks)
    pieces = {direction: [run_chunk(model, plan, direction, k) for k in range(chunks)]}
    return whole_sweep(model, plan, pieces, threads)[direction].jumps[0]


def assert_holds_the_branch_point(jump, direction):
    low, high = sorted((jump.before.speed, jump.after.speed))
    assert (jump.kind, jump.error) == ("jump", pytest.approx(high - low))
    assert high - low <= 1.0
    middle = 0.5 * (low + high)
    agrees("speed of a jump, rpm", middle, find_branch_point(direction), absolute=0.5 * jump.error)


@against(
    "second implementation",
    "branch point by continuation along the arc, which shares the integrator alone",
    capability="dynamics_sweep",
    module="facegear.motion.sweeps.jumps",
)
@pytest.mark.parametrize("grid", GRIDS, ids=lambda grid: "-".join(f"{number:g}" for number in grid))
@pytest.mark.parametrize("direction", ["up", "down"])
def test_a_jump_where_symmetry_breaks_holds_the_branch_point_on_any_grid(grid, direction):
    assert_holds_the_branch_point(find_jump(direction, grid), direction)


@against(
    "second implementation",
    "branch point by continuation along the arc, which shares the integrator alone",
    capability="dynamics_sweep",
    module="facegear.motion.sweeps.whole_sweep",
)
@pytest.mark.parametrize("chunks", [2, 3])
def test_chunks_and_threads_leave_a_jump_where_symmetry_breaks_where_it_is(chunks):
    assert_holds_the_branch_point(find_jump("up", GRIDS[0], chunks, threads=2), "up")


def test_a_step_that_leaves_a_stable_motion_is_no_jump_and_errs_by_the_whole_step():
    model, plan = build_symmetric_model(), make_plan("up", (9300.0, 9400.0, 2))
    runs = [run_speeds(model, np.array(speeds), plan.settings, None) for speeds in ([9300.0], FROM_ABOVE)]
    before, after = (collect(model, run) for run in runs)
    piece = join_pieces([before, after.tail(3)])
    (jump,) = whole_sweep(model, plan, {"up": [(before.part(slice(0)), piece)]})["up"].jumps
    assert (jump.kind, jump.error) == ("step", 100.0)
    assert (jump.before.speed, jump.after.speed) == (9300.0, 9400.0)


def test_a_change_that_begins_or_ends_in_irregular_motion_is_listed_apart():
    gearbox = load_gearbox()
    result = gearbox.sweep(2600, 3600, points=11, directions=["up"])
    assert (result.jumps()["kind"] == "jump").all() and len(result.jumps())
    assert (result.irregular_ends()["kind"] == "irregular").all() and len(result.irregular_ends())
    assert len(result.jumps()) + len(result.irregular_ends()) == len(result.content["jumps"])
