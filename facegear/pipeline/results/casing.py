"""Results of a machine on a casing."""

from typing import ClassVar

import pandas as pd

from facegear.pipeline.results.base import Result, fit_for_paper
from facegear.report.figures.casing import campbell_diagram, load_sharing, sensor_figures
from facegear.report.figures.description import Figure


class CasingLoadsResult(Result):
    """Effects of a casing on the machine: seats, feet and mesh forces at rest, and modes."""

    STAGE: ClassVar = "casing_loads"

    def table(self) -> pd.DataFrame:
        """One row a mesh: force on the casing, on seats that stand still, and the change in percent.

        Columns: mesh, force_n, force_on_fixed_seats_n, change_percent.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["sharing"].copy()

    def seats(self) -> pd.DataFrame:
        """One row a seat: its motion along and about X (to a pinion at angle 0), Y and Z (the gears' axis).

        Columns: seat, x_um, y_um, z_um, tilt_x_urad, tilt_y_urad, tilt_z_urad.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["seats"].copy()

    def feet(self) -> pd.DataFrame:
        """One row a foot: what the casing presses on it with; then all feet, bearings on the ground, the
        loads on the machine, and what is out of balance.

        Columns: foot, x_n, y_n, z_n, tilt_x_n_m, tilt_y_n_m, tilt_z_n_m.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["feet"].copy()

    def modes(self) -> pd.DataFrame:
        """One row a mode of the machine: the part of its kinetic energy in the casing, and whether that is
        half or more.

        Columns: order, frequency_hz, casing_energy_fraction, is_casing_mode.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["modes"].copy()

    @fit_for_paper
    def plot(self) -> "Figure":
        """Forces of the meshes with and without the casing, side by side.

        Returns
        -------
        Figure
            The figure.
        """
        return load_sharing(self.content["sharing"])

    @fit_for_paper
    def plot_campbell(self) -> "Figure":
        """Modes of the machine over speed, those of the casing in colour, with multiples of the mesh
        frequency.

        Returns
        -------
        Figure
            The figure.
        """
        return campbell_diagram(self.content["campbell"], self.content["crossings"])


class CasingResponseResult(Result):
    """Acceleration of the casing's sensors over speed, linear about the mean load."""

    STAGE: ClassVar = "casing_response"

    def table(self) -> pd.DataFrame:
        """One row a speed, order of the mesh and sensor: amplitude of the acceleration along the sensor.

        Columns: speed_rpm, order, frequency_hz, sensor, acceleration_m_per_s2.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["sensors"].copy()

    @fit_for_paper
    def plot(self) -> "Figure":
        """Acceleration of every sensor over speed, a curve for each order of the mesh.

        Returns
        -------
        Figure
            The figure.
        """
        return sensor_figures(self.content["sensors"])[0]
