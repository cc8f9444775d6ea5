"""Friction, heat and film of the pair under load."""

from typing import TYPE_CHECKING, ClassVar

import pandas as pd

from facegear.errors import require_choice
from facegear.results.base import Result
from facegear.results.paper_figure import fit_for_paper

if TYPE_CHECKING:
    from facegear.plots.description import Figure


class FrictionResult(Result):
    """Sliding, loss, temperatures and film of one mesh by torque, position and speed.

    docs/explanation/friction.md has the formulas.
    """

    STAGE: ClassVar = "lubrication"
    BESIDE: ClassVar = {"pressure": ("contact", "pressure")}

    def table(self) -> pd.DataFrame:
        """A row a torque at the nominal speed: loss factor, efficiency, temperatures, film, safeties.

        Columns: torque_n_m, speed_rpm, friction_model, loss_factor, loss_factor_min, loss_factor_max,
        mean_friction, loss_w, efficiency, pinion_heat_w, face_gear_heat_w, pinion_bulk_c, face_gear_bulk_c,
        largest_sliding_m_per_s, largest_flash_k, flash_position, flash_pair, flash_axial_mm,
        contact_temperature_c, allowed_contact_temperature_c, allowed_contact_temperature_source,
        scuffing_safety, scuffing_margin_k, mean_flash_k, integral_temperature_c,
        allowed_integral_temperature_c, integral_safety, smallest_film_um, smallest_short_film_um,
        smallest_film_ratio, smallest_micropitting_film_ratio, micropitting_safety.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["by_torque"].copy()

    def positions(self) -> pd.DataFrame:
        """A row a torque and position: loss, largest flash, thinnest film.

        Columns: torque_n_m, position, loss_factor, loss_w, largest_flash_k, smallest_film_um,
        smallest_film_ratio.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["positions"].copy()

    def limits(self) -> pd.DataFrame:
        """How much of the loss lies outside each limit of the friction model.

        Columns: friction_model, limit, limit_source, torque_n_m, loss_outside_percent.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["limits"].copy()

    def map(self) -> pd.DataFrame:
        """A row a torque and speed: loss, efficiency, temperature, film ratio.

        Columns: torque_n_m, speed_rpm, loss_w, efficiency, largest_flash_k, contact_temperature_c,
        smallest_film_ratio.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["map"].copy()

    @fit_for_paper
    def plot(self, what: str = "path") -> "Figure":
        """`path`: sliding and temperature along the path of contact; `flank`: loss and temperature over the
        flank; `efficiency`: over torque and speed.

        Parameters
        ----------
        what : str
            Kind of the figure, one of those above.

        Returns
        -------
        Figure
            The figure.
        """
        from facegear.plots.friction import along_path, efficiency_map, over_flank

        if require_choice(what, ("path", "flank", "efficiency"), "plot") == "path":
            return along_path(self.content["local"])
        if what == "flank":
            return over_flank(self.content["local"], self.content["pressure"])
        return efficiency_map(self.content["map"])
