"""How transmission error and path of the exact unloaded contact change with the pose of a pair.

The transmission error is stationary in the slope psi of the common normal, so that its derivatives are those
at constant psi: by offset and axial shift they are the normal itself. The path follows psi, whose derivatives
come from the condition that `facegear.geometry.conjugate` solves.
"""

from dataclasses import dataclass
from math import acos, cos, sin, tan

import numpy as np

from facegear.arrays import Array
from facegear.geometry.conjugate import ConjugateContact, PairNumbers
from facegear.geometry.design import AssemblyErrors


@dataclass(frozen=True, eq=False)
class ConjugateSlopes:
    """Derivatives by offset, axial shift (m/m) and the error of the shaft angle (m/rad), (3,) each.

    transmission_error, path: of `ConjugateContact.transmission_error` and `ConjugateContact.y`.
    """

    transmission_error: Array
    path: Array


def conjugate_slopes(pair: PairNumbers, errors: AssemblyErrors, contact: ConjugateContact) -> ConjugateSlopes:
    """Compute the derivatives of the contact of a pair by its errors.

    Parameters
    ----------
    pair : PairNumbers
        Numbers of the pair.
    errors : AssemblyErrors
        Errors of the assembly.
    contact : ConjugateContact
        Contact with these errors.

    Returns
    -------
    ConjugateSlopes
        Derivatives, m/m and m/rad.
    """
    psi, turn, tilt = contact.psi, contact.turn, errors.shaft_angle_error
    turn_by_tilt = tan(psi) / (cos(tilt) ** 2 * cos(turn))
    turn_by_psi = tan(tilt) / (cos(psi) ** 2 * cos(turn))
    by_turn = (
        cos(psi) * (cos(turn) * pair.mean_radius - sin(turn) * errors.offset)
        + pair.pinion_base_radius * cos(psi) * sin(turn) / sin(acos(cos(psi) * cos(turn)))
        - pair.gear_base_radius
    )
    missing_psi, missing_turn, condition_slopes = _condition_slopes(pair, errors, psi, turn)
    path_psi, path_turn, path = _path_slopes(pair, errors, psi, turn)
    by_errors = np.array([0.0, 0.0, turn_by_tilt])
    psi_by_errors = -(condition_slopes + missing_turn * by_errors) / (
        missing_psi + missing_turn * turn_by_psi
    )
    return ConjugateSlopes(
        np.array([cos(psi) * cos(turn), -sin(psi), by_turn * turn_by_tilt]),
        path + path_turn * by_errors + (path_psi + path_turn * turn_by_psi) * psi_by_errors,
    )


def _condition_slopes(
    pair: PairNumbers, errors: AssemblyErrors, psi: float, turn: float
) -> tuple[float, float, Array]:
    """Derivatives of the condition on psi by psi, by the turn of the normal, and by the errors (3,)."""
    tilt, base = errors.shaft_angle_error, pair.gear_base_radius
    across = cos(turn) * cos(tilt)
    along = errors.offset * cos(turn) + pair.mean_radius * sin(turn)
    beside = pair.mean_radius * cos(turn) - errors.offset * sin(turn)
    by_across = (
        pair.shaper_lift * cos(psi)
        - pair.shaper_base_radius
        - sin(psi) * along
        - cos(psi) * errors.axial_shift
    )
    by_psi = (
        across * (sin(psi) * (errors.axial_shift - pair.shaper_lift) - cos(psi) * along)
        - 2.0 * sin(tilt) * base * sin(psi) / cos(psi) ** 3
        + sin(tilt) * sin(psi) / cos(psi) ** 2 * beside
    )
    by_turn = -by_across * sin(turn) * cos(tilt) - across * sin(psi) * beside - sin(tilt) / cos(psi) * along
    by_tilt = -by_across * cos(turn) * sin(tilt) + cos(tilt) / cos(psi) * (beside - base / cos(psi))
    by_offset = -across * sin(psi) * cos(turn) - sin(tilt) * sin(turn) / cos(psi)
    return by_psi, by_turn, np.array([by_offset, -across * cos(psi), by_tilt])


def _path_slopes(
    pair: PairNumbers, errors: AssemblyErrors, psi: float, turn: float
) -> tuple[float, float, Array]:
    """Return the derivatives of the position along the pinion's axis by psi, by the turn, and by the errors
    (3,).
    """
    tilt, base = errors.shaft_angle_error, pair.shaper_base_radius
    x, y = -base * sin(psi), pair.gear_base_radius / cos(psi)
    high = pair.shaper_lift - base * cos(psi) - errors.axial_shift
    far = x * sin(turn) + y * cos(turn) - pair.mean_radius
    by_psi = cos(tilt) * (-base * cos(psi) * sin(turn) + y * tan(psi) * cos(turn))
    by_psi += sin(tilt) * base * sin(psi)
    by_turn = cos(tilt) * (x * cos(turn) - y * sin(turn))
    return by_psi, by_turn, np.array([0.0, -sin(tilt), cos(tilt) * high - sin(tilt) * far])
