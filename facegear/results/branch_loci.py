"""Curves of folds and period doublings in two parameters."""

from typing import TYPE_CHECKING, ClassVar

import pandas as pd

from facegear.results.base import Result
from facegear.results.paper_figure import fit_for_paper

if TYPE_CHECKING:
    from facegear.plots.description import Figure


class BranchLociResult(Result):
    """Where motions end or double their period in the plane of speed and a second parameter."""

    STAGE: ClassVar = "branches_loci"

    def table(self) -> pd.DataFrame:
        """One row a point: locus, kind, parameter and the factor on it, speed_rpm; `corner` at a cusp.

        Columns, among others: locus, kind, factor, speed_rpm, corner.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["loci"].copy()

    @fit_for_paper
    def plot(self) -> "Figure":
        """All loci with the operating point, a panel for each parameter.

        Returns
        -------
        Figure
            The figure.
        """
        from facegear.plots.branches import loci

        return loci(self.content["loci"], self.values["dynamics"]["speed_rpm"])
