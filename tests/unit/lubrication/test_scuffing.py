"""Scuffing temperatures of the standards' worked pair, and safeties."""

import numpy as np
from references import against, agrees

from facegear.lubrication.film import (
    allowed_flash_temperature,
    allowed_integral_temperature,
    integral_temperature,
    temperature_safety,
)


@against(
    "external source",
    "worked pair of ISO/TS 6336-20 and -21",
    capability="lubrication",
    module="facegear.lubrication.film",
)
def test_allowed_temperatures_are_those_of_the_worked_pair():
    agrees(
        "allowed flash temperature, C",
        allowed_flash_temperature(6, 1.0, 7.5644367**-0.05),
        153.2059177,
        relative=1e-8,
    )
    agrees(
        "allowed integral temperature, C",
        allowed_integral_temperature(6, 1.0, 1.0, 27.6e-6),
        152.1416167,
        relative=1e-8,
    )


@against(
    "external source",
    "worked pair of ISO/TS 6336-21",
    capability="lubrication",
    module="facegear.lubrication.film",
)
def test_integral_temperature_of_the_worked_pair():
    """Flash at the tip times X_eps along the path; the pair's bulk is the oil's 80 C and 0.7 X_S of it."""
    mean = 0.2915610792 * 41.65834324
    bulk = 80.0 + 0.7 * 1.2 * mean
    agrees("integral temperature, C", float(integral_temperature(bulk, mean)), 108.4215265, relative=1e-8)


def test_safety_is_the_ratio_of_rises_above_the_oil():
    assert temperature_safety(220.0, 80.0, [150.0, 80.0]).tolist() == [2.0, np.inf]
