"""A whole sweep from its chunks: both directions, seams, refined jumps, margin to the nearest."""

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from facegear.arrays import AnyArray, Arrays
from facegear.motion.plan import JumpRange, Settings, SweepPlan
from facegear.motion.requests import RunPlan, side_by_side
from facegear.motion.steady_state.mirror_images import held_symmetries
from facegear.motion.steady_state.simulate import Model, simulate, simulating
from facegear.motion.sweeps.held_orbit import SAME_ORBIT, distance, machine_follower
from facegear.motion.sweeps.jumps import Jump, refine, suspects
from facegear.motion.sweeps.sweep import Piece, collect, join_pieces, run_chunk, run_speeds
from facegear.motion.symmetries import Symmetry, mesh_images, symmetries

NAMES = tuple(Piece.__dataclass_fields__)
"""Names of the arrays of a part of a sweep."""
MAY_LACK = (
    "leading_multiplier",
    "exponent_per_period",
    "exponent_interval",
    "first_look_period",
    "second_look_period",
)
"""Fields of a piece that may be NaN."""
PER_SPEED = (
    "speeds",
    "motion",
    "period",
    "residual",
    "periods_run",
    "symmetry_broken",
    "modal_order",
    *MAY_LACK,
)
"""Fields of a piece with one value for each speed."""
DIMENSIONS = {
    **dict.fromkeys(NAMES, 2),
    **{name: 3 for name in NAMES if name.startswith("translation_")},
    **dict.fromkeys(PER_SPEED, 1),
    "spectrum": 3,
}
"""Number of dimensions of each field."""
_PER_PART: dict[str, tuple[int | None, ...]] = {
    **{name: (None,) * DIMENSIONS[name] for name in NAMES},
    **{f"{name}_known": (None,) for name in MAY_LACK},
}
"""Shape of each stored array; None stands for any length."""
SHAPES = {f"{part}_{name}": shape for part in ("before", "own") for name, shape in _PER_PART.items()}
"""Arrays of a file with their shapes; None is any length."""


def to_arrays(before: Piece, own_piece: Piece) -> dict[str, AnyArray]:
    """Return a chunk of a sweep as arrays that a file can hold.

    Parameters
    ----------
    before, own_piece : Piece
        Results at the overlap and at the own speeds.

    Returns
    -------
    dict
        Arrays with the names and shapes of SHAPES, such as (speeds, meshes). NaN is stored as 0, with
        False in the array `<name>_known`.
    """
    arrays: dict[str, AnyArray] = {}
    for part, piece in (("before", before), ("own", own_piece)):
        arrays |= {f"{part}_{name}": getattr(piece, name) for name in NAMES}
        for name in MAY_LACK:
            values = getattr(piece, name)
            arrays[f"{part}_{name}_known"] = ~np.isnan(values)
            arrays[f"{part}_{name}"] = np.nan_to_num(values)
    return arrays


def from_arrays(arrays: Arrays) -> tuple[Piece, Piece]:
    """Read a chunk of a sweep from the arrays of to_arrays().

    Parameters
    ----------
    arrays : Arrays
        Arrays of SHAPES.

    Returns
    -------
    tuple of Piece
        Results at the overlap and at the own speeds.
    """
    pieces = []
    for part in ("before", "own"):
        values = {name: arrays[f"{part}_{name}"] for name in NAMES}
        for name in MAY_LACK:
            values[name] = np.where(arrays[f"{part}_{name}_known"], values[name], np.nan)
        pieces.append(Piece(**values))
    return pieces[0], pieces[1]


class SeamKind(StrEnum):
    """Agreement of two chunks where they meet: equal periodic motions, run again, or irregular motions of
    equal AC RMS.
    """

    AGREEMENT = "agreed"
    RERUN = "rerun"
    IRREGULAR = "irregular"


@dataclass(frozen=True)
class Seam:
    """Junction of two chunks, and the number of speeds that had to be run again from the end of the first.

    `rerun` is that number. With kind `irregular`, both are in irregular motion there, whose state is
    never forgotten; the chunks agree in RMS only.
    """

    direction: str
    speed_rpm: float
    kind: SeamKind
    rerun: int


def same_response(first: Piece, i: int, second: Piece, j: int) -> SeamKind | None:
    """Compare two responses at one speed.

    Parameters
    ----------
    first : Piece
        First piece.
    i : int
        Position in it.
    second : Piece
        Second piece.
    j : int
        Position in it.

    Returns
    -------
    SeamKind or None
        AGREEMENT for periodic motions of equal period and AC RMS, IRREGULAR for motions that are not
        periodic and agree in AC RMS within their intervals; None for different motions.
    """
    rms, other_rms = first.deflection_ac_rms[i], second.deflection_ac_rms[j]
    periodic = first.periodic[i], second.periodic[j]
    if all(periodic):
        near = distance(rms, other_rms) <= SAME_ORBIT
        return SeamKind.AGREEMENT if near and first.period[i] == second.period[j] else None
    if any(periodic):
        return None
    doubt = first.deflection_ac_rms_interval[i] + second.deflection_ac_rms_interval[j]
    return SeamKind.IRREGULAR if (np.abs(rms - other_rms) <= 2.0 * doubt + SAME_ORBIT * rms).all() else None


def symmetries_at_end(model: Model, piece: Piece, settings: Settings) -> tuple[Symmetry, ...]:
    """Return the symmetries that map the last motion of a piece to itself.

    Parameters
    ----------
    model : Model
        Reduced machine.
    piece : Piece
        Results in the order of running.
    settings : Settings
        Settings of the run.

    Returns
    -------
    tuple of Symmetry
        All symmetries of the system where the motion is not periodic.
    """
    if not piece.symmetry_broken[-1]:
        return symmetries(model.system)
    return held_symmetries(simulate(model, float(piece.speeds[-1]), settings, piece.state(-1)))


def assemble(
    model: Model, plan: SweepPlan, direction: str, chunks: list[tuple[Piece, Piece]]
) -> tuple[Piece, list[Seam]]:
    """Join chunks; where a chunk started on another branch it is run again until it agrees.

    Parameters
    ----------
    model : Model
        Reduced machine.
    plan : SweepPlan
        Speeds and settings.
    direction : str
        "up" or "down".
    chunks : list of tuple
        Overlap and own speeds of each chunk.

    Returns
    -------
    Piece
        Results at all speeds.
    list of Seam
        Seams between the chunks, with the number of speeds run again at each.
    """
    whole = chunks[0][1]
    seams: list[Seam] = []
    for before, own_piece in chunks[1:]:
        speed = float(whole.speeds[-1])
        kind = same_response(whole, -1, before, -1) if len(before.speeds) else None
        if kind is not None:
            seams.append(Seam(direction, speed, kind, 0))
            whole = join_pieces([whole, own_piece])
            continue
        redone: list[Piece] = []
        start_symmetries = symmetries_at_end(model, whole, plan.settings)
        for i in range(len(own_piece.speeds)):
            state = (redone[-1] if redone else whole).state(-1)
            (again,) = run_speeds(
                model, own_piece.speeds[i : i + 1], plan.settings, state, start_symmetries=start_symmetries
            )
            redone.append(collect(model, iter([again])))
            start_symmetries = held_symmetries(again[1])
            if same_response(redone[-1], -1, own_piece, i) is not None:
                break
        seams.append(Seam(direction, speed, SeamKind.RERUN, len(redone)))
        whole = join_pieces([whole, *redone, own_piece.tail(len(redone))])
    return whole, seams


@dataclass(frozen=True, eq=False)
class Direction:
    """Results at all speeds of one direction of a sweep, in the order of running, with its seams and
    bracketed jumps.
    """

    piece: Piece
    seams: list[Seam]
    jumps: list[Jump]


def whole_sweep(
    model: Model,
    plan: SweepPlan,
    chunks: Mapping[str, list[tuple[Piece, Piece]]],
    threads: int = 1,
    step: Callable[[], None] = lambda: None,
) -> dict[str, Direction]:
    """Join the chunks of every direction and bracket their jumps to the plan's resolution, side by side.

    Parameters
    ----------
    model : Model
        Reduced machine.
    plan : SweepPlan
        Speeds and settings.
    chunks : mapping
        Overlap and own speeds of each chunk, by direction.
    threads : int
        Number of threads.
    step : callable
        Called without arguments after each suspected jump.

    Returns
    -------
    dict
        Results by direction.
    """
    whole = {name: assemble(model, plan, name, parts) for name, parts in chunks.items()}

    follower, images = machine_follower(model, plan.settings), mesh_images(model.system)

    def bracket_jump(piece: Piece, position: int, thorough: bool) -> RunPlan[Jump | None]:
        jump = yield from refine(
            piece,
            position,
            lambda speed, state: simulating(model, speed, plan.settings, state),
            follower,
            plan.jump_resolution_rpm,
            images,
            thorough,
        )
        step()
        return jump

    positions = [
        (name, *suspect) for name, (piece, _) in whole.items() for suspect in suspects(piece).items()
    ]
    jumps = _on_threads([bracket_jump(whole[name][0], at, abrupt) for name, at, abrupt in positions], threads)
    named_jumps = [(name, jump) for (name, _, _), jump in zip(positions, jumps, strict=True)]
    return {
        name: Direction(piece, seams, [jump for of, jump in named_jumps if of == name and jump is not None])
        for name, (piece, seams) in whole.items()
    }


def _on_threads(plans: Sequence[RunPlan[Jump | None]], threads: int) -> list[Jump | None]:
    """Run plans on several threads, every n-th plan on one, and return their values in the order of the
    plans.

    The compiled part runs without the interpreter's lock.
    """
    count = max(threads, 1)
    with ThreadPoolExecutor(count) as pool:
        dealt = list(pool.map(side_by_side, [plans[first::count] for first in range(count)]))
    return [dealt[number % count][number // count] for number in range(len(plans))]


def jump_margin(model: Model, speed_rpm: float, within: JumpRange) -> float:
    """Compute the distance from a speed to the nearest jump of sweeps up and down.

    A jump is defined in `facegear.motion.sweeps.jumps`, and lies at the nearer end of its bracket: the
    margin is 0 at a speed inside it. Jumps farther away than the range are not seen, nor are motions that
    neither sweep meets.

    Parameters
    ----------
    model : Model
        Reduced machine.
    speed_rpm : float
        Pinion speed, rpm.
    within : JumpRange
        Range around the speed.

    Returns
    -------
    float
        Distance, rpm; the range where there is no jump.

    Raises
    ------
    NotConverged
        If a run fails; the message names the speed.
    """
    plan = within.plan(speed_rpm)
    by_direction = whole_sweep(
        model, plan, {name: [run_chunk(model, plan, name, 0)] for name in plan.directions}
    )
    distances = [
        _distance(jump, speed_rpm) for direction in by_direction.values() for jump in direction.jumps
    ]
    return min([*distances, within.range_rpm])


def _distance(jump: Jump, speed: float) -> float:
    """Return by how much a speed lies outside a jump's bracket, rpm; 0 inside it."""
    low, high = sorted((jump.before.speed, jump.after.speed))
    return max(low - speed, speed - high, 0.0)
