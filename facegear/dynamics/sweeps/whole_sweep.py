"""A whole sweep from its chunks: both directions, seams, refined jumps."""

from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

from facegear.dynamics.steady_state.simulate import Model, simulate
from facegear.dynamics.sweeps.assemble import Seam, assemble
from facegear.dynamics.sweeps.jumps import Jump, refine, suspects
from facegear.dynamics.sweeps.plan import SweepPlan
from facegear.dynamics.sweeps.sweep import Piece


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
    """Join the chunks of every direction and bracket their jumps to the plan's resolution."""
    return {name: _direction(model, plan, name, parts, threads, step) for name, parts in chunks.items()}


def _direction(
    model: Model,
    plan: SweepPlan,
    name: str,
    chunks: list[tuple[Piece, Piece]],
    threads: int,
    step: Callable[[], None],
) -> Direction:
    piece, seams = assemble(model, plan, name, chunks)

    def bracket(position: int) -> Jump:
        jump = refine(
            piece,
            position,
            lambda speed, state: simulate(model, speed, plan.settings, state),
            plan.jump_resolution_rpm,
        )
        step()
        return jump

    with ThreadPoolExecutor(max(threads, 1)) as pool:
        jumps = [jump for jump in pool.map(bracket, suspects(piece)) if jump.abrupt]
    return Direction(piece, seams, jumps)
