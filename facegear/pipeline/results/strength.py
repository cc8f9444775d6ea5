"""Results of strength and friction: root stress, safety and life, loss, heat and film."""

from typing import TYPE_CHECKING, ClassVar

import pandas as pd

from facegear.errors import require_choice
from facegear.pipeline.results.base import Result, fit_for_paper
from facegear.report.figures.description import Figure
from facegear.report.figures.friction import along_path, efficiency_map, machine_heat, over_flank
from facegear.report.figures.strength import (
    along_face_figure,
    damage_by_bin,
    life,
    passage_figure,
    stress_over_speed,
)

if TYPE_CHECKING:
    import xarray as xr


class RootStressResult(Result):
    """Stress at the fillets of both gears while a tooth passes through the mesh."""

    STAGE: ClassVar = "root_stress"

    def table(self) -> pd.DataFrame:
        """Peak tension of each fillet with its place, a row a torque, body and fillet
        (docs/explanation/strength.md).

        `fillet` is `loaded` or `other`, below the loaded or the other flank. `passage` is the position
        of the tooth in pitches, radius_mm and tangent_deg the place of the peak along the face and down
        the fillet.

        Columns: torque_n_m, body, fillet, largest_mpa, largest_error_mpa, passage, radius_mm,
        tangent_deg, at_30_deg_mpa, smallest_mpa.

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
        """Return the stress while a tooth passes through the mesh, over torque, passage, fillet and the
        fillet's gauges.

        Parameters
        ----------
        body : str
            `pinion` or `face_gear`.

        Returns
        -------
        xr.DataArray
            Stress, MPa, tension positive, over torque_n_m, passage (pitches), fillet (`loaded`,
            `other`), `down` the fillet and `along` the face.
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
    def plot(self, figure: str = "passage") -> "Figure":
        """Root stress over a tooth's `passage` through the mesh, or along the `face`.

        Parameters
        ----------
        figure : str
            Kind of the figure, one of those above.

        Returns
        -------
        Figure
            The figure.
        """
        if require_choice(figure, ("passage", "face"), "plot") == "passage":
            return passage_figure(self.content["passage"])
        return along_face_figure(self.content["along_face"])


class DynamicStressResult(Result):
    """Largest root stress of every mesh at the nominal speed: with its mean force, and running."""

    STAGE: ClassVar = "dynamic_root_stress"

    def table(self) -> pd.DataFrame:
        """A row a mesh: forces, dynamic factor, root stress of both bodies
        (docs/explanation/strength.md).

        `mean` is the largest stress over a passage with the mean force, `running` the largest of the
        history, `bound` that with the largest force all through the passage. dynamic_factor is largest
        over mean force.

        Columns: mesh, mean_force_n, largest_force_n, dynamic_factor, pinion_mean_mpa,
        pinion_running_mpa, pinion_bound_mpa, face_gear_mean_mpa, face_gear_running_mpa,
        face_gear_bound_mpa, pressure_mean_mpa, pressure_bound_mpa, within_torques_solved.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["dynamic_stress"].copy()


class StressOverSpeedResult(Result):
    """Largest root stress and pressure of all meshes under every motion known at a speed."""

    STAGE: ClassVar = "stress_over_speed"

    def table(self) -> pd.DataFrame:
        """A row a speed and motion (direction of the sweep or branch): stress under the largest mesh
        force, an upper bound.

        dynamic_factor is that force over the largest mesh force at standstill; `worst` marks the
        hardest motion at a speed. docs/explanation/strength.md says how.

        Columns: motion, class, speed_rpm, mesh, largest_force_n, dynamic_factor, pinion_mpa,
        face_gear_mpa, pressure_mpa, within_torques_solved, worst.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["stress_over_speed"].copy()

    @fit_for_paper
    def plot(self) -> "Figure":
        """Root stress, pressure and dynamic factor over speed.

        Returns
        -------
        Figure
            The figure.
        """
        return stress_over_speed(self.content["stress_over_speed"], self.values["dynamics"]["speed_rpm"])


class RatingResult(Result):
    """Safety against tooth breakage and pitting, and life, under the duty cycle of section strength."""

    STAGE: ClassVar = "rating"

    def table(self) -> pd.DataFrame:
        """A row a flank, failure and method: stress, safety, verdict and life (docs/explanation/strength.md).

        Columns: body, gear, flank, failure, method, stress_mpa, stress_error_mpa, allowed_mpa, cycles,
        safety, required, verdict, reason, caveat, damage, life_hours, within_torques_solved.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["rating"].copy()

    def safety(self) -> pd.DataFrame:
        """A row a flank: safety against each failure, life, reliability where a card has it, verdict.

        `standard_*` are by the method of the standard; edge_* are line load and length of contact on
        tip edges under the largest torque. Scuffing and micropitting stand where flanks are lubricated
        and loads are the machine's.

        Columns: body, flank, verdict, bending_safety, standard_bending_safety, pitting_safety,
        standard_pitting_safety, edge_line_load_n_per_mm, edge_length_mm, life_hours, nearest_limit,
        reason, caveat, within_torques_solved, scuffing_safety, scuffing_margin_k, smallest_film_ratio,
        micropitting_safety.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["safety"].copy()

    def damage(self) -> pd.DataFrame:
        """A row a flank, failure, method and bin of the duty cycle: largest torque and stress, sums of
        cycles and damage.

        Columns: body, gear, flank, failure, method, bin, torque_n_m, speed_rpm, hours, stress_mpa,
        cycles, damage, within_torques_solved.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["damage"].copy()

    @fit_for_paper
    def plot(self, figure: str = "life") -> "Figure":
        """Every bin of the duty cycle beside the stress that may be repeated so often, or its `damage`.

        Parameters
        ----------
        figure : str
            Kind of the figure, one of those above.

        Returns
        -------
        Figure
            The figure.
        """
        if require_choice(figure, ("life", "damage"), "plot") == "life":
            return life(self.content["rating"], self.content["damage"], self.content["curves"])
        return damage_by_bin(self.content["rating"], self.content["damage"])


class FrictionResult(Result):
    """Sliding, loss, temperatures and film of one mesh by torque, position and speed.

    docs/explanation/friction.md has the formulas.
    """

    STAGE: ClassVar = "lubrication"
    BESIDE: ClassVar = {"pressure": ("contact", "pressure")}

    def table(self) -> pd.DataFrame:
        """A row a torque (N m on the pinion) at the nominal speed: loss factor, efficiency,
        temperatures, film, safeties.

        Columns: torque_n_m, speed_rpm, friction_model, loss_factor, loss_factor_min, loss_factor_max,
        mean_friction, loss_w, efficiency, pinion_heat_w, face_gear_heat_w, pinion_bulk_c,
        face_gear_bulk_c, largest_sliding_m_per_s, largest_flash_k, flash_position, flash_pair,
        flash_axial_mm, contact_temperature_c, allowed_contact_temperature_c,
        allowed_contact_temperature_source, scuffing_safety, scuffing_margin_k, mean_flash_k,
        integral_temperature_c, allowed_integral_temperature_c, integral_safety, smallest_film_um,
        smallest_short_film_um, smallest_film_ratio, smallest_micropitting_film_ratio,
        micropitting_safety.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["by_torque"].copy()

    def positions(self) -> pd.DataFrame:
        """A row a torque and position in a pitch: loss, largest flash temperature rise, thinnest film.

        Columns: torque_n_m, position, loss_factor, loss_w, largest_flash_k, smallest_film_um,
        smallest_film_ratio.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["positions"].copy()

    def limits(self) -> pd.DataFrame:
        """Percentage of the loss that lies outside each limit of validity of the friction model, by
        torque.

        Columns: friction_model, limit, limit_source, torque_n_m, loss_outside_percent.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["limits"].copy()

    def map(self) -> pd.DataFrame:
        """A row a torque and speed: loss, efficiency, temperature, film ratio.

        Columns: torque_n_m, speed_rpm, loss_w, efficiency, largest_flash_k, contact_temperature_c,
        smallest_film_ratio.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["map"].copy()

    @fit_for_paper
    def plot(self, figure: str = "path") -> "Figure":
        """`path`: sliding and temperature along the path of contact; `flank`: loss and temperature over the
        flank; `efficiency`: over torque and speed.

        Parameters
        ----------
        figure : str
            Kind of the figure, one of those above.

        Returns
        -------
        Figure
            The figure.
        """
        if require_choice(figure, ("path", "flank", "efficiency"), "plot") == "path":
            return along_path(self.content["local"])
        if figure == "flank":
            return over_flank(self.content["local"], self.content["pressure"])
        return efficiency_map(self.content["map"])


class MachineLossResult(Result):
    """Loss of every mesh and heat of every body, at the nominal load and over the duty cycle."""

    STAGE: ClassVar = "machine_loss"

    def table(self) -> pd.DataFrame:
        """A row a bin, 0 being the nominal load at rest and -1 the whole duty cycle: loss and efficiency.

        Columns: bin, hours, speed_rpm, power_in_w, power_through_meshes, loss_w, loss_percent, efficiency,
        energy_lost_kwh, within_torques_solved.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["machine"].copy()

    def meshes(self) -> pd.DataFrame:
        """A row a bin and loaded flank: power, loss, temperatures, safety, film; bins as in `table`.

        Torques on the pinion: mean, and largest of the bin. loss_in_motion_w is the mean loss in the
        running machine, bin 0 alone.

        Columns: bin, speed_rpm, mesh, flank, pinion_torque_n_m, largest_torque_n_m, power_w, loss_w,
        loss_percent, loss_in_motion_w, pinion_heat_w, face_gear_heat_w, pinion_bulk_c,
        face_gear_bulk_c, largest_flash_k, contact_temperature_c, scuffing_safety, scuffing_margin_k,
        smallest_film_ratio, smallest_micropitting_film_ratio, micropitting_safety,
        within_torques_solved.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["meshes"].copy()

    def bodies(self) -> pd.DataFrame:
        """A row a bin and body: heat that friction brings to it, and its bulk temperature; bins as in
        `table`.

        Columns: bin, speed_rpm, body, heat_w, bulk_c.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["bodies"].copy()

    @fit_for_paper
    def plot(self) -> "Figure":
        """Loss of every mesh and heat of every body at the nominal load.

        Returns
        -------
        Figure
            The figure.
        """
        return machine_heat(self.content["meshes"], self.content["bodies"])
