"""Contact in fillets kept apart from that of the flanks.

Where a tip runs into the fillet of the other gear, a plane across the pinion's axis carries load at two
places: along the contact line of the flanks, and in the fillet, where an edge presses and pressure has no
limit as a mesh is refined.
"""

from dataclasses import replace

import numpy as np

from facegear.arrays import Array, Integers, Mask
from facegear.contact.flanks import PinionSurface
from facegear.contact.position import Spot
from facegear.geometry import pinion

APART = 2.0
"""Rows of the lattice between two loaded hats of a plane from which on they belong to two contacts."""


def line_rows(to_pinion_tip: Array, surface: PinionSurface) -> Array:
    """Row of the refined lattice at which contact lines that far (m) from the pinion's tip edge stand."""
    design = surface.design
    top, bottom = design.pinion_tip_roll, max(pinion.junction_roll(design), 0.0)
    height = design.pinion_base_radius * (top**2 - bottom**2) / 2
    rows = (surface.side.flank_rows - 1) * surface.lattice.refinement.profile
    return np.clip(to_pinion_tip / height, 0.0, 1.0) * rows


def on_flank(spot: Spot, line: Array, surface: PinionSurface) -> Spot:
    """The spot without what its tooth carries in a fillet, or beside one and apart from the contact line.

    line (n,): the row at which the contact line stands in each plane.
    """
    if not spot.fillet.any():
        return spot
    row, plane = np.divmod(spot.hats, surface.shape[1])
    keep = ~spot.fillet
    for number in np.unique(plane[spot.fillet]):
        here = np.flatnonzero(plane == number)
        keep[here] &= _of_the_line(row[here], spot.fillet[here], line[number])
    return replace(spot, hats=spot.hats[keep], force=spot.force[keep], fillet=spot.fillet[keep])


def _of_the_line(row: Integers, fillet: Mask, line: float) -> Mask:
    """Which loaded hats of a plane, in rows (m,), belong to no contact that lies in the fillet alone."""
    order = np.argsort(row, kind="stable")
    contact = np.zeros(row.size, np.int64)
    contact[order] = np.cumsum(np.diff(row[order], prepend=row[order[0]]) > APART)
    kept = np.ones(row.size, bool)
    for number in np.unique(contact[fillet]):
        own = contact == number
        if not row[own].min() - APART <= line <= row[own].max() + APART:
            kept[own] = False
    return kept
