"""Results of loaded contact: contact, stiffness, law of the meshes."""

from typing import TYPE_CHECKING, ClassVar

import numpy as np
import pandas as pd

from facegear.arrays import AnyArray, Arrays
from facegear.contact.pattern import EDGES, imprint
from facegear.errors import FacegearError, require_choice
from facegear.meshing.stiffness_source import series_of
from facegear.pipeline.results.base import Result, fit_for_paper
from facegear.report.figures.contact import contact_curves, contact_pattern
from facegear.report.figures.description import Figure
from facegear.report.figures.stiffness import harmonic_amplitudes, stiffness_curve

if TYPE_CHECKING:
    import xarray as xr


def pressure_dataset(arrays: Arrays) -> "xr.Dataset":
    """Arrange the pressures of contact lines as arrays over torque_n_m, position, pair and plane.

    `position` is a fraction of a pitch, `pair` the number of a tooth pair (0, and neighbours), `plane`
    a plane across the pinion's axis. `pressure_mpa`, `pressure_error_mpa` and `half_width_mm` are nan
    unless the plane is loaded away from edges; `line_load_n_per_mm` is zero where unloaded; `where` is
    one of EDGES, empty where unloaded. Coordinates `pinion_radius_mm` (position, pair, plane), distance
    from the pinion's axis, and `axial_mm` (plane), place along it, put the contact lines on the
    pinion's flank.

    Parameters
    ----------
    arrays : Arrays
        Arrays `pressure` of stage contact (PRESSURE_ARRAYS): one row for each loaded plane.

    Returns
    -------
    xr.Dataset
        The arrays with their coordinates.
    """
    import xarray as xr  # a third of a second, and few answers are asked for as a dataset

    axes = {name: np.unique(arrays[f"contact_{name}"]) for name in ("position", "tooth")}
    axes = {"torque_n_m": np.unique(arrays["line_torque_n_m"]), **axes}
    points = 1e3 * arrays["contact_point_m"]
    shape = (*(axis.size for axis in axes.values()), points.shape[1])
    rows = [np.searchsorted(axis, arrays[f"line_{name}"]) for name, axis in axes.items()]
    cells = (*rows, arrays["line_plane"])
    inside = arrays["line_where"] == EDGES.index("inside")

    def spread(values: AnyArray, rest: float | str) -> tuple[tuple[str, ...], AnyArray]:
        """Put one value a loaded plane into an array (torques, positions, pairs, planes), `rest`
        elsewhere; return its axes and it.
        """
        array = np.full(shape, rest, dtype=object if isinstance(rest, str) else float)
        array[cells] = values
        return ("torque_n_m", "position", "pair", "plane"), array.astype(str) if rest == "" else array

    def variable(name: str, scale: float) -> tuple[tuple[str, ...], AnyArray]:
        """Spread a quantity times `scale`, nan for planes that are loaded near an edge or not at all."""
        return spread(np.where(inside, scale * arrays[name], np.nan), np.nan)

    lines = np.hypot(points[..., 0], points[..., 2]).reshape(*shape[1:])
    return xr.Dataset(
        {
            "pressure_mpa": variable("line_pressure_pa", 1e-6),
            "pressure_error_mpa": variable("line_error_pa", 1e-6),
            "half_width_mm": variable("line_half_width_m", 1e3),
            "line_load_n_per_mm": spread(1e-3 * arrays["line_load_n_per_m"], 0.0),
            "where": spread(np.array(EDGES, dtype=object)[arrays["line_where"]], ""),
        },
        coords={
            "torque_n_m": axes["torque_n_m"],
            "position": axes["position"],
            "pair": axes["tooth"],
            "axial_mm": ("plane", points[0, :, 1]),
            "pinion_radius_mm": (("position", "pair", "plane"), lines),
        },
    )


class ContactResult(Result):
    """Loaded contact of one mesh: transmission error, stiffness, load shares and pressures by position
    and torque.
    """

    STAGE: ClassVar = "contact"

    def table(self) -> pd.DataFrame:
        """One row a torque and position; columns in docs/reference/stages.md.

        Torques are on the pinion, position is a fraction of a pitch. ste_um is the transmission error
        along the line of action, backlash taken up on the drive side. k_average is force / (STE -
        unloaded STE), k_local d force / d STE. load_share_pair_m1 is the share of the torque of the
        pair one tooth behind, p1 one ahead. Residuals are relative.

        Columns: torque_n_m, position, ste_um, unloaded_ste_um, k_average_n_per_m, k_local_n_per_m,
        pairs_in_contact, load_share_pair_m2, load_share_pair_m1, load_share_pair_0, load_share_pair_p1,
        load_share_pair_p2, pressure_mpa, pressure_error_mpa, tip_line_load_n_per_mm, tip_length_mm,
        fillet_share, interference_um, kkt_residual, torque_residual; for teeth other than spur ones the
        force and moment of the pinion on the gear (force_x_n to moment_z_n_m) and pinion_axial_n, as in
        `by_flank`.

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
        """Measure the contact imprint along the face, one row a torque.

        A loaded plane across the pinion's axis counts half way to its neighbours, within the gear's
        face.

        Returns
        -------
        pd.DataFrame
            Columns torque_n_m, length_mm, over_face_width (length over the gear's face width) and
            middle_mm (from the gear's axis).
        """
        gear = self.values["tooth_pair"]["face_gear"]
        ends = 1e-3 * gear["inner_radius_mm"], 1e-3 * gear["outer_radius_mm"]
        rows = imprint(self.content["pressure"], ends)
        names = ("torque_n_m", "length_mm", "over_face_width", "middle_mm")
        return pd.DataFrame(rows * np.array([1.0, 1e3, 1.0, 1e3]), columns=list(names))

    def by_flank(self) -> pd.DataFrame:
        """`by_torque` for drive and back flank of the upper and the lower gear, with the errors of each.

        They differ where `tooth_pair.assembly` gives errors, which hold for the upper gear's drive flank, and
        for teeth that are not symmetric. Teeth other than spur ones have more columns: load_share_max, the
        mean force and moment of the pinion on the gear about the crossing of the nominal axes (force_x_n to
        moment_z_n_m), and pinion_axial_n, the force on the pinion outwards along its axis; a back flank is
        seen in a mirror, x reversed.

        Columns: gear, flank, offset_um, shaft_angle_error_deg, gear_axial_um, torque_n_m, positions,
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
        return pressure_dataset(self.content["pressure"])

    @fit_for_paper
    def plot(self, figure: str = "pattern") -> "Figure":
        """`pattern`: largest pressure over a pitch; `curves`: transmission error, stiffness, load shares.

        Parameters
        ----------
        figure : str
            Kind of the figure, one of those above.

        Returns
        -------
        Figure
            The figure.
        """
        if require_choice(figure, ("pattern", "curves"), "plot") == "curves":
            return contact_curves(self.content["ltca"])
        return contact_pattern(self.content["pressure"])


class StiffnessResult(Result):
    """Mesh stiffness k(t) of one mesh over a pitch, which the lumped model takes as a Fourier series."""

    STAGE: ClassVar = "stiffness"

    def table(self) -> pd.DataFrame:
        """One row an order j kept of k = sum of sin_n_per_m sin(j w t) + cos_n_per_m cos(j w t), w the
        mesh frequency.

        `truncation_error_n_per_m` is what orders above j amount to, `sampling_error_n_per_m` what the
        number of positions does; `e_*` are the same of the unloaded transmission error; means of both
        definitions are equal in all rows.

        Columns: order, sin_n_per_m, cos_n_per_m, amplitude_n_per_m, truncation_error_n_per_m,
        sampling_error_n_per_m, e_sin_um, e_cos_um, e_peak_to_peak_um, e_truncation_error_um,
        mean_average_n_per_m, mean_local_n_per_m.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["harmonics"].copy()

    def curve(self) -> pd.DataFrame:
        """k over a pitch (position 0 to 1) as computed, and by the series kept of it, N/m.

        Columns: position, k_n_per_m, k_series_n_per_m.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["tvms"].copy()

    def over_angle(self, points: int = 64) -> pd.DataFrame:
        """Return k over the angle of the pinion in one of its pitches.

        The series is the one that is kept, of a mesh that is in its reference phase at angle 0; for
        programs that take a curve where this one takes Fourier orders.

        Parameters
        ----------
        points : int
            Number of evenly spaced angles.

        Returns
        -------
        pd.DataFrame
            A row for each angle: pinion_angle_deg, k_n_per_m.
        """
        if points < 1:
            raise FacegearError(f"points = {points}: must be at least 1")
        cycles = np.arange(points) / points
        pitch = 360.0 / self.values["tooth_pair"]["pinion_teeth"]
        stiffness = series_of(self.content["harmonics"])(cycles)
        return pd.DataFrame({"pinion_angle_deg": pitch * cycles, "k_n_per_m": stiffness})

    @fit_for_paper
    def plot(self, figure: str = "curve") -> "Figure":
        """`curve` over a mesh period, or amplitudes of its `harmonics`.

        Parameters
        ----------
        figure : str
            Kind of the figure, one of those above.

        Returns
        -------
        Figure
            The figure.
        """
        if require_choice(figure, ("curve", "harmonics"), "plot") == "curve":
            return stiffness_curve(self.content["tvms"])
        return harmonic_amplitudes(self.content["spectrum"])


class MeshLawResult(Result):
    """Load-dependent mesh law: force of every flank over mesh phase and deflection, as contact gives
    it.
    """

    STAGE: ClassVar = "mesh_law"

    def table(self) -> pd.DataFrame:
        """Mean force and slope over a pitch at every level of deflection, by gear and flank.

        `table_rms_percent` and `table_largest_percent` are the errors of the fitted table against
        contact between levels, in percent of the mean force at the last level. torque_n_m on the pinion
        belongs to force_n.

        Columns: gear, flank, deflection_um, torque_n_m, force_n, slope_n_per_m, table_rms_percent,
        table_largest_percent.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["levels"].copy()

    def arrays(self) -> dict[str, AnyArray]:
        """Return the Fourier series over mesh phase of force and slope at every level of deflection, as
        `stiffness/law.npz` holds them.

        Returns
        -------
        dict[str, AnyArray]
            Arrays by name, of LAW_ARRAYS: levels (tables, levels) in m, forces and slopes (tables,
            levels, 2, orders) in N and N/m, table of each flank (2, 2).
        """
        return {name: values.copy() for name, values in self.content["law"].items()}
