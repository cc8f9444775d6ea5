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
"""Rows of the lattice between two loaded basis functions of a plane from which on they belong to two
contacts."""


def line_rows(to_pinion_tip: Array, surface: PinionSurface) -> Array:
    """Compute the row of the refined lattice at which contact lines lie.

    Parameters
    ----------
    to_pinion_tip : (...) array
        Distance of the line from the pinion's tip edge, m.
    surface : PinionSurface
        Contact surface of the pinion.

    Returns
    -------
    (...) array
        Row, dimensionless.
    """
    design = surface.design
    top, bottom = design.pinion_tip_roll, max(pinion.junction_roll(design), 0.0)
    height = design.pinion_base_radius * (top**2 - bottom**2) / 2
    rows = (surface.side.flank_rows - 1) * surface.lattice.refinement.profile
    return np.clip(to_pinion_tip / height, 0.0, 1.0) * rows


def on_flank(spot: Spot, line: Array, surface: PinionSurface) -> Spot:
    """Return the spot without the load in a fillet, and without load beside a fillet and apart from the
    contact line.

    Parameters
    ----------
    spot : Spot
        Loaded basis functions of a tooth pair.
    line : (n,) array
        Row at which the contact line lies in each plane, dimensionless.
    surface : PinionSurface
        Contact surface of the pinion.

    Returns
    -------
    Spot
        Load on the flank.
    """
    if not spot.fillet.any():
        return spot
    row, plane = np.divmod(spot.hats, surface.shape[1])
    keep = kept_hats(row, plane, spot.fillet, line, APART)
    return replace(spot, hats=spot.hats[keep], force=spot.force[keep], fillet=spot.fillet[keep])


def kept_hats(row: Integers, plane: Integers, fillet: Mask, line: Array, apart: float) -> Mask:
    """Mark the loaded basis functions that are neither in a fillet nor part of a contact in one.

    A contact consists of the basis functions of a plane that are no more than `apart` rows from the next.
    A contact that reaches a fillet lies in it, unless the plane's contact line is within `apart` rows of
    it.

    Parameters
    ----------
    row : (m,) array of int
        Row of each basis function.
    plane : (m,) array of int
        Plane of each basis function.
    fillet : (m,) array of bool
        Whether each presses on a fillet.
    line : (n,) array
        Row of the contact line in each plane, dimensionless.
    apart : float
        Distance in rows, dimensionless.

    Returns
    -------
    (m,) array of bool
        True on the flank.
    """
    order = np.lexsort((row, plane))
    row, plane = row[order], plane[order]
    begins = np.concatenate([[True], (np.diff(plane) != 0) | (np.diff(row) > apart)])[: row.size]
    first = np.flatnonzero(begins)
    low, high = row[first], row[np.append(first[1:], row.size) - 1]
    at_line = line[plane[first]]
    on_line = (low - apart <= at_line) & (at_line <= high + apart)
    in_fillet = np.logical_or.reduceat(fillet[order], first) if row.size else on_line
    is_on_flank = ~fillet
    is_on_flank[order] &= (on_line | ~in_fillet)[np.cumsum(begins) - 1]
    return is_on_flank
