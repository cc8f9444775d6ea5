"""Laws of contacts at some phases of the mesh period, as statics takes them.

The kernel's counterparts are in `facegear/_kernels/src/statics/laws.hpp`.
"""

from typing import NamedTuple

from facegear.arrays import Array, Integers


class LinearHeld(NamedTuple):
    """Stiffness (K, M) in N/m of M contacts at K phases."""

    stiffness: Array


class LoadDependentHeld(NamedTuple):
    """Load-dependent law of M contacts at K phases.

    Attributes
    ----------
    stiffness : (K, M)
        Bounds of the slopes, N/m.
    cosine, sine : (K, harmonics + 1)
        Of the multiples of the phases.
    table : (kinds, levels, harmonics + 1, 2, 4)
        Series of the cubics' coefficients, sine part first, by powers of the amount since the level, N and m.
    levels : (kinds, levels)
        Amounts at which the cubics begin, m.
    kind : (M,)
        Row of the table of each contact.
    """

    stiffness: Array
    cosine: Array
    sine: Array
    table: Array
    levels: Array
    kind: Integers
