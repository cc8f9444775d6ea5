"""Designs that no other beats in everything asked for."""

from typing import TYPE_CHECKING, ClassVar

import pandas as pd

from facegear.errors import require_choice
from facegear.results.base import Result
from facegear.results.paper_figure import fit_for_paper

if TYPE_CHECKING:
    from facegear.plots.description import Figure

KINDS = ("front", "hypervolume")


class SearchResult(Result):
    """Front of a design search, the winners beside the nominal design, and the spread over seeds."""

    STAGE: ClassVar = "search"

    def table(self) -> pd.DataFrame:
        """One row a design of the front: variables and goals.

        Returns
        -------
        pd.DataFrame
            The table.
        """
        return self.content["front"].copy()

    def winners(self) -> pd.DataFrame:
        """The nominal design and the winners at full accuracy, beside what the search found of them.

        Returns
        -------
        pd.DataFrame
            The table.
        """
        return self.content["winners"].copy()

    def designs(self) -> pd.DataFrame:
        """Every design tried, with its generation and seed, and the error where it cannot be built.

        Returns
        -------
        pd.DataFrame
            The table.
        """
        return self.content["designs"].copy()

    def hypervolume(self) -> pd.DataFrame:
        """Share of the box of all fronts that each seed has covered, by generation.

        Columns, among others: hypervolume.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["hypervolume"].copy()

    @fit_for_paper
    def plot(self, kind: str = "front") -> "Figure":
        """Draw the front or the hypervolume.

        Parameters
        ----------
        kind : str
            `front` or `hypervolume`.

        Returns
        -------
        Figure
            The figure.
        """
        from facegear.plots.search import front_figure, hypervolume_figure

        content = self.content
        if require_choice(kind, KINDS, "kind") == "hypervolume":
            return hypervolume_figure(content["hypervolume"])
        objectives = [objective["name"] for objective in self.values["search"]["objectives"]]
        return front_figure(content["designs"], content["front"], content["winners"], objectives)
