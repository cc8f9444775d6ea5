"""What is asked of the stiffness stage; light to import, so that configs can be read without it."""

from dataclasses import dataclass
from typing import Literal

from facegear.harmonics.series import Harmonics

Definition = Literal["average", "local"]


@dataclass(frozen=True, eq=False)
class StiffnessRequest:
    """Source of k(t); `mean` N/m where it is given, `torque` N m on the pinion per mesh, orders `order`,
    factor `variation` on k(t) about its mean.

    `given_series` is the series of the config; zero for the other sources.
    """

    source: Literal["fem", "fem_scaled", "harmonics"]
    mean: float | None
    torque: float | None
    definition: Definition
    order: int
    variation: float
    given_series: Harmonics
