"""Compiled: where all bodies stand when every flank, bearing and torque is in balance, position by position.

The energy of one-sided flanks, bearings (with clearance or without) and torques is convex and, with a
linear law and but for the rings, quadratic between changes of contact: a semismooth Newton method
(Hintermueller et al. 2003), each step an active set with its equations solved, with an exact line search that
makes it global. Pinions touch each other through the gears only, so each is eliminated by itself (3 x 3) and
the gears remain (4 or 6 unknowns each).

A body that nothing holds may be stopped by a flank that only just closes, by less than its position can be
resolved. Such a flank counts as closed in the next step, unless that would pull it open: the search would
else stay where it is.
"""

from pathlib import Path

import numpy as np

from facegear import mesh_law
from facegear.arrays import Array
from facegear.machine_code.compiler import compiler
from facegear.mesh_law.law import Held
from facegear.mesh_law.terms import held_force
from facegear.transmission.contact_energy import (
    OPTIONS,
    Springs,
    along,
    assemble,
    balance,
    inlined,
    penetrate,
    slope_along,
)

TIE, FIRST_TIE = 1e-10, 1e-1
"""Springs to ground in the matrix only, over the stiffest contact: they give free bodies a next position."""
MAX_STEPS = 200
JUST_CLOSED = 1e-9
"""Part of a whole step's approach by which a flank that stopped the step may still be open."""


@compiler(Path(__file__).parent, Path(str(mesh_law.__file__)).parent, **OPTIONS)
def settle_all(
    springs: Springs, held: Held, gap: Array, tolerance: float, displacement: Array
) -> tuple[Array, Array, Array]:
    """Displacements (K, n), flank forces (K, F), largest imbalance over the largest force (K,).

    held: the law of the flanks at K phases; gap (K, F): flanks are pressed in by J q - gap. `displacement`
    (n,) is where the first search starts; each later one starts from the one before. A position that is not
    solved keeps its residual.
    """
    count, flanks = gap.shape
    n = displacement.size
    gears = n - 3 * springs.pinion_bearing.shape[0]
    displacements, forces = np.zeros((count, n)), np.zeros((count, flanks))
    residuals = np.zeros(count)
    over, rate = np.zeros(flanks), np.zeros(flanks)
    stops, closed = np.zeros(flanks), np.zeros(flanks)
    gradient, step = np.zeros(n), np.zeros(n)
    blocks = np.zeros((springs.pinion_bearing.shape[0], 3, 4 + gears))
    core = np.zeros((gears, gears + 1))
    for k in range(count):
        stiffest = held.stiffness[k].max()
        tie = FIRST_TIE if k == 0 else TIE
        stops[:] = 0.0
        for _ in range(MAX_STEPS):
            penetrate(springs, gap[k], displacement, over)
            size = balance(springs, held, k, over, displacement, gradient)
            worst = np.abs(gradient).max()
            residuals[k] = worst / size if size > 0.0 else 0.0
            if worst <= tolerance * size:
                break
            for _ in range(2):
                for f in range(flanks):
                    closed[f] = 1.0 if over[f] > 0.0 else stops[f]
                _newton_step(
                    springs, held, k, over, closed, displacement, gradient, tie * stiffest, blocks, core, step
                )
                along(springs, step, rate)
                if (stops * rate).min() >= 0.0:
                    break
                stops[:] = 0.0
            tie = max(0.1 * tie, TIE)
            # Forces below the tolerance are no reason to go on: a free body would slide, the others with it.
            noise = tolerance * size * np.abs(step).sum()
            fraction = _line_minimum(springs, held, k, over, rate, displacement, step, noise)
            for f in range(flanks):
                near = over[f] + fraction * rate[f] >= -JUST_CLOSED * rate[f]
                stops[f] = 1.0 if over[f] <= 0.0 and rate[f] > 0.0 and near else 0.0
            for j in range(n):
                displacement[j] += fraction * step[j]
        for f in range(flanks):
            if over[f] > 0.0:
                forces[k, f], _ = held_force(held, k, f, over[f])
        for j in range(n):
            displacements[k, j] = displacement[j]
    return displacements, forces, residuals


@inlined
def _newton_step(
    springs: Springs,
    held: Held,
    position: int,
    over: Array,
    closed: Array,
    displacement: Array,
    gradient: Array,
    tie: float,
    blocks: Array,
    core: Array,
    step: Array,
) -> None:
    """Solve (curvature + tie) step = -gradient by block elimination, pinions first.

    blocks (P, 3, 4 + gears) holds each pinion's 3 x 3, its coupling to the gears and its right side.
    """
    assemble(springs, held, position, over, closed, displacement, gradient, tie, blocks, core)
    gears = core.shape[0]
    width = blocks.shape[2]
    for i in range(blocks.shape[0]):
        block = blocks[i]
        _eliminate(block)
        for r in range(3):
            for a in range(gears):
                factor = block[r, 3 + a]
                if factor != 0.0:
                    for b in range(a, gears):
                        core[a, b] -= factor * block[r, 3 + b]
                    core[a, gears] -= factor * block[r, width - 1]
    first = step.size - gears
    _solve_core(core, step[first:])
    for i in range(blocks.shape[0]):
        for r in range(2, -1, -1):
            total = blocks[i, r, width - 1]
            for b in range(gears):
                total -= blocks[i, r, 3 + b] * step[first + b]
            for c in range(r + 1, 3):
                total -= blocks[i, r, c] * step[3 * i + c]
            step[3 * i + r] = total / blocks[i, r, r]


@inlined
def _eliminate(block: Array) -> None:
    """Cholesky factor of the leading 3 x 3 (upper triangle), applied to the columns right of it."""
    for r in range(3):
        root = np.sqrt(block[r, r])
        for c in range(r, block.shape[1]):
            block[r, c] /= root
        for below in range(r + 1, 3):
            factor = block[r, below]
            for c in range(below, block.shape[1]):
                block[below, c] -= factor * block[r, c]


@inlined
def _solve_core(core: Array, out: Array) -> None:
    """Solve the gears' symmetric equations, upper triangle and right side in core (g, g + 1)."""
    size = core.shape[0]
    for r in range(size):
        for below in range(r + 1, size):
            factor = core[r, below] / core[r, r]
            for c in range(below, size + 1):
                core[below, c] -= factor * core[r, c]
    for r in range(size - 1, -1, -1):
        total = core[r, size]
        for c in range(r + 1, size):
            total -= core[r, c] * out[c]
        out[r] = total / core[r, r]


@inlined
def _line_minimum(
    springs: Springs,
    held: Held,
    position: int,
    over: Array,
    rate: Array,
    displacement: Array,
    step: Array,
    noise: float,
) -> float:
    """Where the energy is minimal along the step: 1 as long as no contact changes."""
    start, _ = slope_along(springs, held, position, over, rate, displacement, step, 0.0)
    slope, curvature = slope_along(springs, held, position, over, rate, displacement, step, 1.0)
    close = 1e-9 * abs(start) + noise
    if start >= 0.0 or abs(slope) <= close:
        return 1.0
    low, high, fraction = 0.0, 1.0, 1.0
    while slope < 0.0 and high < 1e30:
        low, high = high, 2.0 * high
        fraction = high
        slope, curvature = slope_along(springs, held, position, over, rate, displacement, step, fraction)
    for _ in range(200):
        if abs(slope) <= close or high - low <= 1e-15 * high:
            break
        fraction = fraction - slope / curvature if curvature > 0.0 else low
        if not low < fraction < high:
            fraction = 0.5 * (low + high)
        slope, curvature = slope_along(springs, held, position, over, rate, displacement, step, fraction)
        if slope < 0.0:
            low = fraction
        else:
            high = fraction
    return fraction
