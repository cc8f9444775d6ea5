"""Friction of flanks: forces along directions of their own, each a ratio times the elastic force of a flank.

The ratio is a Fourier series in the mesh phase. The force is the law's, and goes to zero with slope zero or
more at the edge: it is continuous and depends on no velocity, so that friction shears no tangent and leaves
the divergence alone. A flank whose spring and damper together only push is rubbed by its spring until it
parts. Machines without friction pass None for both friction and series; what stands behind that question is
then not compiled.
"""

from facegear.arrays import Array
from facegear.dynamics.integrator.compiled import Rubbing
from facegear.dynamics.integrator.kernel import inlined
from facegear.dynamics.integrator.work import RubbingSeries
from facegear.machine_code.fourier import FourierScratch, fourier_terms
from facegear.machine_code.lanes import LANES, load, magnitude, multiply, multiply_add, splat, store
from facegear.mesh_law.terms import Lanes


@inlined
def rubbing_terms(
    rubbing: Rubbing | None, series: RubbingSeries | None, fourier: FourierScratch, s: float, rows: int
) -> None:
    """The first `rows` coefficients of all ratios at s."""
    if rubbing is None or series is None:
        return
    fourier_terms(fourier, rubbing.ratios, s, rows, series.ratios)


@inlined
def keep_elastic(series: RubbingSeries | None, side: Array, elastic: Lanes, i: int, c: int) -> None:
    """Keep coefficient i of the elastic forces (lanes) of the flanks from number c on; zero where apart."""
    if series is None:
        return
    store(series.forces, i * side.size + c, multiply(magnitude(load(side, c)), elastic))


@inlined
def rub(
    rubbing: Rubbing | None,
    series: RubbingSeries | None,
    side: Array,
    i: int,
    factor: float,
    y: Array,
    row: int,
) -> None:
    """Add coefficient i of the forces of friction, times the factor, to a row of the coordinates."""
    if rubbing is None or series is None:
        return
    n = rubbing.directions.shape[1]
    for k in range(rubbing.number):
        flank = rubbing.flank[k]
        if side[flank] == 0.0:
            continue
        total = 0.0
        for j in range(i + 1):
            total += series.ratios[j, k] * series.forces[i - j, flank]
        push = splat(factor * total)
        for c in range(0, n, LANES):
            at = row * n + c
            store(y, at, multiply_add(push, load(rubbing.directions, k * n + c), load(y, at)))
