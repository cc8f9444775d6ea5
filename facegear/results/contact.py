"""Loaded tooth contact."""

from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

import pandas as pd

from facegear.contact.columns import LOAD_ARRAYS, LTCA_FINITE, PRESSURE_ARRAYS
from facegear.errors import chosen
from facegear.results.base import Kept, Result

if TYPE_CHECKING:
    import xarray as xr

    from facegear.plots.style import Figure


class ContactResult(Result):
    """Transmission error, stiffness, load shares and pressures at every position and torque."""

    FILES: ClassVar = {
        "ltca": Kept("contact/ltca.csv", LTCA_FINITE),
        "by_torque": Kept("contact/by_torque.csv", ("torque_n_m", "ste_peak_to_peak_um", "path_radius_mm")),
        "pressure": Kept("contact/pressure.npz", PRESSURE_ARRAYS),
        "loads": Kept("contact/loads.npz", LOAD_ARRAYS),
    }

    def table(self) -> pd.DataFrame:
        """One row a torque and position; columns in docs/stages.md."""
        return self.content["ltca"].copy()

    def by_torque(self) -> pd.DataFrame:
        """One row a torque: stiffness, peak-to-peak transmission error, pressure, radius of the contact path.

        Peak-to-peak values are those of the positions solved, and so a lower bound of the true ones.
        """
        return self.content["by_torque"].copy()

    def pressures(self) -> "xr.Dataset":
        """Pressure (MPa) with its error, and line load (N/mm), over torque, position, pair and plane.

        Planes lie across the pinion's axis; coordinates say where its contact line meets each. Where a tip
        edge or an end of the face is nearer than the strip's half-width, pressure has no limit: nan, and
        `where` says what is near.
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
        """Write two tables, `pressure.npz`, `loads.npz` and, for ParaView, `pressure.vtu`."""
        from facegear.contact.pattern import pressure_surface
        from facegear.io.meshes import write_vtu

        vtu = Path(folder) / "contact" / "pressure.vtu"
        paths = super().save(folder)
        write_vtu(vtu, *pressure_surface(self.content["pressure"]))
        return [*paths, vtu]
