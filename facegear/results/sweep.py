"""Speed sweep."""

from typing import TYPE_CHECKING, ClassVar

import pandas as pd

from facegear.errors import chosen
from facegear.results.base import Result

if TYPE_CHECKING:
    import xarray as xr

    from facegear.plots.style import Figure


class SweepResult(Result):
    """Steady states over speed, up and down, with jumps and resonances."""

    STAGE: ClassVar = "dynamics_sweep"
    BESIDE: ClassVar = {"frequencies": ("modal", "frequencies")}

    def table(self) -> "xr.Dataset":
        """Every quantity (unit at the end of its name) over direction, speed_rpm and mesh or body.

        `class` is the class of motion; a value that does not exist at a speed is NaN.
        """
        from facegear.results.sweep_dataset import sweep_dataset

        return sweep_dataset(self.content["sweep"])

    def jumps(self) -> pd.DataFrame:
        """One row a jump: its bracket of speeds (rpm), classes of motion, the resonance it belongs to."""
        return self.content["jumps"].copy()

    def resonances(self) -> pd.DataFrame:
        """One row a peak of the RMS without mean, with the mode it belongs to."""
        return self.content["resonances"].copy()

    def plot(self, what: str = "meshes") -> "Figure":
        """RMS of `meshes`, `pinions` or `gears` over speed, `campbell` diagram or `waterfall`."""
        from facegear.plots.dynamics import SWEEP_FIGURES, drawn_machine

        draw = SWEEP_FIGURES[chosen(what, tuple(SWEEP_FIGURES), "plot")]
        teeth = self.values["tooth_pair"]["pinion_teeth"]
        return draw(self.content, drawn_machine(self.values["transmission"], teeth))
