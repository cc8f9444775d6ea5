"""Mesh stiffness over a pitch and its harmonics."""

from typing import TYPE_CHECKING, ClassVar

import pandas as pd

from facegear.errors import chosen
from facegear.results.base import Result

if TYPE_CHECKING:
    from facegear.plots.style import Figure


class StiffnessResult(Result):
    """k(t) that the lumped model uses."""

    STAGE: ClassVar = "stiffness"

    def table(self) -> pd.DataFrame:
        """Orders kept of k = sum a sin(j w t) + b cos(j w t), with the errors of cutting and sampling."""
        return self.content["harmonics"].copy()

    def curve(self) -> pd.DataFrame:
        """k over a pitch and the series kept of it, N/m."""
        return self.content["tvms"].copy()

    def plot(self, what: str = "curve") -> "Figure":
        """`curve` over a mesh period, or amplitudes of its `harmonics`."""
        from facegear.plots.stiffness import harmonic_amplitudes, stiffness_curve

        if chosen(what, ("curve", "harmonics"), "plot") == "curve":
            return stiffness_curve(self.content["tvms"])
        return harmonic_amplitudes(self.content["spectrum"])
