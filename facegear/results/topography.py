"""Flanks as measured or as wanted, beside nominal points and normals."""

from typing import TYPE_CHECKING, ClassVar

import pandas as pd

from facegear.errors import require_choice
from facegear.results.base import Result
from facegear.results.paper_figure import fit_for_paper

if TYPE_CHECKING:
    from facegear.plots.description import Figure


class TopographyResult(Result):
    """Nominal points and normals of all flanks, with the mean deviation of all teeth."""

    STAGE: ClassVar = "topography"

    def table(self) -> pd.DataFrame:
        """One row a place: face_mm and profile_mm, deviation (um), nominal point (mm) and normal.

        Columns: body, tooth, flank, face_mm, profile_mm, deviation_um, x_mm, y_mm, z_mm, nx, ny, nz.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["points"].copy()

    @fit_for_paper
    def plot(self, body: str = "face_gear") -> "Figure":
        """Draw the chart of both flanks of a body.

        Parameters
        ----------
        body : str
            `pinion` or `face_gear`.

        Returns
        -------
        Figure
            The figure.
        """
        from facegear.plots.topography import topography_figure

        return topography_figure(
            self.content["points"], require_choice(body, ("pinion", "face_gear"), "plot")
        )
