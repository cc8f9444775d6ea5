"""Friction, heat and film of the pair under load."""

from typing import TYPE_CHECKING, ClassVar

import pandas as pd

from facegear.errors import chosen
from facegear.results.base import Result
from facegear.results.paper_figure import fit_for_paper

if TYPE_CHECKING:
    from facegear.plots.style import Figure


class FrictionResult(Result):
    """Sliding, loss, temperatures and film of one mesh by torque, position and speed (docs/friction.md)."""

    STAGE: ClassVar = "lubrication"
    BESIDE: ClassVar = {"pressure": ("contact", "pressure")}

    def table(self) -> pd.DataFrame:
        """A row a torque at the nominal speed: loss factor, efficiency, temperatures, film, safeties."""
        return self.content["by_torque"].copy()

    def positions(self) -> pd.DataFrame:
        """A row a torque and position: loss, largest flash, thinnest film."""
        return self.content["positions"].copy()

    def limits(self) -> pd.DataFrame:
        """How much of the loss lies outside each limit of the friction model."""
        return self.content["limits"].copy()

    def map(self) -> pd.DataFrame:
        """A row a torque and speed: loss, efficiency, temperature, film ratio."""
        return self.content["map"].copy()

    @fit_for_paper
    def plot(self, what: str = "path") -> "Figure":
        """`path`: sliding and temperature along the path of contact; `flank`: loss and temperature over the
        flank; `efficiency`: over torque and speed.
        """
        from facegear.plots.friction import along_path, efficiency_map, over_flank

        if chosen(what, ("path", "flank", "efficiency"), "plot") == "path":
            return along_path(self.content["local"])
        if what == "flank":
            return over_flank(self.content["local"], self.content["pressure"])
        return efficiency_map(self.content["map"])
