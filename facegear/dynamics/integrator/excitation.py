"""Taylor coefficients of what drives the motion: phase of the law, friction, transmission error, load."""

from facegear.dynamics.integrator.compiled import Packed
from facegear.dynamics.integrator.kernel import inlined
from facegear.dynamics.integrator.rubbing import rubbing_terms
from facegear.dynamics.integrator.work import Work
from facegear.machine_code.fourier import fourier_terms, give, shifted
from facegear.mesh_law.terms import phase_terms


@inlined
def excitation(packed: Packed, work: Work, s: float, piece: int, rows: int) -> None:
    """The first `rows` coefficients of law, friction, error, load at s, in stretch `piece` between breaks."""
    ahead = s - packed.breaks[piece] if packed.breaks.size > 0 else 0.0
    phase_terms(packed.law, work.law, work.fourier, s, ahead, piece, rows)
    rubbing_terms(packed.rubbing, work.rubbing, work.fourier, s, rows)
    fourier_terms(work.fourier, packed.error, s, rows, work.per_kind)
    give(work.per_kind, packed.error.shape[2], packed.error_kind, rows, work.error)
    if packed.drift.shape[0] > 0:
        _add_drift(packed, work, s)
    if packed.load.shape[0] > 1:
        fourier_terms(work.fourier, packed.load, s, rows, work.load)
    else:
        for k in range(packed.n):
            work.load[0, k] = packed.load[0, 1, k]


@inlined
def _add_drift(packed: Packed, work: Work, s: float) -> None:
    """Add the slow part of the error, a polynomial over the whole period, shifted to s."""
    terms = packed.drift.shape[0]
    for m in range(packed.m):
        shifted(packed.drift, m, terms, s, work.polynomial)
        for i in range(terms):
            work.error[i, m] += work.polynomial[i]
