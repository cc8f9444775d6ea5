"""Shafts of pinions, and turning masses behind torsional springs."""

from typing import TYPE_CHECKING, ClassVar

import pandas as pd

from facegear.errors import FacegearError
from facegear.results.base import Result
from facegear.results.paper_figure import fit_for_paper

if TYPE_CHECKING:
    from facegear.plots.description import Figure


class ShaftsResult(Result):
    """Shafts of pinions and the masses that torques turn, with the machine at rest under its mean torques."""

    STAGE: ClassVar = "shafts"

    def table(self) -> pd.DataFrame:
        """One row a pinion with a shaft: stiffness without moments, displacement and slope under load.

        Columns: pinion, stiffness_x_n_per_m, stiffness_y_n_per_m, stiffness_z_n_per_m, x_um, y_um, z_um,
        tilt_x_urad, tilt_y_urad.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["seats"].copy()

    def stiffness(self) -> pd.DataFrame:
        """Five rows a pinion with a shaft: its stiffness in x, y, z, tilt_x, tilt_y.

        Columns: pinion, motion, x, y, z, tilt_x, tilt_y.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["stiffness"].copy()

    def bearings(self) -> pd.DataFrame:
        """One row a bearing of a shaft: its forces and moments.

        Columns: pinion, bearing, x_n, y_n, z_n, tilt_x_n_m, tilt_y_n_m, radial_n.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["bearings"].copy()

    def torsion(self) -> pd.DataFrame:
        """One row a turning mass: its spring, twist under load, natural frequencies of its chain.

        Columns: body, mass, inertia_kg_m2, stiffness_n_m_per_rad, torque_n_m, twist_deg, windup_deg,
        frequency_hz.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["torsion"].copy()

    def deflections(self) -> pd.DataFrame:
        """Rows along each shaft: at_mm from its inner end, displacements x_um and y_um under load.

        Columns: pinion, at_mm, x_um, y_um.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["deflections"].copy()

    @fit_for_paper
    def plot(self) -> "Figure":
        """Shafts in side view with the forces on their bearings, over their deflections.

        Raises FacegearError where no pinion has a shaft.

        Returns
        -------
        Figure
            The figure.
        """
        from facegear.config.machine_layout import lumped_sections
        from facegear.plots.shafts import figures

        pair = self.values["tooth_pair"]
        sections = lumped_sections(self.values["transmission"], pair)
        width = pair["pinion"] and pair["pinion"]["width_mm"]
        drawings = figures(self.content["bearings"], self.content["deflections"], *sections, width)
        if not drawings:
            raise FacegearError(f"{self.values['case']}: no pinion has a shaft, there is nothing to draw")
        return drawings[0]
