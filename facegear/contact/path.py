"""Tooth pairs on the path of contact of the pitch section, where the unloaded flanks touch."""

from dataclasses import replace

from facegear.arrays import Integers
from facegear.contact.options import ContactOptions
from facegear.geometry.design import AssemblyErrors, PairDesign
from facegear.geometry.unloaded import PAIRS, unloaded_contact

TOUCHING_GAP = 1e-9
"""Gap (m) of conjugate flanks below which they count as touching; off the path it grows by micrometres."""


def pairs_to_try(design: PairDesign, phi1: float, options: ContactOptions) -> Integers:
    """Return the pairs that may carry load at a pinion angle: all, or with `path_only` those on the path of
    contact.

    The path is that of the nominal assembly: between the tips of pinion and gear at the radius m N2 / 2.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    phi1 : float
        Angle of the pinion, rad.
    options : ContactOptions
        Whether only pairs on the path count.

    Returns
    -------
    (p,) array of int
        Numbers of the pairs.
    """
    if not options.path_only:
        return PAIRS
    gaps = unloaded_contact(replace(design, assembly=AssemblyErrors()), [phi1]).gap[0]
    return PAIRS[gaps < TOUCHING_GAP]
