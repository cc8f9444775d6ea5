"""Results of load sharing: at one speed, over the hunting cycle, and its map."""

from typing import TYPE_CHECKING, ClassVar

import pandas as pd

from facegear.errors import FacegearError, require_choice
from facegear.pipeline.results.base import Result, fit_for_paper, require_answers
from facegear.report.figures.description import Figure
from facegear.report.figures.sharing import hunting_figure, sensitivity_figure, sharing_figure
from facegear.report.figures.sharing_map import sharing_map_figure
from facegear.sharing.tables import collect_tables

if TYPE_CHECKING:
    from collections.abc import Mapping

STUDY = "compared"
"""Name under which compared machines stand in tables, as points of one study."""


class LoadSharingResult(Result):
    """Load-sharing coefficients of every group of meshes that share a load: largest mesh force over the
    mean of the group.
    """

    STAGE: ClassVar = "load_sharing"

    def table(self) -> pd.DataFrame:
        """One row a group: mean coefficient with the half_width of its 95 % interval, and what it was
        averaged over.

        `lost_fraction` is the time in which a path is out of contact, `undefined_fraction` that in
        which all are; `starts_low` and `starts_high` are the range of means from other starts.

        Columns: group, kind, mean, half_width, minimum, maximum, cycle_minimum, cycle_low, cycle_high,
        lost_fraction, undefined_fraction, motion, cycles, starts_low, starts_high, motions_from_starts,
        periodic.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["summary"].copy()

    def curve(self) -> pd.DataFrame:
        """Coefficient of every group over one mesh cycle (cycle_fraction 0 to 1), with the envelope
        over all cycles.

        `lost_fraction` is the fraction of cycles in which a path is out of contact at that instant.

        Columns: group, kind, cycle_fraction, time_s, coefficient, envelope_low, envelope_high,
        lost_fraction.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["curve"].copy()

    @fit_for_paper
    def plot(
        self,
        kind: str | None = None,
        label: str = "as configured",
        beside: "Mapping[str, LoadSharingResult] | None" = None,
        title: str = "Load sharing",
    ) -> "Figure":
        """Draw the coefficient over one mesh cycle, of one kind of group.

        Parameters
        ----------
        kind : str or None
            Kind of group; None for the first one.
        label : str
            Name of this result in the legend.
        beside : 'Mapping[str, LoadSharingResult] | None'
            Results of other gearboxes by label, drawn in the same axes; None for this one alone.
        title : str
            Title of the figure.

        Returns
        -------
        Figure
            The figure.
        """
        require_answers(beside or {}, LoadSharingResult)
        results = {label: self, **(beside or {})}
        frames = {
            part: collect_tables({(STUDY, name): result.content[part] for name, result in results.items()})
            for part in ("curve", "summary")
        }
        group_kinds = tuple(dict.fromkeys(self.content["summary"]["kind"]))
        if not group_kinds:
            raise FacegearError(f"{self.values['case']}: no meshes share a load, there is nothing to draw")
        group_kind = group_kinds[0] if kind is None else require_choice(kind, group_kinds, "kind")
        return sharing_figure(frames["curve"], frames["summary"], group_kind, title)


class HuntingResult(Result):
    """Load sharing of the machine at rest, tooth by tooth, until every pair of teeth has met; statics
    alone.
    """

    STAGE: ClassVar = "hunting"

    def table(self) -> pd.DataFrame:
        """One row a group: least, mean and largest coefficient, and K_gamma.

        K_gamma is the largest mean load of a mesh cycle over the nominal even share; `group_ratio` the
        largest load over the mean of the group's own loads. torque_n_m is the largest torque on a
        pinion, to which all values belong.

        Columns: group, kind, mean, least, largest, k_gamma, group_ratio, undefined_fraction,
        torque_n_m, mesh_cycles, kkt_residual.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["groups"].copy()

    def meshes(self) -> pd.DataFrame:
        """One row a mesh: loads (N), K_gamma, fractions of the time on each flank, open and wedged
        (both flanks).

        even_share_n, torque_n_m: nominal even share. first_open_cycle: first mesh cycle with an open
        mesh, empty without.

        Columns: mesh, group, mean_n, least_n, largest_n, even_share_n, torque_n_m, k_gamma,
        group_ratio, drive_fraction, back_fraction, open_fraction, wedged_fraction, first_open_cycle.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["meshes"].copy()

    def bearings(self) -> pd.DataFrame:
        """One row a body, and one a bearing of each shaft: force on the bearing (N) over the hunting
        cycle.

        A pinion's x is tangential and y along the gears' axis, both radial for its bearing; a face
        gear's axis is z.

        Columns: body, mean_x_n, mean_y_n, mean_z_n, mean_radial_n, largest_radial_n, largest_axial_n.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["bearings"].copy()

    def cycles(self) -> pd.DataFrame:
        """One row a mesh cycle: mean load of each mesh in it, N.

        Columns: cycle, and one of each mesh, such as `input 1/upper`, N.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["cycles"].copy()

    @fit_for_paper
    def plot(self) -> "Figure":
        """Share of each mesh in its group's load over the hunting cycle.

        Returns
        -------
        Figure
            The figure.
        """
        _require_groups(self)
        return hunting_figure(self.content["cycles"], self.content["meshes"])


class SensitivityResult(Result):
    """Change of the load sharing at rest by each error of the machine, one at a time, and by bearing
    stiffness.
    """

    STAGE: ClassVar = "hunting"

    def table(self) -> pd.DataFrame:
        """One row an error and group, largest first: change of K_gamma per um of the error alone, by
        central differences.

        Columns: error, group, per_um.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["sensitivity"].copy()

    def bearing_stiffness(self) -> pd.DataFrame:
        """K_gamma of each kind of group against the bearing stiffness of the pinions of one role
        (`varied`), both kinematics.

        Columns: kinematics, varied, stiffness_n_per_m, kind, k_gamma.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["scan"].copy()

    @fit_for_paper
    def plot(self) -> "Figure":
        """The errors with the largest change of K_gamma per um.

        Returns
        -------
        Figure
            The figure.
        """
        _require_groups(self)
        return sensitivity_figure(self.content["sensitivity"])


class FollowingResult(Result):
    """Load sharing of the running machine while runouts and pitch deviations turn."""

    STAGE: ClassVar = "following"

    def table(self) -> pd.DataFrame:
        """One row a group: K_gamma and K_v of the running machine beside K_gamma at rest.

        k_gamma_static takes the same mesh cycles, k_gamma_static_whole all. `cut`: relative error of
        the former by following a part of the hunting cycle; `sampling`: relative change of K_gamma K_v
        with every second sample alone; lead_cycles: mesh cycles run before; `memory`: difference of
        forces between two starts, over the largest force.

        Columns: group, kind, speed_rpm, mesh_cycles, mean, torque_n_m, k_gamma, k_v, k_gamma_static,
        k_gamma_static_whole, cut, sampling, lead_cycles, memory.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["groups"].copy()

    def meshes(self) -> pd.DataFrame:
        """One row a mesh: loads (N), K_gamma, K_v (largest load over largest mean of a mesh cycle), and
        time on each flank.

        Columns: mesh, group, mean_n, least_n, largest_n, even_share_n, torque_n_m, k_gamma, k_v,
        group_ratio, drive_fraction, back_fraction, open_fraction, wedged_fraction, first_open_cycle.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["meshes"].copy()


def _require_groups(result: Result) -> None:
    """Raise FacegearError where no meshes of the machine share a load, as there is nothing to draw."""
    if result.content["groups"].empty:
        raise FacegearError(f"{result.values['case']}: no meshes share a load, there is nothing to draw")


class SharingMapResult(Result):
    """Map of load sharing over stiffness, errors and torque, with advice on what to change."""

    STAGE: ClassVar = "sharing_map"

    def table(self) -> pd.DataFrame:
        """Return what each change of the machine does to each group, by the statics of the changed machine.

        Returns
        -------
        pd.DataFrame
            Columns group, kind, change, from_to, k_gamma, found, gain, predicted_gain (closed form), worst
            and worst_found (the largest of all groups); the largest gain of each group first.
        """
        return self.content["advice"].copy()

    def points(self) -> pd.DataFrame:
        """Return the machine's place on the map at each of its torques, with percentiles of K_gamma
        over random deviations.

        `number` is k_e sigma / W for idlers and 2 b k / W for inputs, W being load_n.

        Returns
        -------
        pd.DataFrame
            Columns torque_n_m, group, kind, load_n, number, k_gamma_p50, k_gamma_p95, k_gamma_p99.
        """
        return self.content["points"].copy()

    def curves(self) -> pd.DataFrame:
        """Return K_gamma of idlers over `number` = k_e sigma / W: path stiffness, standard deviation,
        load of the group.

        One curve for each way of `floating` face gears; all_carry is the fraction of samples in which
        every path carries, closed_* the closed form.

        Returns
        -------
        pd.DataFrame
            Columns group, floating, number, all_carry, k_gamma_p50, k_gamma_p95, k_gamma_p99,
            closed_p50, closed_p95, closed_p99.
        """
        return self.content["curves"].copy()

    def inputs(self) -> pd.DataFrame:
        """Return K_gamma of inputs over `number` = 2 b k / W: backlash, mesh stiffness, load of the
        input.

        One curve for each factor on the stiffness of their bearings; `closed` is the loop formula.

        Returns
        -------
        pd.DataFrame
            Columns group, bearing_factor, bearing_n_per_m, number, k_gamma, closed.
        """
        return self.content["inputs"].copy()

    def reasons(self) -> list[str]:
        """Return why the closed form of equal paths may not hold for this machine.

        Returns
        -------
        list of str
            One a difference; empty for equal paths.
        """
        return list(self.content["reasons"]["reason"])

    @fit_for_paper
    def plot(self) -> "Figure":
        """Draw K_gamma of idlers and of inputs over the numbers that decide it.

        Returns
        -------
        Figure
            A panel for the idlers, one for the inputs.
        """
        return sharing_map_figure(self.content["curves"], self.content["inputs"], self.content["points"])
