"""What compiled functions ask of a law; every law is a NamedTuple type with implementations of its own.

The terms and the series of a law in a motion are records (facegear.machine_code.records).

The state of a contact is 0 where it is open, p in piece p of the law on its drive flank, and -p on the back
flank of a mesh whose two flanks share one line. `deflection` (rows, width) holds the Taylor coefficients of
the deflections, counted from the level at which the piece begins; on a back flank they are negative.
"""

from typing import Any

from facegear.arrays import Array, Integers
from facegear.machine_code.compiler import FAST, by_type
from facegear.machine_code.fourier import FourierScratch

Lanes = Any
"""LANES values side by side: those of the contacts from number c on."""


@by_type(**FAST)
def phase_terms(
    law: Any, series: Any, scratch: FourierScratch, s: float, ahead: float, piece: int, rows: int
) -> None:
    """Expand what depends on the phase alone: its first `rows` coefficients at phase s, rad.

    piece: number of the stretch between two breaks of the law; ahead: phase since the first of them.
    """


@by_type(**FAST)
def piece_terms(law: Any, series: Any, scratch: FourierScratch, state: Integers, s: float, rows: int) -> None:
    """Expand what depends on the phase and on the pieces that the contacts are in, once these are known: the
    first `rows` coefficients at phase s, rad.
    """


@by_type(**FAST)
def force_terms(law: Any, series: Any, state: Integers, deflection: Array, i: int, c: int) -> Lanes:
    """Coefficient i of the forces, from those up to i of the deflections. Open contacts may have any finite
    one.
    """


@by_type(**FAST)
def force_of(law: Any, series: Any, state: Integers, deflection: Array, i: int, m: int) -> float:
    """Coefficient i of the force of contact m alone, those before it known."""


@by_type(**FAST)
def slope_terms(law: Any, series: Any, state: Integers, deflection: Array, order: int) -> None:
    """Fill series.slope once the motion's coefficients and forces are known up to `order`."""


@by_type(**FAST)
def is_curved(law: Any) -> bool:
    """Whether the slope depends on the amount, so that its series changes with the motion."""


@by_type(**FAST)
def force_ahead(law: Any, series: Any, deflection: Lanes, order: int, step: Lanes, c: int) -> Lanes:
    """The forces at a step ahead, where the deflections (lanes) are given."""


@by_type(**FAST)
def piece_of(law: Any, m: int, amount: float) -> int:
    """The number, from 1, of the piece that holds an amount > 0 of contact m."""


@by_type(**FAST)
def piece_ends(law: Any, m: int, piece: int) -> tuple[float, float]:
    """The amounts at which a piece of contact m begins and ends; the last one ends at infinity."""
