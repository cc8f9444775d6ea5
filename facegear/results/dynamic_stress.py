"""Root stress of the running machine."""

from typing import ClassVar

import pandas as pd

from facegear.results.base import Result


class DynamicStressResult(Result):
    """Largest root stress of every mesh at the nominal speed: with its mean force, and running."""

    STAGE: ClassVar = "dynamic_root_stress"

    def table(self) -> pd.DataFrame:
        """A row a mesh: forces, dynamic factor, root stress of both bodies (docs/explanation/strength.md).

        Columns: mesh, mean_force_n, largest_force_n, dynamic_factor, pinion_mean_mpa, pinion_running_mpa,
        pinion_bound_mpa, face_gear_mean_mpa, face_gear_running_mpa, face_gear_bound_mpa, pressure_mean_mpa,
        pressure_bound_mpa, within_torques_solved.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["dynamic_stress"].copy()
