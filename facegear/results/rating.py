"""Safety and life of the tooth pair."""

from typing import TYPE_CHECKING, ClassVar

import pandas as pd

from facegear.errors import require_choice
from facegear.results.base import Result
from facegear.results.paper_figure import fit_for_paper

if TYPE_CHECKING:
    from facegear.plots.description import Figure


class RatingResult(Result):
    """Safety against tooth breakage and pitting, and life, under the duty cycle of section strength."""

    STAGE: ClassVar = "rating"

    def table(self) -> pd.DataFrame:
        """A row a flank, failure and method: stress, safety, verdict and life (docs/explanation/strength.md).

        Columns: body, gear, flank, failure, method, stress_mpa, stress_error_mpa, allowed_mpa, cycles,
        safety, required, verdict, reason, caveat, damage, life_hours, within_torques_solved.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["rating"].copy()

    def safety(self) -> pd.DataFrame:
        """A row a flank: safety against each failure, life, reliability, verdict.

        Columns: body, flank, verdict, bending_safety, standard_bending_safety, pitting_safety,
        standard_pitting_safety, edge_line_load_n_per_mm, edge_length_mm, life_hours, nearest_limit, reason,
        caveat, within_torques_solved, scuffing_safety, scuffing_margin_k, smallest_film_ratio,
        micropitting_safety.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["safety"].copy()

    def damage(self) -> pd.DataFrame:
        """Stress, cycles and damage of each bin of the duty cycle.

        Columns: body, gear, flank, failure, method, bin, torque_n_m, speed_rpm, hours, stress_mpa, cycles,
        damage, within_torques_solved.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["damage"].copy()

    @fit_for_paper
    def plot(self, what: str = "life") -> "Figure":
        """Every bin of the duty cycle beside the stress that may be repeated so often, or its `damage`.

        Parameters
        ----------
        what : str
            Kind of the figure, one of those above.

        Returns
        -------
        Figure
            The figure.
        """
        from facegear.plots.strength import damage_by_bin, life

        if require_choice(what, ("life", "damage"), "plot") == "life":
            return life(self.content["rating"], self.content["damage"], self.content["curves"])
        return damage_by_bin(self.content["rating"], self.content["damage"])
