"""The part of the paper's claims that the fit uses; all others are held out."""

from dataclasses import dataclass


@dataclass(frozen=True)
class BacklashTarget:
    """Load sharing at one backlash 2b (m): means of inputs and idlers, minimum of the idlers in a cycle."""

    backlash: float
    inputs: float
    idlers: float
    idlers_minimum: float


@dataclass(frozen=True)
class Targets:
    """Coefficients at one speed, and speeds of jumps, all in rpm; what counts as one unit of misfit.

    Coefficients are compared absolutely, speeds relatively. A deviation counts at most `cap` units.
    """

    speed: float
    backlash: tuple[BacklashTarget, ...]
    jumps: tuple[float, ...]
    coefficient_tolerance: float = 0.15
    speed_tolerance: float = 0.03
    cap: float = 4.0
