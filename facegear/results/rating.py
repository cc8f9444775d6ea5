"""Safety and life of the tooth pair."""

from typing import TYPE_CHECKING, ClassVar

import pandas as pd

from facegear.errors import chosen
from facegear.results.base import Result
from facegear.results.paper_figure import fit_for_paper

if TYPE_CHECKING:
    from facegear.plots.style import Figure


class RatingResult(Result):
    """Safety against tooth breakage and pitting, and life, under the duty cycle of section strength."""

    STAGE: ClassVar = "rating"

    def table(self) -> pd.DataFrame:
        """A row a flank, failure and method: stress, safety, verdict and life (docs/strength.md)."""
        return self.content["rating"].copy()

    def safety(self) -> pd.DataFrame:
        """A row a flank: safety against each failure, life, reliability, verdict."""
        return self.content["safety"].copy()

    def damage(self) -> pd.DataFrame:
        """Stress, cycles and damage of each bin of the duty cycle."""
        return self.content["damage"].copy()

    @fit_for_paper
    def plot(self, what: str = "life") -> "Figure":
        """Every bin of the duty cycle beside the stress that may be repeated so often, or its `damage`."""
        from facegear.plots.strength import damage_by_bin, life

        if chosen(what, ("life", "damage"), "plot") == "life":
            return life(self.content["rating"], self.content["damage"], self.content["curves"])
        return damage_by_bin(self.content["rating"], self.content["damage"])
