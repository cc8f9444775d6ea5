"""Loaded tooth contact."""

from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

import pandas as pd

from facegear.contact.columns import LTCA_COLUMNS, PRESSURE_ARRAYS
from facegear.results.base import Kept, Result, chosen

if TYPE_CHECKING:
    import xarray as xr

    from facegear.plots.style import Figure


class ContactResult(Result):
    """Transmission error, stiffness, load shares and pressures at every position and torque."""

    FILES: ClassVar = {
        "ltca": Kept("contact/ltca.csv", LTCA_COLUMNS),
        "pressure": Kept("contact/pressure.npz", PRESSURE_ARRAYS),
    }

    def table(self) -> pd.DataFrame:
        """One row a torque and position; columns in docs/stages.md."""
        return self.content["ltca"].copy()

    def pressures(self) -> "xr.Dataset":
        """Pressure (MPa) over torque, position, pair of teeth, and the nodes of the pinion's flank.

        Coordinates `pinion_radius_mm` and `gear_radius_mm` (profile, width) place the nodes. Nodes that an
        edge of either tooth cuts, whose pressure has no limit as the mesh is refined, count as unloaded.
        """
        from facegear.results.pressures import pressure_dataset

        return pressure_dataset(self.content["pressure"])

    def plot(self, what: str = "pattern") -> "Figure":
        """`pattern`: largest pressure over a pitch; `curves`: transmission error, stiffness, load shares."""
        from facegear.plots.contact import contact_curves, contact_pattern

        if chosen(what, ("pattern", "curves"), "plot") == "curves":
            return contact_curves(self.content["ltca"])
        return contact_pattern(self.content["pressure"])

    def save(self, folder: str | Path) -> list[Path]:
        """Write `contact/ltca.csv`, `contact/pressure.npz` and, for ParaView, `contact/pressure.vtu`."""
        from facegear.contact.tables import pressure_surface
        from facegear.io.meshes import write_vtu

        vtu = Path(folder) / "contact" / "pressure.vtu"
        paths = super().save(folder)
        write_vtu(vtu, *pressure_surface(self.content["pressure"]))
        return [*paths, vtu]
