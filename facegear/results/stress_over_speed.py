"""Root stress and pressure over the speed range."""

from typing import TYPE_CHECKING, ClassVar

import pandas as pd

from facegear.results.base import Result
from facegear.results.paper_figure import fit_for_paper

if TYPE_CHECKING:
    from facegear.plots.description import Figure


class StressOverSpeedResult(Result):
    """Largest root stress and pressure of all meshes under every motion known at a speed."""

    STAGE: ClassVar = "stress_over_speed"

    def table(self) -> pd.DataFrame:
        """A row a motion and speed; `worst` marks the hardest of all known at it.

        docs/explanation/strength.md says how.

        Columns: motion, class, speed_rpm, mesh, largest_force_n, dynamic_factor, pinion_mpa, face_gear_mpa,
        pressure_mpa, within_torques_solved, worst.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["stress_over_speed"].copy()

    @fit_for_paper
    def plot(self) -> "Figure":
        """Root stress, pressure and dynamic factor over speed.

        Returns
        -------
        Figure
            The figure.
        """
        from facegear.plots.stress_over_speed import stress_over_speed

        return stress_over_speed(self.content["stress_over_speed"], self.values["dynamics"]["speed_rpm"])
