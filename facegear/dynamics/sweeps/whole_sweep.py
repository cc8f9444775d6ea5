"""A whole sweep from its chunks: both directions, seams, refined jumps."""

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

from facegear.dynamics.run_plans import RunPlan, side_by_side
from facegear.dynamics.steady_state.simulate import Model, simulating
from facegear.dynamics.sweeps.assemble import Seam, assemble
from facegear.dynamics.sweeps.held_orbit import machine_follower
from facegear.dynamics.sweeps.jumps import Jump, refine, suspects
from facegear.dynamics.sweeps.plan import SweepPlan
from facegear.dynamics.sweeps.sweep import Piece
from facegear.dynamics.symmetries import mesh_images


@dataclass(frozen=True, eq=False)
class Direction:
    """Results of one direction of a sweep, in the order of running."""

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
    """Values of run plans that are dealt out to threads; the compiled part runs without the
    interpreter's lock.
    """
    count = max(threads, 1)
    with ThreadPoolExecutor(count) as pool:
        dealt = list(pool.map(side_by_side, [plans[first::count] for first in range(count)]))
    return [dealt[number % count][number // count] for number in range(len(plans))]
