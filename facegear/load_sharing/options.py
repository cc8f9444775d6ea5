"""Settings of the load-sharing stage."""

from dataclasses import dataclass


@dataclass(frozen=True)
class SpeedRange:
    """Evenly spaced speeds in rpm, both ends included."""

    first: float
    last: float
    points: int


@dataclass(frozen=True)
class SharingOptions:
    """Samples a cycle, cycles and starts averaged, size (m at mesh) and seed of the starts' disturbance.

    Then the confidence level, the speed of the quasi-static run (rpm), and the range of speeds looked over.
    """

    samples: int
    cycles: int
    starts: int
    spread: float
    seed: int
    confidence: float
    slow_rpm: float
    speeds: SpeedRange
