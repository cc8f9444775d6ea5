"""Mesh stiffness over a pitch and its harmonics."""

from typing import TYPE_CHECKING, ClassVar

import numpy as np
import pandas as pd

from facegear.errors import FacegearError, require_choice
from facegear.results.base import Result
from facegear.results.paper_figure import fit_for_paper
from facegear.stiffness.tables import series_of

if TYPE_CHECKING:
    from facegear.plots.description import Figure


class StiffnessResult(Result):
    """k(t) that the lumped model uses."""

    STAGE: ClassVar = "stiffness"

    def table(self) -> pd.DataFrame:
        """Orders kept of k = sum of sin_n_per_m sin(j w t) + cos_n_per_m cos(j w t), with the errors of
        cutting and sampling.

        Columns: order, sin_n_per_m, cos_n_per_m, amplitude_n_per_m, truncation_error_n_per_m,
        sampling_error_n_per_m, e_sin_um, e_cos_um, e_peak_to_peak_um, e_truncation_error_um,
        mean_average_n_per_m, mean_local_n_per_m.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["harmonics"].copy()

    def curve(self) -> pd.DataFrame:
        """k over a pitch and the series kept of it, N/m.

        Columns: position, k_n_per_m, k_series_n_per_m.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["tvms"].copy()

    def over_angle(self, points: int = 64) -> pd.DataFrame:
        """Return k over the angle of the pinion in one of its pitches.

        The series is the one that is kept, of a mesh that is in its reference phase at angle 0; for programs
        that take a curve where this one takes Fourier orders.

        Parameters
        ----------
        points : int
            Number of angles.

        Returns
        -------
        pd.DataFrame
            A row for each angle: pinion_angle_deg, k_n_per_m.
        """
        if points < 1:
            raise FacegearError(f"points = {points}: must be at least 1")
        cycles = np.arange(points) / points
        pitch = 360.0 / self.values["tooth_pair"]["pinion_teeth"]
        stiffness = series_of(self.content["harmonics"])(cycles)
        return pd.DataFrame({"pinion_angle_deg": pitch * cycles, "k_n_per_m": stiffness})

    @fit_for_paper
    def plot(self, what: str = "curve") -> "Figure":
        """`curve` over a mesh period, or amplitudes of its `harmonics`.

        Parameters
        ----------
        what : str
            Kind of the figure, one of those above.

        Returns
        -------
        Figure
            The figure.
        """
        from facegear.plots.stiffness import harmonic_amplitudes, stiffness_curve

        if require_choice(what, ("curve", "harmonics"), "plot") == "curve":
            return stiffness_curve(self.content["tvms"])
        return harmonic_amplitudes(self.content["spectrum"])
