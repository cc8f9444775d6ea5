"""Loads of a duty cycle on each flank, limits of materials, damage by Miner's rule, and reliability.

A load counts by its number and size in every bin; damage adds up by Miner's rule (Miner 1945).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import log, nan
from typing import TYPE_CHECKING

import numpy as np

from facegear.arrays import Array, Integers

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True)
class DutyBin:
    """Torque (N m) on the pinion in one mesh, speed of the pinion (turns a second) and time (s)."""

    torque: float
    speed: float
    time: float


@dataclass(frozen=True, eq=False)
class FlankDuty:
    """Loads of one flank of the teeth of one gear.

    Attributes
    ----------
    body
        Its name.
    gear
        `pinion` or `face_gear`, as which the body's teeth are rated.
    flank
        `drive` (the pinion drives), `back`, or `each` where both are loaded alike.
    bins : (n,)
        Bin of each load, from 0.
    torque : (n,)
        On the pinion with all load factors, N m.
    cycles : (n,)
        Of each load.
    opposite : (bins,)
        Largest torque of the other flank in each bin, 0 where it carries none.
    meshes
        Name of the mesh of each load, none where the duty cycle does not say.
    """

    body: str
    gear: str
    flank: str
    bins: Integers
    torque: Array
    cycles: Array
    opposite: Array
    meshes: tuple[str, ...] = ()

    @property
    def largest(self) -> float:
        """Torque (N m) of the largest load that occurs: a bin of the duty cycle may last no time."""
        return float(self.torque.max(where=self.cycles > 0.0, initial=0.0))


def given_duty(gear: str, duty: Sequence[DutyBin], turns: float, both_ways: bool) -> FlankDuty:
    """Return the loads of the teeth of one gear where the duty cycle gives one torque a bin.

    The cycles of a bin are turns * speed * time.

    Parameters
    ----------
    gear : str
        `pinion` or `face_gear`.
    duty : Sequence[DutyBin]
        Bins of the duty cycle.
    turns : float
        How often a tooth is loaded during one turn of the pinion, dimensionless number.
    both_ways : bool
        Whether both flanks carry every load.

    Returns
    -------
    FlankDuty
        Flank `each` where both flanks carry every load, else flank `drive`.
    """
    torque = np.array([load.torque for load in duty])
    return FlankDuty(
        body=gear,
        gear=gear,
        flank="each" if both_ways else "drive",
        bins=np.arange(len(duty)),
        torque=torque,
        cycles=np.array([turns * load.speed * load.time for load in duty]),
        opposite=torque if both_ways else np.zeros_like(torque),
    )


def machine_duty(
    spectrum: "pd.DataFrame", duty: Sequence[DutyBin], ratio: float, arms: Mapping[str, float]
) -> tuple[FlankDuty, ...]:
    """Return the loads of every flank that carries load in a machine, each from its own meshes.

    A tooth meets every mesh of its body once a turn of the body: cycles are its turns in the bin times
    `fraction`.

    Parameters
    ----------
    spectrum : DataFrame
        Columns as DUTY_SPECTRUM_COLUMNS; bins count from 1.
    duty : Sequence[DutyBin]
        Bins of the duty cycle.
    ratio : float
        Turns of a face gear for one of a pinion, dimensionless.
    arms : Mapping[str, float]
        Torque on the pinion of a force of 1 N along the normal of each flank, with the application factor, m.

    Returns
    -------
    tuple[FlankDuty, ...]
        Loads of each flank, pinions first.
    """
    turns = {"pinion": 1.0, "face_gear": ratio}
    passes = np.array([entry.speed * entry.time for entry in duty])
    max_force = spectrum.groupby(["body", "flank", "bin"])["force_n"].max()
    flanks = []
    for (body, gear, flank), rows in spectrum.groupby(["body", "gear", "flank"], sort=False):
        other_flank = "back" if flank == "drive" else "drive"
        bins = rows["bin"].to_numpy() - 1
        opposite = [max_force.get((body, other_flank, number + 1), 0.0) for number in range(len(duty))]
        flanks.append(
            FlankDuty(
                body=str(body),
                gear=str(gear),
                flank=str(flank),
                bins=bins,
                torque=arms[str(flank)] * rows["force_n"].to_numpy(),
                cycles=turns[str(gear)] * passes[bins] * rows["fraction"].to_numpy(),
                opposite=arms[other_flank] * np.array(opposite),
                meshes=tuple(rows["mesh"]),
            )
        )
    return tuple(sorted(flanks, key=lambda entry: entry.gear != "pinion"))


@dataclass(frozen=True)
class Life:
    """Life factor over load cycles: log-log straight lines between (cycles, factor) points.

    Constant before the first point (static strength) and beyond the last one.
    """

    cycles: tuple[float, ...]
    factors: tuple[float, ...]

    def factor(self, cycles: Array | float) -> Array:
        """Return the life factor at numbers of cycles.

        Parameters
        ----------
        cycles : (...) array or float
            Number of cycles.

        Returns
        -------
        (...) array
            Life factor, dimensionless, in the shape of `cycles`.
        """
        at = np.log(np.maximum(np.asarray(cycles, dtype=float), self.cycles[0]))
        return np.exp(np.interp(at, np.log(self.cycles), np.log(self.factors)))

    def allowed_cycles(self, factor: Array | float) -> Array:
        """Return how often a stress may be repeated.

        Parameters
        ----------
        factor : (...) array or float
            Stress over the limit, dimensionless.

        Returns
        -------
        (...) array
            Number of cycles, in the shape of `factor`: 0 above static strength, infinite at or below the
            factor of the last point.
        """
        level = np.asarray(factor, dtype=float)
        log_factors = np.log(self.factors[::-1])
        cycles = np.exp(np.interp(np.log(np.maximum(level, 1e-300)), log_factors, np.log(self.cycles[::-1])))
        return np.where(level > self.factors[0], 0.0, np.where(level <= self.factors[-1], np.inf, cycles))


@dataclass(frozen=True)
class PittingLimits:
    """Allowable contact stress: `limit` sigma_H lim in Pa.

    weibull_shape: of the distribution of lives; None where the card does not give it.
    """

    limit: float
    life: Life
    weibull_shape: float | None


@dataclass(frozen=True)
class BendingLimits:
    """Allowable root stress: `limit` sigma_F lim of the reference gear in Pa.

    slip_layer: thickness rho' in m; mean_stress: constant and slope of the mean stress ratio
    M = constant - slope Y_S. Either is None where the card does not give it; the factors that need it then
    stop the rating with its name. weibull_shape as for pitting.
    """

    limit: float
    life: Life
    weibull_shape: float | None
    slip_layer: float | None
    mean_stress: tuple[float, float] | None


@dataclass(frozen=True)
class MaterialCard:
    """A material with its elasticity and the limits its source gives; those it does not give are None.

    `name`, `source` and `grade` are texts; `young_modulus` in Pa.
    """

    name: str
    source: str
    grade: str
    young_modulus: float
    poisson_ratio: float
    pitting: PittingLimits | None
    bending: BendingLimits | None


LIMIT_RELIABILITY = 0.99
"""Reliability for which the limits of the standard hold: one failure in a hundred."""


def damage(stress: Array, cycles: Array, allowed_stress: float, life: Life) -> Array:
    """Compute the damage of each bin of a duty cycle: cycles over those allowed at its stress.

    Parameters
    ----------
    stress : (bins,) array
        Stress, Pa.
    cycles : (bins,) array
        Number of cycles.
    allowed_stress : float
        Stress that may be repeated for ever before life factors, Pa.
    life : Life
        Life factors of the material.

    Returns
    -------
    (bins,) array
        Damage, dimensionless; infinite where a stress is above static strength.
    """
    permitted = life.allowed_cycles(stress / allowed_stress)
    with np.errstate(divide="ignore", invalid="ignore"):
        shares = np.where(cycles > 0.0, cycles / permitted, 0.0)
    return np.asarray(shares, dtype=float)


def reliability(total: float, shape: float | None) -> float:
    """Compute the share of the gears that survive, LIMIT_RELIABILITY ** (total ** shape): Weibull from 0.

    Sum 1 is the life that LIMIT_RELIABILITY of the gears reach. Below every limit more than
    LIMIT_RELIABILITY survive, but the distribution of lives does not say how many.

    Parameters
    ----------
    total : float
        Miner's sum, dimensionless.
    shape : float or None
        Shape of the Weibull distribution, dimensionless; None where it is not known.

    Returns
    -------
    float
        Share, 0 to 1; nan without a shape, and for a sum of 0.
    """
    if shape is None or total == 0.0:
        return nan
    return float(np.exp(log(LIMIT_RELIABILITY) * total**shape))
