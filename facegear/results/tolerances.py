"""Results of the samples of a machine with its tolerances."""

from typing import TYPE_CHECKING, ClassVar

import pandas as pd

from facegear.errors import require_choice
from facegear.results.base import Result
from facegear.results.paper_figure import fit_for_paper

if TYPE_CHECKING:
    from facegear.plots.description import Figure

KINDS = ("distributions", "importance", "scatter")


class LoadMapResult(Result):
    """Percentiles, and fractions of machines that open or reverse, over torque and speed."""

    STAGE: ClassVar = "tolerances_map"

    def table(self) -> pd.DataFrame:
        """One row a torque, speed, quantity and percentile: value, and the interval that holds it.

        Columns: torque_factor, speed_rpm, quantity, percentile, value, low, high, samples, failed.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["load_map"].copy()

    def fractions(self) -> pd.DataFrame:
        """One row a torque, speed and mishap: fraction of the machines that it meets, with its interval.

        Columns: torque_factor, speed_rpm, what, fraction, low, high, samples.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["load_fractions"].copy()

    @fit_for_paper
    def plot(self) -> "Figure":
        """K_gamma of the worst path over torque and speed.

        Returns
        -------
        Figure
            The figure.
        """
        from facegear.plots.tolerances import load_map_figure

        return load_map_figure(self.content["load_map"])


class TolerancesResult(Result):
    """Percentiles of K_gamma and mesh forces, fractions of machines that open or reverse, main causes."""

    STAGE: ClassVar = "tolerances"

    def table(self) -> pd.DataFrame:
        """One row a quantity and percentile: value, and the confidence interval that holds it.

        Columns: quantity, percentile, value, low, high, samples.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["percentiles"].copy()

    def samples(self) -> pd.DataFrame:
        """One row a sample: its causes, what was found, and the error where it failed.

        Returns
        -------
        pd.DataFrame
            The table.
        """
        return self.content["samples"].copy()

    def indices(self) -> pd.DataFrame:
        """First-order and total Sobol index of every quantity and cause, with confidence intervals.

        Columns: quantity, cause, first, first_low, first_high, total, total_low, total_high, blocks,
        blocks_failed.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["indices"].copy()

    @fit_for_paper
    def plot(self, kind: str = "distributions") -> "Figure":
        """Draw distributions, importance or scatter.

        Parameters
        ----------
        kind : str
            `distributions`, `importance` or `scatter`.

        Returns
        -------
        Figure
            The figure.
        """
        from facegear.plots.tolerances import distribution_figure, importance_figure, scatter_figure

        content = self.content
        if require_choice(kind, KINDS, "kind") == "distributions":
            return distribution_figure(content["samples"], content["percentiles"])
        if kind == "importance":
            return importance_figure(content["percentiles"], content["importance"], content["indices"])
        parts = (content[name] for name in ("samples", "percentiles", "importance", "indices"))
        return scatter_figure(*parts)
