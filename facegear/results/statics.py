"""The machine at rest under its mean torques."""

from typing import ClassVar

import pandas as pd

from facegear.results.base import Result


class StaticsResult(Result):
    """Force of every mesh at rest with its mean stiffness; torques, speeds and powers of all bodies."""

    STAGE: ClassVar = "ratings"

    def table(self) -> pd.DataFrame:
        """One row a mesh: flank, force_n (negative on the back flank), pinion_torque_n_m, power_kw.

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
