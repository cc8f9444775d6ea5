"""Shafts of pinions, and turning masses behind torsional springs."""

from typing import TYPE_CHECKING, ClassVar

import pandas as pd

from facegear.errors import FacegearError
from facegear.results.base import Result
from facegear.results.paper_figure import fit_for_paper

if TYPE_CHECKING:
    from facegear.plots.style import Figure


class ShaftsResult(Result):
    """What pinions sit on and what torques turn, with the machine at rest under its mean torques."""

    STAGE: ClassVar = "shafts"

    def table(self) -> pd.DataFrame:
        """One row a pinion with a shaft: stiffness without moments, displacement and slope under load."""
        return self.content["seats"].copy()

    def stiffness(self) -> pd.DataFrame:
        """Five rows a pinion with a shaft: its stiffness in x, y, z, tilt_x, tilt_y."""
        return self.content["stiffness"].copy()

    def bearings(self) -> pd.DataFrame:
        """One row a bearing of a shaft: its forces and moments."""
        return self.content["bearings"].copy()

    def torsion(self) -> pd.DataFrame:
        """One row a turning mass: its spring, twist under load, natural frequencies of its chain."""
        return self.content["torsion"].copy()

    def deflections(self) -> pd.DataFrame:
        """Rows along each shaft: at_mm from its inner end, displacements x_um and y_um under load."""
        return self.content["deflections"].copy()

    @fit_for_paper
    def plot(self) -> "Figure":
        """Shafts in side view with the forces on their bearings, over their deflections.

        Raises FacegearError where no pinion has a shaft.
        """
        from facegear.config.machine_layout import lumped_sections
        from facegear.plots.shafts import figures

        pair = self.values["tooth_pair"]
        sections = lumped_sections(self.values["transmission"], pair)
        width = pair["pinion"] and pair["pinion"]["width_mm"]
        drawn = figures(self.content["bearings"], self.content["deflections"], *sections, width)
        if not drawn:
            raise FacegearError(f"{self.values['case']}: no pinion has a shaft, there is nothing to draw")
        return drawn[0]
