"""Mesh stiffness over a pitch at a load between those that were solved, and e(t) without load."""

from dataclasses import dataclass

import numpy as np
import pandas as pd
import scipy

from facegear.arrays import Array
from facegear.errors import FacegearError, InvalidInput
from facegear.harmonics import Harmonics, fit_harmonics
from facegear.meshing.stiffness_request import Definition

COLUMN = {"average": "k_average_n_per_m", "local": "k_local_n_per_m"}
"""Column of the contact table for each definition of the stiffness."""


@dataclass(frozen=True, eq=False)
class LoadTable:
    """Mesh stiffness over position and torque.

    Attributes
    ----------
    torques : (t,) array
        Torques on the pinion, N m.
    positions : (p,) array
        Positions in a pitch, 0 to 1.
    average, local : (t, p) arrays
        Stiffness of both definitions, N/m.
    """

    torques: Array
    positions: Array
    average: Array
    local: Array

    def at(self, torque: float, definition: Definition) -> Array:
        """Return the stiffness at a torque, monotone cubic in log torque at each position.

        Parameters
        ----------
        torque : float
            Torque on the pinion, N m.
        definition : Definition
            Average or local stiffness.

        Returns
        -------
        (p,) array
            N/m.

        Raises
        ------
        InvalidInput
            Outside the torques solved: the curve is never extrapolated.
        """
        values = self.average if definition == "average" else self.local
        exact = np.flatnonzero(np.isclose(self.torques, torque, rtol=1e-12))
        if exact.size:
            return values[exact[0]]
        low, high = self.torques[0], self.torques[-1]
        if not low <= torque <= high:
            requirement = f"within `torques of the contact analysis`, {low:g} to {high:g}"
            raise InvalidInput("torque of the mesh stiffness", torque, requirement)
        return scipy.interpolate.PchipInterpolator(np.log(self.torques), values, axis=0)(np.log(torque))

    def interpolation_error(self, torque: float, definition: Definition) -> float:
        """Return the largest relative change of the curve if the solved inner torque nearest to `torque`
        were left out.

        Parameters
        ----------
        torque : float
            Torque on the pinion, N m.
        definition : Definition
            Average or local stiffness.

        Returns
        -------
        float
            Relative, a fraction; nan where there is no inner torque, 0 at a torque that was solved.
        """
        inner = np.arange(1, len(self.torques) - 1)
        if inner.size == 0 or np.isclose(self.torques, torque, rtol=1e-12).any():
            return 0.0 if inner.size else float("nan")
        left_out = inner[np.argmin(np.abs(np.log(self.torques[inner] / torque)))]
        other_torques = np.delete(np.arange(len(self.torques)), left_out)
        fewer = LoadTable(
            self.torques[other_torques],
            self.positions,
            self.average[other_torques],
            self.local[other_torques],
        )
        full = self.at(torque, definition)
        return float(np.abs(fewer.at(torque, definition) / full - 1.0).max())


def load_table(ltca: pd.DataFrame) -> LoadTable:
    """Read stiffness over position and torque from the contact table.

    Torques at which the average stiffness is missing at some position are left out.

    Parameters
    ----------
    ltca : pd.DataFrame
        Table of the contact analysis with columns torque_n_m, position, k_average_n_per_m,
        k_local_n_per_m and interference_um, one row for each torque and position.

    Returns
    -------
    LoadTable
        N m and N/m, torques and positions rising.

    Raises
    ------
    FacegearError
        If the teeth interfere at every torque, so that there is no stiffness.
    """
    torques, row = np.unique(ltca["torque_n_m"].to_numpy(float), return_inverse=True)
    positions, column = np.unique(ltca["position"].to_numpy(float), return_inverse=True)
    average, local = np.full((2, torques.size, positions.size), np.nan)
    average[row, column], local[row, column] = (ltca[name].to_numpy(float) for name in COLUMN.values())
    is_known = ~np.isnan(average).any(axis=1)
    if not is_known.any():
        depth = ltca["interference_um"].max()
        raise FacegearError(
            "mesh_stiffness: not computed, as the teeth interfere. Tips penetrate the fillets by up to "
            f"{depth:.3g} um along the line of action (a smaller "
            "tooth_pair.pinion.rack_tip_radius_modules or more tooth_pair.shaper.teeth clears them)"
        )
    return LoadTable(torques[is_known], positions, average[is_known], local[is_known])


ROUNDING_UM = 1e-4
"""Peak-to-peak up to which an error counts as constant: the closest points of flanks are known no better."""


def unloaded_series(ltca: pd.DataFrame, order: int) -> tuple[Harmonics, float]:
    """Return the Fourier series of the contact table's unloaded transmission error, and its cut error.

    Positive where the drive flank comes late. The mean is taken off: it turns the pinions, and what it
    does to the backlash stands in that of the pair as assembled. An error that is constant is exactly
    zero.

    Parameters
    ----------
    ltca : pd.DataFrame
        Table of the contact analysis; columns torque_n_m, position and unloaded_ste_um are read.
    order : int
        Last order of the series.

    Returns
    -------
    tuple of Harmonics and float
        Series in m, and the largest error of the cut, m.
    """
    samples = unloaded_samples(ltca)
    if np.ptp(samples) <= ROUNDING_UM:
        return Harmonics(np.zeros(order + 1), np.zeros(order + 1)), 0.0
    fit = fit_harmonics(1e-6 * (samples - samples.mean()))
    series = fit.series.truncate(order)
    cosine = series.cosine.copy()
    cosine[0] = 0.0
    return Harmonics(series.sine, cosine), float(fit.truncation[order])


def unloaded_samples(ltca: pd.DataFrame) -> Array:
    """Return the unloaded transmission error of a contact table by rising position, from its smallest
    torque.

    Parameters
    ----------
    ltca : pd.DataFrame
        Table of the contact analysis; columns torque_n_m, position and unloaded_ste_um are read.

    Returns
    -------
    (p,) array
        um.
    """
    torque, position, error = (
        ltca[name].to_numpy(float) for name in ("torque_n_m", "position", "unloaded_ste_um")
    )
    rows = np.flatnonzero(torque == torque.min())
    return np.asarray(error[rows[np.argsort(position[rows])]])


def peak_to_peak(series: Harmonics) -> float:
    """Return the range of a series over a period, from 64 evenly spaced points for each order.

    Parameters
    ----------
    series : Harmonics
        The series, m.

    Returns
    -------
    float
        m.
    """
    points = np.linspace(0.0, 1.0, 64 * (series.order + 1), endpoint=False)
    return float(np.ptp(series(points)))
