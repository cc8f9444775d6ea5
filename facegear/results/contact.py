"""Loaded tooth contact."""

from typing import TYPE_CHECKING, ClassVar

import numpy as np
import pandas as pd

from facegear.errors import require_choice
from facegear.results.base import Result
from facegear.results.paper_figure import fit_for_paper

if TYPE_CHECKING:
    import xarray as xr

    from facegear.plots.description import Figure


class ContactResult(Result):
    """Transmission error, stiffness, load shares and pressures at every position and torque."""

    STAGE: ClassVar = "contact"

    def table(self) -> pd.DataFrame:
        """One row a torque and position; columns in docs/reference/stages.md.

        Columns: torque_n_m, position, ste_um, unloaded_ste_um, k_average_n_per_m, k_local_n_per_m,
        pairs_in_contact, load_share_pair_m2, load_share_pair_m1, load_share_pair_0, load_share_pair_p1,
        load_share_pair_p2, pressure_mpa, pressure_error_mpa, tip_line_load_n_per_mm, tip_length_mm,
        fillet_share, interference_um, kkt_residual, torque_residual.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["ltca"].copy()

    def by_torque(self) -> pd.DataFrame:
        """One row a torque: stiffness, peak-to-peak transmission error, pressure, radius of the contact path.

        Peak-to-peak values are those of the positions solved, and so a lower bound of the true ones.

        Columns: torque_n_m, positions, k_average_mean_n_per_m, k_average_min_n_per_m, k_average_max_n_per_m,
        k_local_mean_n_per_m, ste_peak_to_peak_um, ste_peak_to_peak_half_um, unloaded_peak_to_peak_um,
        pairs_min, pairs_max, pressure_mpa, pressure_error_mpa, tip_line_load_n_per_mm, tip_length_mm,
        fillet_share, interference_um, path_radius_mm.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["by_torque"].copy()

    def imprint(self) -> pd.DataFrame:
        """One row a torque: length of the contact imprint along the face, over the gear's face width, its
        middle. Planes across the pinion's axis that carry load count with the width that each stands for.

        Returns
        -------
        pd.DataFrame
            The table.
        """
        from facegear.contact.pattern import imprint

        gear = self.values["tooth_pair"]["face_gear"]
        ends = 1e-3 * gear["inner_radius_mm"], 1e-3 * gear["outer_radius_mm"]
        rows = imprint(self.content["pressure"], ends)
        names = ("torque_n_m", "length_mm", "over_face_width", "middle_mm")
        return pd.DataFrame(rows * np.array([1.0, 1e3, 1.0, 1e3]), columns=list(names))

    def by_flank(self) -> pd.DataFrame:
        """`by_torque` for drive and back flank of the upper and the lower gear, with the errors of each.

        They differ where `tooth_pair.assembly` gives errors, which hold for the upper gear's drive flank.

        Columns: gear, flank, offset_um, shaft_angle_error_deg, axial_shift_um, torque_n_m, positions,
        k_average_mean_n_per_m, k_average_min_n_per_m, k_average_max_n_per_m, k_local_mean_n_per_m,
        ste_peak_to_peak_um, ste_peak_to_peak_half_um, unloaded_peak_to_peak_um, pairs_min, pairs_max,
        pressure_mpa, pressure_error_mpa, tip_line_load_n_per_mm, tip_length_mm, fillet_share,
        interference_um, path_radius_mm.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["by_flank"].copy()

    def pressures(self) -> "xr.Dataset":
        """Return pressure (MPa) with its error, and line load (N/mm), over torque, position, pair and plane.

        Planes lie across the pinion's axis; coordinates say where its contact line meets each. Where a tip
        edge or an end of the face is nearer than the strip's half-width, pressure has no limit: nan, and
        `where` says what is near.

        Returns
        -------
        xr.Dataset
            The arrays with their coordinates.
        """
        from facegear.results.pressures import pressure_dataset

        return pressure_dataset(self.content["pressure"])

    @fit_for_paper
    def plot(self, what: str = "pattern") -> "Figure":
        """`pattern`: largest pressure over a pitch; `curves`: transmission error, stiffness, load shares.

        Parameters
        ----------
        what : str
            Kind of the figure, one of those above.

        Returns
        -------
        Figure
            The figure.
        """
        from facegear.plots.contact import contact_curves, contact_pattern

        if require_choice(what, ("pattern", "curves"), "plot") == "curves":
            return contact_curves(self.content["ltca"])
        return contact_pattern(self.content["pressure"])
