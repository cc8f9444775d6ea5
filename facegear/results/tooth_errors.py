"""Contribution of single teeth that deviate from the others to the transmission error."""

from typing import TYPE_CHECKING, ClassVar

import pandas as pd

from facegear.results.base import Result
from facegear.results.paper_figure import fit_for_paper

if TYPE_CHECKING:
    from facegear.plots.description import Figure


class ToothErrorsResult(Result):
    """Tooth to tooth, over a turn of either gear: at the orders of its turns, with and without load."""

    STAGE: ClassVar = "tooth_errors"

    def table(self) -> pd.DataFrame:
        """One row an order of a gear's turns: amplitude (um) of the drive flank's transmission error.

        Columns, among others: order, unloaded_um, loaded_um.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["orders"].copy()

    @fit_for_paper
    def plot(self) -> "Figure":
        """Draw what the teeth of either gear add under load, over one of its turns.

        Returns
        -------
        Figure
            The figure.
        """
        from facegear.plots.tooth_errors import tooth_error_figure

        return tooth_error_figure(self.content["curves"], self.content["orders"])
