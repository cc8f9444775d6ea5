"""Response at one speed."""

from typing import TYPE_CHECKING, ClassVar

import pandas as pd

from facegear.results.base import Result
from facegear.results.paper_figure import fit_for_paper

if TYPE_CHECKING:
    from facegear.plots.description import Figure


class ResponseResult(Result):
    """Steady state at one speed: mesh deflections and forces, spectrum, class of motion, bearing forces."""

    STAGE: ClassVar = "dynamics_response"

    def table(self) -> pd.DataFrame:
        """The numbers that a sweep keeps: quantity (unit at its end), body_or_mesh, value, class.

        Columns: speed_rpm, quantity, body_or_mesh, value, class, periodic, symmetry_broken.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["summary"].copy()

    def history(self) -> pd.DataFrame:
        """Deflection (um) and elastic force (N) of every mesh over at most 32 mesh periods.

        Columns: mesh_cycle, time_s, mesh, deflection_um, elastic_force_n.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["response"].copy()

    def bearings(self) -> pd.DataFrame:
        """Force of every body on its bearing (N) along x, y, z and radially: at rest, mean, RMS, peak.

        Columns: body, direction, static_n, mean_n, rms_n, ac_rms_n, ac_rms_interval_n, peak_n, class.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["bearings"].copy()

    @fit_for_paper
    def plot(self) -> "Figure":
        """Deflections along the line of action against time, and their spectra.

        Returns
        -------
        Figure
            The figure.
        """
        from facegear.plots.response import deflections

        pinions = [pinion["name"] for pinion in self.values["transmission"]["pinions"]]
        return deflections(self.content["response"], self.content["spectrum"], pinions)
