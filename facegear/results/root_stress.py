"""Root stress of both gears."""

from typing import TYPE_CHECKING, ClassVar

import pandas as pd

from facegear.errors import require_choice
from facegear.results.base import Result
from facegear.results.paper_figure import fit_for_paper

if TYPE_CHECKING:
    import xarray as xr

    from facegear.plots.description import Figure


class RootStressResult(Result):
    """Stress at the fillets of both gears while a tooth passes through the mesh."""

    STAGE: ClassVar = "root_stress"

    def table(self) -> pd.DataFrame:
        """Peak of each fillet with its place, a row a torque, body and fillet (docs/explanation/strength.md).

        Columns: torque_n_m, body, fillet, largest_mpa, largest_error_mpa, passage, radius_mm, tangent_deg,
        at_30_deg_mpa, smallest_mpa.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["summary"].copy()

    def by_flank(self) -> pd.DataFrame:
        """`table` for the drive and the back flank of the upper and the lower gear.

        They differ where `tooth_pair.assembly` gives errors, which hold for the upper gear's drive flank.

        Columns: gear, flank, torque_n_m, body, fillet, largest_mpa, largest_error_mpa, passage, radius_mm,
        tangent_deg, at_30_deg_mpa, smallest_mpa.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["by_flank"].copy()

    def stress(self, body: str = "face_gear") -> "xr.DataArray":
        """Return the stress over torque, passage, fillet and the fillet's gauges.

        Parameters
        ----------
        body : str
            `pinion` or `face_gear`.

        Returns
        -------
        xr.DataArray
            Stress, MPa, with its coordinates.
        """
        import xarray as xr  # a third of a second, and few answers are asked for as a dataset

        require_choice(body, ("pinion", "face_gear"), "body")
        arrays = self.content["stress"]
        return xr.DataArray(
            1e-6 * arrays[f"{body}_stress_pa"],
            dims=("torque_n_m", "passage", "fillet", "down", "along"),
            coords={
                "torque_n_m": arrays["torque_n_m"],
                "passage": arrays[f"{body}_passage"],
                "fillet": ["loaded", "other"],
            },
            attrs={"units": "MPa"},
        )

    @fit_for_paper
    def plot(self, what: str = "passage") -> "Figure":
        """Root stress over a tooth's `passage` through the mesh, or along the `face`.

        Parameters
        ----------
        what : str
            Kind of the figure, one of those above.

        Returns
        -------
        Figure
            The figure.
        """
        from facegear.plots.strength import along_face_figure, passage_figure

        if require_choice(what, ("passage", "face"), "plot") == "passage":
            return passage_figure(self.content["passage"])
        return along_face_figure(self.content["along_face"])
