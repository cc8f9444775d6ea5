"""A whole sweep from its chunks: both directions, seams, refined jumps."""

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

from facegear.dynamics.courses import Course, side_by_side
from facegear.dynamics.steady_state.simulate import Model, simulating
from facegear.dynamics.sweeps.assemble import Seam, assemble
from facegear.dynamics.sweeps.held_orbit import machine_follower
from facegear.dynamics.sweeps.jumps import Jump, refine, suspects
from facegear.dynamics.sweeps.plan import SweepPlan
from facegear.dynamics.sweeps.sweep import Piece
from facegear.dynamics.symmetries import mesh_images


@dataclass(frozen=True, eq=False)
class Direction:
    """One direction of a sweep, in the order of running."""

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
    """Join the chunks of every direction and bracket their jumps to the plan's resolution, side by side."""
    whole = {name: assemble(model, plan, name, parts) for name, parts in chunks.items()}

    follower, images = machine_follower(model, plan.settings), mesh_images(model.system)

    def bracketed(piece: Piece, position: int, thorough: bool) -> Course[Jump | None]:
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

    where = [(name, *suspect) for name, (piece, _) in whole.items() for suspect in suspects(piece).items()]
    jumps = _on_threads([bracketed(whole[name][0], at, abrupt) for name, at, abrupt in where], threads)
    named = [(name, jump) for (name, _, _), jump in zip(where, jumps, strict=True)]
    return {
        name: Direction(piece, seams, [jump for of, jump in named if of == name and jump is not None])
        for name, (piece, seams) in whole.items()
    }


def _on_threads(courses: Sequence[Course[Jump | None]], threads: int) -> list[Jump | None]:
    """What courses come to, dealt out to threads: the compiled part runs without the interpreter's lock."""
    count = max(threads, 1)
    with ThreadPoolExecutor(count) as pool:
        dealt = list(pool.map(side_by_side, [courses[first::count] for first in range(count)]))
    return [dealt[number % count][number // count] for number in range(len(courses))]
