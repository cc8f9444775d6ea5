"""Safety and life of the tooth pair."""

from typing import TYPE_CHECKING, ClassVar

import pandas as pd

from facegear.results.base import Kept, Result
from facegear.strength.columns import CURVE_COLUMNS, DAMAGE_FINITE, RATING_FINITE

if TYPE_CHECKING:
    from facegear.plots.style import Figure


class RatingResult(Result):
    """Safety against tooth breakage and pitting, and life, under the duty cycle of section strength."""

    FILES: ClassVar = {
        "curves": Kept("strength/curves.csv", CURVE_COLUMNS),
        "rating": Kept("strength/rating.csv", RATING_FINITE),
        "damage": Kept("strength/damage.csv", DAMAGE_FINITE),
    }

    def table(self) -> pd.DataFrame:
        """A row a body, failure and method: stress, safety, verdict and life (docs/strength.md)."""
        return self.content["rating"].copy()

    def damage(self) -> pd.DataFrame:
        """Stress, cycles and damage of each bin of the duty cycle."""
        return self.content["damage"].copy()

    def plot(self) -> "Figure":
        """Every bin of the duty cycle beside the stress that may be repeated so often."""
        from facegear.plots.strength import life

        return life(self.content["damage"], self.content["curves"])
