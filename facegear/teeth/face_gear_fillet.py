"""Fillet of the face gear in closed form: the envelope of the shaper's rounded tip."""

import numpy as np
from numpy.typing import ArrayLike

from facegear.arrays import Array
from facegear.teeth import closed_forms
from facegear.teeth.design import PairDesign
from facegear.teeth.face_gear import _newton, _stack_components, _together, edge_start, psi_at


def fillet_section(design: PairDesign, radius: ArrayLike, psi: ArrayLike) -> tuple[Array, Array]:
    """Compute gear angle and height of the fillet.

    psi runs from `fillet_start` to pi/2, where the fillet touches the root plane.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    radius : (...) array_like
        Gear radius, m.
    psi : (...) array_like
        Slope of the fillet's normal, rad.

    Returns
    -------
    tuple of (...) arrays
        Gear angle, rad, and z, m.
    """
    x, y, z = closed_forms.fillet_frame(*tip_numbers(design), psi, fillet_q(design, radius, psi))[:3]
    return np.arctan2(x, y), z


def fillet_q(design: PairDesign, radius: ArrayLike, psi: ArrayLike) -> Array:
    """Compute the position along its axis at which the shaper generates a point of the fillet.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    radius : (...) array_like
        Gear radius, m.
    psi : (...) array_like
        Slope of the fillet's normal, rad.

    Returns
    -------
    (...) array
        m.
    """
    radius, psi = _together(radius, psi)

    def residual(q: Array) -> tuple[Array, Array]:
        x, y, _, _, _, _, x_q, y_q, _ = closed_forms.fillet_frame(*tip_numbers(design), psi, q)
        return x * x + y * y - radius * radius, 2 * (x * x_q + y * y_q)

    return _newton(residual, radius, radius**2, "fillet at a gear radius")


def tip_numbers(design: PairDesign) -> tuple[float, float, float, float, float]:
    """Return the numbers of the shaper that `closed_forms.fillet_frame` takes.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    tuple[float, float, float, float, float]
        Centre (m), rounding (m), ratio m2s, lift (m) and chi_0 (rad).
    """
    centre, rounding = design.shaper_rounding_centre, design.shaper.tip_rounding
    return centre, rounding, design.shaper_ratio, design.shaper_lift, edge_start(design)


def fillet_start(design: PairDesign, radius: ArrayLike) -> Array:
    """Compute the slope psi where flank and fillet meet.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    radius : (...) array_like
        Gear radius, m.

    Returns
    -------
    (...) array
        rad.
    """
    return psi_at(design, radius, design.shaper_tip_roll)


def fillet_slopes(design: PairDesign, radius: ArrayLike, fraction: ArrayLike) -> Array:
    """Compute the slope psi at a fraction of the fillet's turn.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    radius : (...) array_like
        Gear radius, m.
    fraction : (...) array_like
        Fraction, 0 at the flank, 1 at the root.

    Returns
    -------
    (...) array
        rad.
    """
    start = fillet_start(design, radius)
    return start + np.asarray(fraction, float) * (np.pi / 2 - start)


def fillet_fraction(design: PairDesign, radius: ArrayLike, psi: ArrayLike) -> Array:
    """Compute the fraction of the fillet's turn at a slope, the inverse of `fillet_slopes`.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    radius : (...) array_like
        Gear radius, m.
    psi : (...) array_like
        Slope of the fillet's normal, rad.

    Returns
    -------
    (...) array
        Fraction, 0 at the flank, 1 at the root.
    """
    start = fillet_start(design, radius)
    return (np.asarray(psi, float) - start) / (np.pi / 2 - start)


def fillet_normal(design: PairDesign, radius: ArrayLike, psi: ArrayLike) -> Array:
    """Compute outward unit normals of the fillet.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    radius : (...) array_like
        Gear radius, m.
    psi : (...) array_like
        Slope of the fillet's normal, rad.

    Returns
    -------
    (..., 3) array
        Unit vectors, dimensionless.
    """
    centre, _, ratio, _, start = tip_numbers(design)
    psi = np.asarray(psi, float)
    chi = psi - np.arccos(ratio * fillet_q(design, radius, psi) * np.cos(psi) / centre)
    return _stack_components(*closed_forms.normal(ratio * (chi - start), psi))


def root_half_angle(design: PairDesign) -> float:
    """Compute the gear angle from the end of the fillet to the middle of the space.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    float
        rad; negative if the fillets overlap.
    """
    return np.pi / design.face_gear.teeth - design.shaper_ratio * edge_start(design)
