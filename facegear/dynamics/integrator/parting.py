"""Contacts that only push: spring and damper together are cut at zero where flanks are about to part.

    F = max(law(x) + c x', 0) while flanks overlap by x > 0; on the back flank with all signs reversed

(Hunt and Crossley, Journal of Applied Mechanics 42, 1975, on dampers that pull at the end of a contact). The
cut adds one edge to a contact, law(x) + c x' = 0. The force is continuous there, so tangents pass it
unchanged; it jumps only where flanks meet, by c x'.
"""

from facegear.dynamics.integrator.compiled import Packed
from facegear.dynamics.integrator.contact_states import SHORTEST, edge_margin
from facegear.dynamics.integrator.kernel import inlined
from facegear.dynamics.integrator.roots import first_root, root_after
from facegear.dynamics.integrator.work import Work
from facegear.mesh_law.terms import force_of

NO_FORCE = 1e-10
"""A force this small beside its spring's and its damper's part counts as zero: its rate decides what follows.
It is continuous, so that nothing is lost by it."""


@inlined
def find_parting(packed: Packed, work: Work) -> None:
    """Cut the force of every contact whose damper pulls more than its spring pushes."""
    for m in range(packed.contacts):
        work.at_parting[m] = 0
        if work.side[m] == 0.0 or abs(work.at_level[m]) == 1 or packed.lower[m] >= packed.upper[m]:
            continue
        spring = work.side[m] * force_of(packed.law, work.law, work.state, work.deflection, 0, m)
        damper = work.side[m] * packed.mesh_damping[m] * work.deflection[1, m]
        # Overlap, and with it the spring's force, is known to the rounding of the deflection.
        unknown = edge_margin(packed, work.deflection[1, m]) / _overlap(packed, work, m)
        if abs(spring + damper) <= NO_FORCE * (abs(spring) + abs(damper)) + unknown * abs(spring):
            work.at_parting[m] = 1
        _act(packed, work, m, spring + damper > 0.0)


@inlined
def _overlap(packed: Packed, work: Work, m: int) -> float:
    """How far the flanks of contact m overlap."""
    bound = packed.upper[m] if work.side[m] > 0.0 else packed.lower[m]
    return abs(work.deflection[0, m] + work.edge[m] - bound)


@inlined
def correct_parting(packed: Packed, work: Work) -> bool:
    """Where a contact's force is zero, its value after SHORTEST decides; True if one changed."""
    changed = False
    for m in range(packed.contacts):
        if work.at_parting[m] == 0:
            continue
        later = _push(packed, work, m, 1) + SHORTEST * _push(packed, work, m, 2)
        if (later > 0.0) != (work.active[m] > 0.0):
            _act(packed, work, m, later > 0.0)
            changed = True
    return changed


@inlined
def parting_time(packed: Packed, work: Work, m: int, length: float) -> float:
    """Share of the step at which the force of contact m passes zero; 2.0 if it does not."""
    first, power = work.at_parting[m], 1.0
    for i in range(work.order):
        inside = i + first < work.order
        work.polynomial[i] = power * _push(packed, work, m, i + first) if inside else 0.0
        power *= length
    root = first_root(work.polynomial, work.order - 1, work.conversion_less, work.subdivision)
    # Flanks that just met or parted: what follows at once was decided by the rates already.
    if (first > 0 or abs(work.at_level[m]) == 1) and root * length < SHORTEST:
        root = root_after(work.polynomial, work.order - 1, root, work.conversion_less, work.subdivision)
    return root


@inlined
def shearing_damping(packed: Packed, work: Work, m: int) -> float:
    """Mesh damping of contact m whose start or end makes the force jump, and so shears tangents."""
    return packed.mesh_damping[m] * abs(work.side[m]) if packed.push_only else work.acting[m]


@inlined
def _push(packed: Packed, work: Work, m: int, i: int) -> float:
    """Taylor coefficient i of what spring and damper of contact m push together."""
    spring = force_of(packed.law, work.law, work.state, work.deflection, i, m)
    return work.side[m] * (packed.mesh_damping[m] * (i + 1) * work.deflection[i + 1, m] + spring)


@inlined
def _act(packed: Packed, work: Work, m: int, acts: bool) -> None:
    work.active[m] = 1.0 if acts else 0.0
    work.acting[m] = packed.mesh_damping[m] if acts else 0.0
