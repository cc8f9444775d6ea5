"""Results of face gears that bend: their bodies, and their waves in the machine."""

from typing import ClassVar

import pandas as pd

from facegear.pipeline.results.base import Result, fit_for_paper
from facegear.report.figures.description import Figure
from facegear.report.figures.turning_machine import body_shapes, machine_campbell


class GearBodiesResult(Result):
    """Modes and compliance of the face gears that bend, with their hubs fixed."""

    STAGE: ClassVar = "gear_bodies"

    def table(self) -> pd.DataFrame:
        """One row a mode: gear, nodal diameters, frequency at rest, waves in space, speeds at which it
        meets a mesh harmonic.

        forward_hz and backward_hz are its waves at the pinion speed speed_rpm; forward_met_rpm and
        backward_met_rpm are pinion speeds of resonance; frequency_change is the relative numerical
        error of the frequency.

        Columns: gear, nodal_diameters, mode, frequency_hz, round_fraction, gyroscopic_factor,
        stiffening_factor, damping_ratio, hub_axial_sqrt_kg, hub_spin_sqrt_kg_m, hub_sideways_sqrt_kg,
        hub_tilt_sqrt_kg_m, speed_rpm, forward_hz, backward_hz, forward_met_rpm, backward_met_rpm,
        frequency_change.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["modes"].copy()

    def coefficients(self) -> pd.DataFrame:
        """One row a mode: what its equation of motion has, hub held, for unit modal mass.

        In the frame of the body, which turns at W (rad/s), two modes z of one order obey

            z'' + 2 zeta w z' - 2 i c W z' + [w^2 + W^2 B] z = f

        - frequency_hz: w / 2 pi, at rest.
        - gyroscopic_factor: c = int 2 rho U V over the modal mass, from the Coriolis force; a pure number.
        - stiffening_factor: B = (S - P) / M, what the centrifugal stress stiffens less what the centrifugal
          force softens; a pure number.
        - damping_ratio: zeta, which rises with the frequency where `stiffness_damping_s` is given.
        - hub_axial_sqrt_kg, hub_spin_sqrt_kg_m (no nodal diameter), hub_sideways_sqrt_kg and
          hub_tilt_sqrt_kg_m (one nodal diameter): Q, the mass by which an acceleration of the hub along the
          axis, round it, sideways, or tilting about a diameter at height 0 drives the mode; zero elsewhere.

        c and B of a mode are diagonals of full matrices over the modes of an order; `bodies/reduced.npz` has
        these.

        Returns
        -------
        pd.DataFrame
            The table.
        """
        modes = self.content["modes"]
        columns = ["gear", "nodal_diameters", "mode", "frequency_hz", "gyroscopic_factor"]
        couplings = [column for column in modes.columns if column.startswith("hub_")]
        return modes[[*columns, "stiffening_factor", "damping_ratio", *couplings]].copy()

    def bodies(self) -> pd.DataFrame:
        """One row a gear: mass and inertia of its section, compliance at a mesh along the line of
        action, numerical error.

        modal_fraction of that compliance is in the modes; left_out_* are magnitudes of compliances that
        they leave out.

        Columns: gear, mass_kg, inertia_kg_m2, diametral_inertia_kg_m2, elements, coordinates,
        own_compliance_m_per_n, modal_fraction, left_out_between_flanks_m_per_n,
        left_out_between_meshes_m_per_n, frequency_change.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["bodies"].copy()

    def crossings(self) -> pd.DataFrame:
        """One row a pinion speed at which a mesh harmonic meets a wave.

        phase_factor is how many times the force of one mesh drives the wave if all carry the same
        force, 0 where they cancel.

        Columns: gear, nodal_diameters, mode, wave, harmonic, speed_rpm, frequency_hz, phase_factor.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["crossings"].copy()

    def compliance(self) -> pd.DataFrame:
        """One row a gear and order of nodal diameters: motions below a mesh, axial, round the axis and
        radial, by unit forces there.

        Columns: gear, order, axial_m_per_n, round_m_per_n, axial_round_m_per_n, radial_m_per_n,
        axial_radial_m_per_n, round_radial_m_per_n.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["compliance"].copy()

    def influence(self) -> pd.DataFrame:
        """One row for two flanks of a gear: motion of the first against its own force, by 1 N on the
        second, hub fixed.

        Columns: gear, first, first_flank, second, second_flank, compliance_m_per_n.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["influence"].copy()

    @fit_for_paper
    def plot(self) -> "Figure":
        """Sections with their first mode shapes.

        Returns
        -------
        Figure
            The figure.
        """
        return body_shapes(self.content["modes"], self.content["shapes"])


class GearWavesResult(Result):
    """Damped modes at the nominal speed about the static load, and the waves of the face gears in them."""

    STAGE: ClassVar = "gear_waves"

    def table(self) -> pd.DataFrame:
        """One row a mode, gear and nodal diameters: frequency, damping, energy, how much of it travels
        forward.

        Columns, among others: order, frequency_hz, damping_ratio.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["waves"].copy()

    def campbell(self) -> pd.DataFrame:
        """One row a pinion speed and mode: frequency, damping, waves with most of its energy, and the
        line that it belongs to.

        Columns, among others: speed_rpm, line, frequency_hz.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["campbell"].copy()

    def crossings(self) -> pd.DataFrame:
        """One row a pinion speed at which a mesh harmonic meets a mode.

        phase_factor is how many times the force of one mesh drives it if all carry the same force, 0
        where they cancel.

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
        campbell = self.content["campbell"]
        teeth = self.values["tooth_pair"]["pinion_teeth"]
        return machine_campbell(
            campbell, self.content["campbell_crossings"], campbell["speed_rpm"].max(), teeth
        )
