"""Summaries of a response and of a sweep in one line."""

from collections import Counter
from collections.abc import Mapping

import numpy as np

from facegear.dynamics.steady_state.response import SteadyState
from facegear.dynamics.sweeps.jump_kinds import JumpKind
from facegear.dynamics.sweeps.whole_sweep import Direction
from facegear.number_format import count_noun

PULLS = 1e-3
"""Pull of a damper, over the largest elastic mesh force, from which it is reported."""


def response_summary(response: SteadyState) -> str:
    """Summarise the largest mesh force, class of motion, largest open fraction, and pull of the dampers.

    Parameters
    ----------
    response : SteadyState
        Response.

    Returns
    -------
    str
        One line.
    """
    parts = [f"largest mesh force {np.abs(response.forces).max():.4g} N", response.label]
    if response.looks is not None:
        parts.append(" from one start and ".join(map(_period_label, response.looks)) + " from another")
    parts.append(f"open for up to {100.0 * response.fractions[0].max():.0f} % of the time")
    past = float(response.past_law.max())
    if past > 0.0:
        parts.append(f"past the mesh law's last level for up to {100.0 * past:.2g} % of the time")
    pull = float(response.averages.pull.max())
    if pull > PULLS * np.abs(response.forces).max():
        parts.append(f"mesh dampers pull by up to {pull:.0f} N before flanks part")
    return ", ".join(parts)


def _period_label(period: int) -> str:
    return f"period-{period}" if period else "irregular"


def sweep_summary(directions: Mapping[str, Direction]) -> str:
    """Summarise jumps and periodic speeds in each direction, and seams that have not forgotten, if there are
    any.

    Parameters
    ----------
    directions : mapping
        Results of a sweep, by direction.

    Returns
    -------
    str
        One line.
    """
    parts = []
    for name, direction in directions.items():
        periods = direction.piece.period
        counts = f"{int((periods > 0).sum())} of {count_noun(len(periods), 'speed')} periodic"
        irregular = sum(seam.kind.value == "irregular" for seam in direction.seams)
        rerun = sum(seam.rerun for seam in direction.seams)
        changes = Counter(jump.kind is JumpKind.IRREGULAR for jump in direction.jumps)
        jumps = count_noun(changes[False], "jump")
        seams = f", seams: {count_noun(rerun, 'speed')} run again, {irregular} irregular" * bool(
            rerun or irregular
        )
        parts.append(f"{name}: {jumps}, {counts}{seams}")
    return "; ".join(parts)
