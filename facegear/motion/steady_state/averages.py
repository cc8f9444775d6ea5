"""Averages of a response over time, exact for its step polynomials, and their confidence intervals."""

from dataclasses import dataclass, replace
from functools import cache

import numpy as np
import scipy

from facegear.arrays import Array
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.integrator.kernel_system import TAU
from facegear.motion.integrator.records import Sums

BATCHES = 16
"""Number of batches into which the window of a motion that is not periodic is divided."""
CONFIDENCE = 0.95
"""Probability with which an interval holds the mean."""
LARGEST_CORRELATION = 0.95
"""Correlation of successive batches above which so few of them cannot tell it from 1."""
MIN_INDEPENDENT = 3.0
"""Least number of independent batches that a run counts for."""
MIN_SHOWN = 0.1
"""Least part of the variance that batches are taken to show about their own mean."""
SLOW_WAVES = 4
"""Slowest waves over a run whose amplitudes give the variance of its mean."""


@dataclass(frozen=True, eq=False)
class Moments:
    """Moments of each column, such as a mesh, all (columns,) in the unit of the samples.

    The half-widths come from the spread between batches of periods; they are zero for a periodic motion.

    Attributes
    ----------
    mean, rms, ac_rms
        Mean, root mean square with and without the mean.
    minimum, maximum
        Extremes.
    rms_interval, ac_rms_interval
        Half-widths of the 95 % confidence intervals of rms and ac_rms.
    """

    mean: Array
    rms: Array
    ac_rms: Array
    minimum: Array
    maximum: Array
    rms_interval: Array
    ac_rms_interval: Array


@dataclass(frozen=True, eq=False)
class Averages:
    """Time averages over B batches of a window; M meshes, n coordinates.

    Attributes
    ----------
    weight : (B,)
        Number of mesh periods in each batch.
    level : (M,)
        Reference from which deflections are counted, m.
    deflection, square : (B, M)
        Mean of deflection - level, m, and of its square, m^2.
    minimum, maximum : (M,)
        Extremes of the deflections over the whole window, m.
    force : (2, M)
        Mean and mean magnitude of the elastic mesh force over the whole window.
    pull : (M,)
        Largest force by which the damper of a contact pulls its flanks together. Forces are in N in a
        response, over the squared mesh frequency as the kernels count them.
    origin : (n,)
        Reference from which the coordinates are counted.
    centre : (B, n)
        Mean of y - origin in each batch.
    products : (B, n, n)
        Mean of (y - origin) (y - origin)^T in each batch.
    """

    weight: Array
    level: Array
    deflection: Array
    square: Array
    minimum: Array
    maximum: Array
    force: Array
    pull: Array
    origin: Array
    centre: Array
    products: Array

    @property
    def centred_squares(self) -> Array:
        """Mean square (B, meshes) of the deflections in each batch, m^2, about their mean over the whole
        window.
        """
        off = self._whole(self.deflection)
        return self.square - 2.0 * off * self.deflection + off**2

    def meshes(self, periodic: bool) -> Moments:
        """Compute the moments of the mesh deflections over the whole window, with intervals from its
        batches.

        Parameters
        ----------
        periodic : bool
            Whether the motion is periodic; then the intervals are zero.

        Returns
        -------
        Moments
            Moments of each mesh, m.
        """
        off = self._whole(self.deflection)
        variance = np.maximum(self._whole(self.square) - off**2, 0.0)
        mean = self.level + off
        rms, ac_rms = np.sqrt(variance + mean**2), np.sqrt(variance)
        mean_offsets, centred_squares = self.deflection - off, self.centred_squares
        return Moments(
            mean=mean,
            rms=rms,
            ac_rms=ac_rms,
            minimum=self.minimum,
            maximum=self.maximum,
            rms_interval=_root_interval(centred_squares + 2.0 * mean * mean_offsets, rms, periodic),
            ac_rms_interval=_root_interval(centred_squares, ac_rms, periodic),
        )

    def views(self, views: Array, periodic: bool) -> tuple[Array, Array, Array]:
        """Compute the RMS of linear combinations of the coordinates.

        Parameters
        ----------
        views : (n, columns) array
            Weights of the coordinates in each combination, any unit.
        periodic : bool
            Whether the motion is periodic; then the intervals are zero.

        Returns
        -------
        tuple of array
            RMS, RMS without mean and its 95 % half-width, each (columns,), in the unit of the combination.
        """
        off = self._whole(self.centre)
        cross = off[:, None] * self.centre[:, None, :]
        about_mean = self.products - cross - cross.transpose(0, 2, 1) + np.outer(off, off)
        variances = np.maximum(((about_mean @ views) * views).sum(axis=1), 0.0)
        variance = self._whole(variances)
        ac_rms = np.sqrt(variance)
        mean = (self.origin + off) @ views
        return np.sqrt(variance + mean**2), ac_rms, _root_interval(variances, ac_rms, periodic)

    def part(self, batches: slice) -> "Averages":
        """Return the averages over some of the batches; extremes and forces stay those of all.

        Parameters
        ----------
        batches : slice
            Batches to keep.

        Returns
        -------
        Averages
            Averages of the selected batches.
        """
        names = ("weight", "deflection", "square", "centre", "products")
        return replace(self, **{name: getattr(self, name)[batches] for name in names})

    def _whole(self, batches: Array) -> Array:
        """Return the mean of batches (B, ...) weighted with their numbers of periods."""
        return np.tensordot(self.weight / self.weight.sum(), batches, 1)


def averages(integrator: Integrator, sums: Sums, periods: int) -> Averages:
    """Compute the averages from the integrals over a run; forces are still over the squared mesh
    frequency.

    Parameters
    ----------
    integrator : Integrator
        Integrates the system at one mesh frequency.
    sums : Sums
        Integrals over batches of the run.
    periods : int
        Number of mesh periods.

    Returns
    -------
    Averages
        Averages of each batch.
    """
    n, m = integrator.size, integrator.meshes
    batches = len(sums.coordinates)
    weight = np.bincount(np.arange(periods) * batches // periods, minlength=batches).astype(float)
    phase = TAU * weight[:, None]
    upper = np.triu(sums.products[:, :n, :n])
    products = upper + np.triu(upper, 1).transpose(0, 2, 1)
    return Averages(
        weight=weight,
        level=sums.level[:m],
        deflection=sums.deflections[:, :m] / phase,
        square=sums.squared[:, :m] / phase,
        minimum=sums.minimum[:m],
        maximum=sums.maximum[:m],
        force=sums.forces[:, :m] / (TAU * periods),
        pull=-sums.pull[: integrator.contacts].reshape(-1, m).min(axis=0),
        origin=sums.origin[:n],
        centre=sums.coordinates[:, :n] / phase,
        products=products / phase[:, None],
    )


def mean_interval(batches: Array, confidence: float = CONFIDENCE) -> Array:
    """Compute the half-width of the confidence interval of a mean from means of correlated batches.

    The half-width is the larger of two estimates. One takes the batches for an autoregressive series of first
    order and counts how many independent batches it is worth; it widens where a run is short beside the
    correlation time. The other takes the variance of the mean from the slowest waves over the run; it sees a
    slow change that is smaller than the scatter of single batches. A change that takes longer than a quarter
    of the run and is smaller than that scatter shows in neither.

    Parameters
    ----------
    batches : (B, columns) array
        Means over B batches of equal length, in their order in time, any unit.
    confidence : float
        Probability with which the interval holds the mean, a fraction.

    Returns
    -------
    (columns,) array
        Half-width in the unit of the batches; zero from a single batch, which says nothing.

    References
    ----------
    Marriott and Pope 1954, bias of the correlation. Lazarus, Lewis, Stock and Watson (2018), variance of a
    mean from its slowest cosines, with as many degrees of freedom as cosines.
    """
    if len(batches) < 2:
        return independent_interval(batches, confidence)
    return np.maximum(_autoregressive_interval(batches, confidence), _slow_wave_interval(batches, confidence))


def successive_interval(batches: Array, confidence: float = CONFIDENCE) -> Array:
    """Compute the half-width of the confidence interval of a mean from the correlation of successive
    batches alone.

    It serves for a few batches, such as the halves of a run: how many independent ones they are worth is not
    known, and an interval that allows for any number would hide every change.

    Parameters
    ----------
    batches : (B, columns) array
        Means over batches of equal length, in their order in time, any unit.
    confidence : float
        Probability with which the interval holds the mean, a fraction.

    Returns
    -------
    (columns,) array
        Half-width in the unit of the batches.
    """
    correlation = np.clip(_successive(batches) + 1.0 / len(batches), 0.0, 0.9)
    return independent_interval(batches, confidence) * np.sqrt((1.0 + correlation) / (1.0 - correlation))


def independent_interval(batches: Array, confidence: float = CONFIDENCE) -> Array:
    """Compute the half-width of the confidence interval of a mean of independent batches, by Student's
    distribution.

    Parameters
    ----------
    batches : (B, columns) array
        Means over batches of equal length, any unit.
    confidence : float
        Probability with which the interval holds the mean, a fraction.

    Returns
    -------
    (columns,) array
        Half-width in the unit of the batches; zero from a single batch, which says nothing.
    """
    count = len(batches)
    if count < 2:
        return np.zeros(batches.shape[1:])
    return _student(count - 1, confidence) * batches.std(axis=0, ddof=1) / np.sqrt(count)


def _successive(batches: Array) -> Array:
    """Return the correlation (columns,) of each batch with the next one, from batches (B, columns); 0
    without spread.
    """
    off = batches - batches.mean(axis=0)
    square = (off * off).sum(axis=0)
    return np.asarray((off[1:] * off[:-1]).sum(axis=0) / np.where(square > 0.0, square, 1.0))


def _autoregressive_interval(batches: Array, confidence: float) -> Array:
    """Return the half-width (columns,) of the mean of batches (B, columns) as a series of first-order
    autoregression.

    Student's quantile and the variance are taken for the number of independent batches that they are
    worth.
    """
    count, sample = len(batches), _successive(batches)
    # In a sample the correlation is too low by (1 + 4 r) / B, and the variance by its 1 / `worth`.
    correlation = np.clip(sample + (1.0 + 4.0 * sample) / count, 0.0, LARGEST_CORRELATION)
    worth = count * (1.0 - correlation) / (1.0 + correlation)
    variance = batches.var(axis=0) / np.maximum(1.0 - 1.0 / worth, MIN_SHOWN)
    worth = np.maximum(worth, MIN_INDEPENDENT)
    quantile = scipy.special.stdtrit(worth - 1.0, 0.5 + 0.5 * confidence)
    return np.asarray(quantile * np.sqrt(variance / worth))


def _slow_wave_interval(batches: Array, confidence: float) -> Array:
    """Return the half-width (columns,) of the mean of batches (B, columns) from their SLOW_WAVES slowest
    cosines.
    """
    count = len(batches)
    waves = min(SLOW_WAVES, count - 1)
    phases = np.pi * np.arange(1, waves + 1)[:, None] * (np.arange(count) + 0.5) / count
    amplitudes = np.sqrt(2.0 / count) * np.tensordot(np.cos(phases), batches - batches.mean(axis=0), 1)
    variance = (amplitudes**2).mean(axis=0)
    return np.asarray(_student(waves, confidence) * np.sqrt(variance / count))


def _root_interval(squared: Array, root: Array, periodic: bool) -> Array:
    """Return the 95 % half-width (columns,) of a root mean square `root` from batch means (B, columns) of
    its square.

    The half-width of the square is divided by 2 `root`. The batch means may lack a constant. It is 0 for
    a periodic motion.
    """
    if periodic:
        return np.zeros(root.size)
    return mean_interval(squared) / (2.0 * np.where(root > 0.0, root, 1.0))


@cache
def _student(freedom: int, confidence: float) -> float:
    """Return the two-sided quantile of Student's distribution with `freedom` degrees of freedom."""
    return float(scipy.special.stdtrit(freedom, 0.5 + 0.5 * confidence))
