"""Equivalent radial load of ISO 281, and its factors X, Y and e.

The factors are those of single-row bearings in tables 3 and 8 of ISO 281:2007, which was not at hand. Every
digit of ball bearings was compared with a public program that transcribes table 3; eight more programs have
those of deep groove bearings, another one those of 10 degrees, and an NSK catalogue those of 40 degrees.
Catalogues print X of tapered roller bearings; their Y and e by the contact angle are from memory.
"""

import numpy as np

from facegear.arrays import Array
from facegear.bearings.elements import AnyBearing, RollerBearing

THRUSTS = np.array([0.172, 0.345, 0.689, 1.03, 1.38, 2.07, 3.45, 5.17, 6.89])
"""Thrust over Z D_w^2, N/mm2, in the rows of the factors at small contact angles."""
DEEP_GROOVE = (
    0.56,
    (2.30, 1.99, 1.71, 1.55, 1.45, 1.31, 1.15, 1.04, 1.00),
    (0.19, 0.22, 0.26, 0.28, 0.30, 0.34, 0.38, 0.42, 0.44),
)
"""X, and Y and e in the rows of THRUSTS, of ball bearings without contact angle; dimensionless."""
SMALL_ANGLES = {
    0.0: DEEP_GROOVE,
    5.0: DEEP_GROOVE,
    10.0: (
        0.46,
        (1.88, 1.71, 1.52, 1.41, 1.34, 1.23, 1.10, 1.01, 1.00),
        (0.29, 0.32, 0.36, 0.38, 0.40, 0.44, 0.49, 0.54, 0.54),
    ),
    15.0: (
        0.44,
        (1.47, 1.40, 1.30, 1.23, 1.19, 1.12, 1.02, 1.00, 1.00),
        (0.38, 0.40, 0.43, 0.46, 0.47, 0.50, 0.55, 0.56, 0.56),
    ),
}
"""X, and Y and e in the rows of THRUSTS, of ball bearings by contact angle in degrees; dimensionless."""
LARGE_ANGLES = np.array(
    [
        (20.0, 0.43, 1.00, 0.57),
        (25.0, 0.41, 0.87, 0.68),
        (30.0, 0.39, 0.76, 0.80),
        (35.0, 0.37, 0.66, 0.95),
        (40.0, 0.35, 0.57, 1.14),
        (45.0, 0.33, 0.50, 1.34),
    ]
)
"""Contact angle in degrees, X, Y and e of ball bearings, which do not depend on the thrust there."""


def equivalent_load(bearing: AnyBearing, force: Array) -> Array:
    """Return the equivalent radial load P of ISO 281, which knows no moments.

    Parameters
    ----------
    bearing : BallBearing or RollerBearing
        The bearing.
    force : (..., 5) array
        Loads along x, y, z (N) and about x, y (N m); signs and moments do not count.

    Returns
    -------
    (...) array
        N; not a number under thrust for ball bearings above 45 degrees.
    """
    radial, thrust = np.hypot(force[..., 0], force[..., 1]), np.abs(force[..., 2])
    limit, x, y = _load_factors(bearing, thrust)
    with np.errstate(invalid="ignore"):  # e is infinite, and a radial load of 0 leaves no number
        return np.where(thrust <= limit * radial, radial, x * radial + y * thrust)


def _load_factors(bearing: AnyBearing, thrust: Array) -> tuple[Array | float, Array | float, Array | float]:
    """Return e, X and Y at a thrust (...), N: P = X F_r + Y F_a where F_a > e F_r, else P = F_r. Between rows
    and angles of the tables they are interpolated linearly.
    """
    degrees = float(np.degrees(bearing.contact_angle))
    if isinstance(bearing, RollerBearing):
        if not bearing.contact_angle:
            return np.inf, 1.0, 0.0
        tangent = float(np.tan(bearing.contact_angle))
        return 1.5 * tangent, 0.4, 0.4 / tangent
    if degrees > LARGE_ANGLES[-1, 0] + 1e-9:
        return 0.0, np.nan, np.nan
    relative = thrust / (bearing.elements * (1e3 * bearing.element_diameter) ** 2)
    angles = np.array([*SMALL_ANGLES, *LARGE_ANGLES[:, 0]])
    rows = [
        *(
            (radial, np.interp(relative, THRUSTS, axial), np.interp(relative, THRUSTS, limits))
            for radial, axial, limits in SMALL_ANGLES.values()
        ),
        *LARGE_ANGLES[:, 1:].tolist(),
    ]
    last = min(int(np.searchsorted(angles, degrees, side="right")), len(angles) - 1)
    part = min((degrees - angles[last - 1]) / (angles[last] - angles[last - 1]), 1.0)
    x, y, limit = (
        (1.0 - part) * np.asarray(before) + part * np.asarray(after)
        for before, after in zip(rows[last - 1], rows[last], strict=True)
    )
    return limit, x, y
