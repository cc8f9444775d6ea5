"""The load-dependent law of the meshes."""

from typing import ClassVar

import pandas as pd

from facegear.arrays import AnyArray
from facegear.results.base import Result


class MeshLawResult(Result):
    """Force of every flank over phase and deflection, as contact gives it."""

    STAGE: ClassVar = "mesh_law"

    def table(self) -> pd.DataFrame:
        """Mean force and slope at every level, with the error of the table against contact between levels.

        Columns: gear, flank, deflection_um, torque_n_m, force_n, slope_n_per_m, table_rms_percent,
        table_largest_percent.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["levels"].copy()

    def arrays(self) -> dict[str, AnyArray]:
        """Return the Fourier series of force and slope at every level, as `stiffness/law.npz` holds them.

        Returns
        -------
        dict[str, AnyArray]
            Arrays by name, of LAW_ARRAYS: levels (tables, levels) in m, forces and slopes (tables, levels, 2,
            orders) in N and N/m, table of each flank (2, 2).
        """
        return {name: values.copy() for name, values in self.content["law"].items()}
