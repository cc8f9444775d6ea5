"""One step of the integration: as far as the Taylor polynomials hold, or to the next contact switch."""

from facegear.arrays import Array
from facegear.dynamics.integrator.compiled import TAU, Packed
from facegear.dynamics.integrator.contact_states import correct_states, find_states
from facegear.dynamics.integrator.excitation import excitation
from facegear.dynamics.integrator.kernel import inlined
from facegear.dynamics.integrator.parting import correct_parting, find_parting
from facegear.dynamics.integrator.rings import ring_row
from facegear.dynamics.integrator.switches import until_switch
from facegear.dynamics.integrator.taylor import deflect, evaluate, recurrence, step_length
from facegear.dynamics.integrator.work import Work
from facegear.machine_code.lanes import LANES
from facegear.mesh_law.terms import force_terms, is_curved, piece_terms

ROUNDING = 1e-13
"""A step that ends this close to the end of a period (rad) ends there."""
MAX_GUESSES = 4


@inlined
def advance(
    packed: Packed, work: Work, s: float, stop: float, displacement: Array, velocity: Array, tolerance: float
) -> float:
    """Expand the motion at s and return the step length; work.y then holds the polynomials valid over it.

    displacement, velocity (n,) are read, not moved. The contact state is found from the motion itself.
    """
    piece = 0
    if packed.breaks.size > 0:
        while piece < packed.breaks.size - 2 and s >= packed.breaks[piece + 1] - 1e-13:
            piece += 1
        stop = min(stop, packed.breaks[piece + 1])
    for k in range(packed.n):
        work.y[0, k] = displacement[k]
        work.y[1, k] = velocity[k]
    excitation(packed, work, s, piece, work.order + 1)
    for m in range(packed.m):
        work.active[m] = 0.0
    for row in range(2):
        deflect(packed, work.y, row, work.error, work.deflection)
        ring_row(packed.rings, work.rings, work, row)
    find_states(packed, work)
    piece_terms(packed.law, work.law, work.fourier, work.state, s, work.order + 1)
    if packed.push_only:
        find_parting(packed, work)
    for _ in range(MAX_GUESSES):
        recurrence(packed, work, work.order, work.error, work.load, work.y, work.deflection, False)
        changed = correct_states(packed, work)
        if packed.push_only:
            changed = correct_parting(packed, work) or changed
        if not changed:
            break
        piece_terms(packed.law, work.law, work.fourier, work.state, s, work.order + 1)
    if is_curved(packed.law):
        for i in range(work.order - 1, work.order + 1):
            for c in range(0, packed.contacts, LANES):
                force_terms(packed.law, work.law, work.state, work.deflection, i, c)
    longest = stop - s
    length = step_length(packed, work, tolerance)
    if length >= longest:
        length = longest
    elif 2.0 * length > longest:
        length = 0.5 * longest
    return until_switch(packed, work, length)


@inlined
def after(s: float, length: float) -> float:
    """The phase at the end of a step, which is the period's end if it lies within rounding of it."""
    return TAU if TAU - (s + length) < ROUNDING else s + length


@inlined
def move(work: Work, length: float, displacement: Array, velocity: Array) -> None:
    """Move displacement and velocity (n,) to the end of the step."""
    evaluate(work.y, work.order, length, displacement, velocity)
