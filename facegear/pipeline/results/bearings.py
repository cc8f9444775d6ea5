"""Results of the rolling bearings: loads, stiffness and life."""

from typing import ClassVar

import pandas as pd

from facegear.pipeline.results.base import Result, fit_for_paper
from facegear.report.figures.bearings import bearing_figures
from facegear.report.figures.description import Figure


class BearingLifeResult(Result):
    """Loads, stiffness and life of the rolling bearings of the shafts, with the machine at rest."""

    STAGE: ClassVar = "bearing_life"

    def table(self) -> pd.DataFrame:
        """One row a bearing and bin of the duty cycle, one over the whole cycle, and one of all together.

        `bin` is `all` over the whole cycle, `mean` where there is no duty cycle. Lives are L10 of ISO 281,
        L10r of ISO/TS 16281, and the modified one where its conditions are given; `basis` says on which
        standards they rest.

        Columns: pinion, bearing, bin, torque_n_m, speed_rpm, hours, load_rating_n, equivalent_load_n,
        reference_load_n, l10_million, l10r_million, modified_million, l10_hours, l10r_hours,
        modified_hours, damage_share, required_hours, is_enough, basis.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["life"].copy()

    def loads(self) -> pd.DataFrame:
        """One row a bearing and load: the mean torques (`mean`), and each bin of the duty cycle.

        Loads are those of the shaft on the bearing, motions those of its inner ring; angles of contact are
        positive on the side of the thrust that loads the bearing.

        Columns: pinion, bearing, bin, torque_n_m, x_n, y_n, z_n, tilt_x_n_m, tilt_y_n_m, radial_n, x_um,
        y_um, z_um, tilt_x_urad, tilt_y_urad, hardest_element_n, loaded_elements, zone_deg,
        inner_pressure_mpa, outer_pressure_mpa, least_angle_deg, largest_angle_deg, static_safety.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["loads"].copy()

    def stiffness(self) -> pd.DataFrame:
        """Five rows a bearing and load: its stiffness (5, 5) under the mean load and at both ends of the
        duty cycle, N/m, N/rad and N m/rad.

        `change` is the diagonal entry over that under the mean load, less 1.

        Columns: pinion, bearing, bin, torque_n_m, motion, x, y, z, tilt_x, tilt_y, change.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["stiffness"].copy()

    def over_torque(self) -> pd.DataFrame:
        """One row a bearing and torque: radial load, stiffness along it, load zone and pressure.

        Columns: pinion, bearing, load_fraction, torque_n_m, radial_n, radial_stiffness_n_per_m,
        axial_stiffness_n_per_m, zone_deg, largest_pressure_mpa.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["over_torque"].copy()

    @fit_for_paper
    def plot(self) -> "Figure":
        """Stiffness and load zone of the bearings over the machine's torque.

        Returns
        -------
        Figure
            The figure.
        """
        return bearing_figures(self.content["over_torque"])[0]
