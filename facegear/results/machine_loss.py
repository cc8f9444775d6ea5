"""Loss and heat of the machine."""

from typing import TYPE_CHECKING, ClassVar

import pandas as pd

from facegear.results.base import Result
from facegear.results.paper_figure import fit_for_paper

if TYPE_CHECKING:
    from facegear.plots.description import Figure


class MachineLossResult(Result):
    """Loss of every mesh and heat of every body, at the nominal load and over the duty cycle."""

    STAGE: ClassVar = "machine_loss"

    def table(self) -> pd.DataFrame:
        """A row a bin, 0 being the nominal load at rest and -1 the whole duty cycle: loss and efficiency.

        Columns: bin, hours, speed_rpm, power_in_w, power_through_meshes, loss_w, loss_percent, efficiency,
        energy_lost_kwh, within_torques_solved.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["machine"].copy()

    def meshes(self) -> pd.DataFrame:
        """A row a bin and loaded flank: power, loss, temperatures, safety, film.

        Columns: bin, speed_rpm, mesh, flank, pinion_torque_n_m, largest_torque_n_m, power_w, loss_w,
        loss_percent, loss_in_motion_w, pinion_heat_w, face_gear_heat_w, pinion_bulk_c, face_gear_bulk_c,
        largest_flash_k, contact_temperature_c, scuffing_safety, scuffing_margin_k, smallest_film_ratio,
        smallest_micropitting_film_ratio, micropitting_safety, within_torques_solved.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["meshes"].copy()

    def bodies(self) -> pd.DataFrame:
        """A row a bin and body: heat and bulk temperature.

        Columns: bin, speed_rpm, body, heat_w, bulk_c.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["bodies"].copy()

    @fit_for_paper
    def plot(self) -> "Figure":
        """Where loss arises and heat goes at the nominal load.

        Returns
        -------
        Figure
            The figure.
        """
        from facegear.plots.friction import machine_heat

        return machine_heat(self.content["meshes"], self.content["bodies"])
