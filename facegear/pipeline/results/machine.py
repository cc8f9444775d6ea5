"""Results of the machine at rest: modes, statics, shafts, poses."""

from typing import ClassVar

import pandas as pd

from facegear.build.machine_layout import lumped_sections
from facegear.errors import FacegearError
from facegear.pipeline.results.base import Result, fit_for_paper
from facegear.report.figures.description import Figure
from facegear.report.figures.machine import mode_shapes
from facegear.report.figures.shafts import shafts_figures
from facegear.report.figures.turning_machine import shaft_order_figure


class ModesResult(Result):
    """Undamped modes with constant mesh stiffness: frequencies, classes and shapes, and the contacts
    that are closed in them.
    """

    STAGE: ClassVar = "modal"

    def table(self) -> pd.DataFrame:
        """One row a mode: natural frequency, what moves (symbols), class of the mode.

        `decided` is False where the frequency differs between undecided contacts taken as open and as
        closed.

        Columns: order, frequency_hz, multiplicity, symbols, class, pinion_energy_fraction, decided.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["frequencies"].copy()

    def shapes(self) -> pd.DataFrame:
        """One row a mode, body and degree of freedom: amplitude for unit modal mass, and relative to
        the mode's largest.

        Columns: order, body, dof, amplitude_m_or_rad, relative.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["shapes"].copy()

    def contacts(self) -> pd.DataFrame:
        """One row a mesh and a bearing with clearance: state under load, force, stiffness and its kind.

        The state of a mesh is drive, back, wedged (both flanks), open or undecided. Forces are negative
        on the back flank.

        Columns: contact, state, force_n, stiffness_n_per_m, definition.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["contacts"].copy()

    @fit_for_paper
    def plot(self) -> "Figure":
        """Typical mode shapes, one panel for each kind of mode.

        Returns
        -------
        Figure
            The figure.
        """
        return mode_shapes(self.content["frequencies"], self.content["shapes"])


class StaticsResult(Result):
    """Force of every mesh at rest with its mean stiffness; torques, speeds and powers of all bodies."""

    STAGE: ClassVar = "ratings"

    def table(self) -> pd.DataFrame:
        """One row a mesh: loaded flank, force along the line of action (negative on the back flank),
        torque, power to the gear.

        Columns: mesh, flank, force_n, pinion_torque_n_m, power_kw.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["meshes"].copy()

    def bodies(self) -> pd.DataFrame:
        """One row a body: role, torque_n_m, speed_rpm, power_kw (positive: brought in).

        Columns: body, role, torque_n_m, speed_rpm, power_kw, share_of_input_percent.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["bodies"].copy()

    def numbers(self) -> pd.DataFrame:
        """Gear ratio, speeds, mesh frequency, power in and out, and by how much they differ.

        Columns: quantity, value.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["ratings"].copy()


class ShaftsResult(Result):
    """Shafts of pinions and the masses that torques turn, with the machine at rest under its mean torques."""

    STAGE: ClassVar = "shafts"

    def table(self) -> pd.DataFrame:
        """One row a pinion with a shaft: stiffness of its seat without moments, displacement and slope
        under load.

        The seat is where the teeth are. x is tangential, y along the gears' axis, z along the pinion.

        Columns: pinion, stiffness_x_n_per_m, stiffness_y_n_per_m, stiffness_z_n_per_m, x_um, y_um,
        z_um, tilt_x_urad, tilt_y_urad.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["seats"].copy()

    def stiffness(self) -> pd.DataFrame:
        """Five rows a pinion with a shaft: the matrix (5, 5) of its seat's stiffness in x, y, z,
        tilt_x, tilt_y, N, m and rad.

        Columns: pinion, motion, x, y, z, tilt_x, tilt_y.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["stiffness"].copy()

    def bearings(self) -> pd.DataFrame:
        """One row a bearing of a shaft: forces and moments of the shaft on it under the mean torques,
        and the radial force.

        Columns: pinion, bearing, x_n, y_n, z_n, tilt_x_n_m, tilt_y_n_m, radial_n.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["bearings"].copy()

    def torsion(self) -> pd.DataFrame:
        """One row a turning mass: its spring, twist of it and windup to the body under load, natural
        frequencies of its chain.

        Columns: body, mass, inertia_kg_m2, stiffness_n_m_per_rad, torque_n_m, twist_deg, windup_deg,
        frequency_hz.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["torsion"].copy()

    def deflections(self) -> pd.DataFrame:
        """Rows along each shaft: distance at_mm from its inner end, displacements x_um (tangential) and
        y_um under mean load.

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
        pair = self.values["tooth_pair"]
        sections = lumped_sections(self.values["transmission"], pair)
        width = pair["pinion"] and pair["pinion"]["width_mm"]
        drawings = shafts_figures(self.content["bearings"], self.content["deflections"], *sections, width)
        if not drawings:
            raise FacegearError(f"{self.values['case']}: no pinion has a shaft, there is nothing to draw")
        return drawings[0]


class ShaftOrdersResult(Result):
    """Vibration at the orders of turns, by runouts, pitch deviations and single teeth, linearised."""

    STAGE: ClassVar = "shaft_orders"

    def table(self) -> pd.DataFrame:
        """One row an order of a gear's turns and mesh: amplitudes of the flank's error and of the
        elastic force.

        `turning` names the gears; of_mesh is the frequency over the mesh frequency; force_at_rest_n is
        the force turned slowly.

        Columns: turning, order, of_mesh, frequency_hz, mesh, error_um, force_n, force_at_rest_n.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["orders"].copy()

    def over_speed(self) -> pd.DataFrame:
        """One row a pinion speed and one of the largest orders: the mesh with the largest force,
        amplitude in N.

        Columns: speed_rpm, turning, order, of_mesh, frequency_hz, mesh, force_n.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["over_speed"].copy()

    def excited(self) -> pd.DataFrame:
        """Return what each periodic torque of `transmission.excitations` does, linearised.

        Returns
        -------
        pd.DataFrame
            One row a speed (the nominal one first), torque and part: amplitude of the force of a mesh (N) or
            of the torque of the spring before a turning mass (N m). Columns: speed_rpm, body, order, of_mesh,
            frequency_hz, part, force_n, torque_n_m.
        """
        return self.content["excited"].copy()

    @fit_for_paper
    def plot(self) -> "Figure":
        """Forces at all orders at the nominal speed, and the largest orders over speed.

        Raises FacegearError for a machine without anything that turns with its gears.

        Returns
        -------
        Figure
            The figure.
        """
        if self.content["orders"].empty:
            message = "no runout, pitch deviation or single tooth is given, there is nothing to draw"
            raise FacegearError(f"{self.values['case']}: {message}")
        return shaft_order_figure(self.content["orders"], self.content["over_speed"])


class OperatingPoseResult(Result):
    """Pose of every mesh under the machine's mean torques, and the contact there beside that as
    assembled.
    """

    STAGE: ClassVar = "operating_pose"

    def table(self) -> pd.DataFrame:
        """One row a mesh: force, pose, unloaded and loaded path, distance to the ends of the face and
        of the pattern to edges.

        Pinion-side paths are places along its axis; percentages tell what the pose alone changes of
        stiffness, transmission error, pressure and root stress; stiffness_factor is the stiffness over
        the machine's own.

        Columns, among others: force_n, force_as_assembled_n, torque_n_m, tangential_force_n,
        axial_force_n, overturning_moment_n_m, offset_um, gear_axial_um, shaft_angle_error_deg,
        outward_um, closing_um, unloaded_path_mm, to_inner_end_mm, to_outer_end_mm, stiffness_factor,
        mesh, flank.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["meshes"].copy()

    def loads(self) -> pd.DataFrame:
        """One row a mesh and fraction of the mean torques: force, paths (mm along the pinion),
        stiffness over the machine's own.

        Columns, among others: load_fraction, unloaded_path_mm, mesh, flank.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["loads"].copy()

    def leaving(self) -> pd.DataFrame:
        """One row a contact that leaves the face: mesh, fraction of the mean torques at which it does,
        and the end of the face.

        Columns, among others: load_fraction, mesh, end.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["leaving"].copy()

    def check(self) -> pd.DataFrame:
        """The interpolated surface beside the contact solved directly, a row a quantity, for the mesh
        that its pose changes most.

        Columns, among others: surface, direct, quantity.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["check"].copy()
