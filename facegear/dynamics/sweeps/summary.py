"""One line about what a stage found."""

from collections import Counter
from collections.abc import Mapping

import numpy as np

from facegear.dynamics.steady_state.response import SteadyState
from facegear.dynamics.sweeps.jump_kinds import JumpKind
from facegear.dynamics.sweeps.whole_sweep import Direction

PULLS = 1e-3
"""Pull of a damper, over the largest elastic mesh force, that is worth a word."""


def response_summary(response: SteadyState) -> str:
    """Class of motion with its evidence, largest fraction of time out of contact, pull of the dampers."""
    parts = [response.label, f"change over the period {response.residual:.1e} of the length scale"]
    if response.looks is not None:
        parts.append(" from one start and ".join(map(_closed, response.looks)) + " from another")
    if response.multipliers is not None:
        parts.append(f"leading multiplier {abs(response.multipliers[0]):.4f}")
    if response.liouville is not None and np.isfinite(response.liouville):
        parts.append(f"Liouville check {response.liouville:.1e}")
    if response.exponent is not None:
        parts.append(
            f"largest exponent {response.exponent[0]:.3f} +- {response.exponent[1]:.3f} a mesh period"
        )
    parts.append(f"open for up to {100.0 * response.fractions[0].max():.0f} % of the time")
    past = float(response.past_law.max())
    if past > 0.0:
        parts.append(f"past the mesh law's last level for up to {100.0 * past:.2g} % of the time")
    pull = float(response.averages.pull.max())
    if pull > PULLS * np.abs(response.forces).max():
        parts.append(f"mesh dampers pull by up to {pull:.0f} N before flanks part")
    return ", ".join(parts)


def _closed(period: int) -> str:
    return f"period-{period}" if period else "irregular"


def sweep_summary(directions: Mapping[str, Direction]) -> str:
    """Jumps and counts of the classes of motion in each direction, and seams that have not forgotten."""
    parts = []
    for name, direction in directions.items():
        classes = Counter(direction.piece.motion.tolist())
        counts = ", ".join(f"{count} {label}" for label, count in classes.most_common())
        irregular = sum(seam.kind.value == "irregular" for seam in direction.seams)
        rerun = sum(seam.rerun for seam in direction.seams)
        doubted = int(np.isfinite(direction.piece.first_look_period).sum())
        counts += f" ({doubted} of them because another start came to another motion)" if doubted else ""
        changes = Counter(jump.kind is JumpKind.IRREGULAR for jump in direction.jumps)
        jumps = f"{changes[False]} jump{'s' * (changes[False] != 1)}"
        jumps += f", irregular motion begins or ends abruptly {changes[True]} times" * bool(changes[True])
        seams = f"seams: {rerun} speeds run again, {irregular} irregular"
        parts.append(f"{name}: {jumps}; {counts}; {seams}")
    return " | ".join(parts)
