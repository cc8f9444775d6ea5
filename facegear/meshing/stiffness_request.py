"""Request for the stiffness stage; light to import, so that configs can be read without it."""

from dataclasses import dataclass
from typing import Literal

from facegear.harmonics import Harmonics

Definition = Literal["average", "local"]


@dataclass(frozen=True, eq=False)
class StiffnessRequest:
    """Source and load of the mesh stiffness.

    Attributes
    ----------
    source : str
        fem, fem_scaled or harmonics.
    mean : float or None
        Mean stiffness where it is given, N/m.
    torque : float or None
        Torque on the pinion per mesh, N m.
    definition : str
        average or local.
    order : int
        Number of orders kept.
    variation : float
        Factor on k(t) about its mean.
    given_series : Harmonics
        Series of the config, N/m; zero for the other sources.
    coast_series : Harmonics or None
        Series of the coast flanks in the config, N/m; None where they are as the drive flanks.
    """

    source: Literal["fem", "fem_scaled", "harmonics"]
    mean: float | None
    torque: float | None
    definition: Definition
    order: int
    variation: float
    given_series: Harmonics
    coast_series: Harmonics | None = None
