"""Where the machine's own forces put the teeth of every mesh."""

from typing import ClassVar

import pandas as pd

from facegear.results.base import Result


class OperatingPoseResult(Result):
    """Pose of every mesh under the machine's mean torques, and what contact makes of it."""

    STAGE: ClassVar = "operating_pose"

    def table(self) -> pd.DataFrame:
        """One row a mesh: force, pose, unloaded and loaded path, distance to the ends of the face.

        And what the pose alone changes of stiffness, transmission error, pressure and root stress, percent.

        Columns, among others: force_n, force_as_assembled_n, torque_n_m, tangential_force_n, axial_force_n,
        overturning_moment_n_m, offset_um, axial_shift_um, shaft_angle_error_deg, outward_um, closing_um,
        unloaded_path_mm, to_inner_end_mm, to_outer_end_mm, stiffness_factor, mesh, flank.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["meshes"].copy()

    def loads(self) -> pd.DataFrame:
        """One row a mesh and fraction of the torques: force, paths, stiffness over the machine's own.

        Columns, among others: load_fraction, unloaded_path_mm, mesh, flank.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["loads"].copy()

    def leaving(self) -> pd.DataFrame:
        """One row a contact that leaves the face: mesh, fraction of the torques, end of the face, mm.

        Columns, among others: load_fraction, mesh, end.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["leaving"].copy()

    def check(self) -> pd.DataFrame:
        """The surface beside the contact solved directly, for the mesh that its pose changes most.

        Columns, among others: surface, direct, quantity.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["check"].copy()
