"""Loaded tooth contact."""

from typing import TYPE_CHECKING, ClassVar

import pandas as pd

from facegear.errors import chosen
from facegear.results.base import Result

if TYPE_CHECKING:
    import xarray as xr

    from facegear.plots.style import Figure


class ContactResult(Result):
    """Transmission error, stiffness, load shares and pressures at every position and torque."""

    STAGE: ClassVar = "contact"

    def table(self) -> pd.DataFrame:
        """One row a torque and position; columns in docs/stages.md."""
        return self.content["ltca"].copy()

    def by_torque(self) -> pd.DataFrame:
        """One row a torque: stiffness, peak-to-peak transmission error, pressure, radius of the contact path.

        Peak-to-peak values are those of the positions solved, and so a lower bound of the true ones.
        """
        return self.content["by_torque"].copy()

    def by_flank(self) -> pd.DataFrame:
        """`by_torque` for drive and back flank of the upper and the lower gear, with the errors of each.

        They differ where `tooth_pair.assembly` gives errors, which hold for the upper gear's drive flank.
        """
        return self.content["by_flank"].copy()

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
