"""Modes at speed of a machine whose face gears bend."""

from typing import TYPE_CHECKING, ClassVar

import pandas as pd

from facegear.results.base import Result
from facegear.results.paper_figure import fit_for_paper

if TYPE_CHECKING:
    from facegear.plots.description import Figure


class GearWavesResult(Result):
    """Damped modes at the nominal speed about the static load, and the waves of the face gears in them."""

    STAGE: ClassVar = "gear_waves"

    def table(self) -> pd.DataFrame:
        """One row a mode, gear and nodal diameters: frequency, damping, energy, how much travels forward.

        Columns, among others: order, frequency_hz, damping_ratio.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["waves"].copy()

    def campbell(self) -> pd.DataFrame:
        """One row a speed and mode: frequency, damping, the waves with most of its energy, and its line.

        Columns, among others: speed_rpm, line, frequency_hz.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["campbell"].copy()

    def crossings(self) -> pd.DataFrame:
        """One row a speed at which a mesh harmonic meets a mode, with how the meshes' phases add up.

        Columns, among others: line, speed_rpm, phase_factor.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["campbell_crossings"].copy()

    @fit_for_paper
    def plot(self) -> "Figure":
        """Modes over pinion speed with mesh harmonics.

        Returns
        -------
        Figure
            The figure.
        """
        from facegear.plots.gear_waves import machine_campbell

        campbell = self.content["campbell"]
        teeth = self.values["tooth_pair"]["pinion_teeth"]
        return machine_campbell(
            campbell, self.content["campbell_crossings"], campbell["speed_rpm"].max(), teeth
        )
