"""Load sharing at rest over the hunting cycle, and of the running machine while its runouts turn."""

from typing import TYPE_CHECKING, ClassVar

import pandas as pd

from facegear.errors import FacegearError
from facegear.results.base import Result
from facegear.results.paper_figure import fit_for_paper

if TYPE_CHECKING:
    from facegear.plots.description import Figure


class HuntingResult(Result):
    """How the machine at rest shares its load, tooth by tooth, until every pair of teeth has met."""

    STAGE: ClassVar = "hunting"

    def table(self) -> pd.DataFrame:
        """One row a group: loads of its meshes and K_gamma, the largest over the nominal even share.

        Columns: group, kind, mean, least, largest, k_gamma, group_ratio, undefined_fraction, torque_n_m,
        mesh_cycles, kkt_residual.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["groups"].copy()

    def meshes(self) -> pd.DataFrame:
        """One row a mesh: loads (N), K_gamma, fractions of the cycle on each flank, open and wedged.

        Columns: mesh, group, mean_n, least_n, largest_n, even_share_n, torque_n_m, k_gamma, group_ratio,
        drive_fraction, back_fraction, open_fraction, wedged_fraction, first_open_cycle.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["meshes"].copy()

    def bearings(self) -> pd.DataFrame:
        """One row a body: force on its bearing (N).

        Columns: body, mean_x_n, mean_y_n, mean_z_n, mean_radial_n, largest_radial_n, largest_axial_n.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["bearings"].copy()

    def cycles(self) -> pd.DataFrame:
        """One row a mesh cycle: share of each mesh in its group's load.

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
        from facegear.plots.hunting import hunting_figure

        _require_groups(self)
        return hunting_figure(self.content["cycles"], self.content["meshes"])


class SensitivityResult(Result):
    """By how much each error, one at a time, changes the load sharing at rest."""

    STAGE: ClassVar = "hunting"

    def table(self) -> pd.DataFrame:
        """One row an error and group, largest first: change of K_gamma per um.

        Columns: error, group, per_um.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["sensitivity"].copy()

    def bearing_stiffness(self) -> pd.DataFrame:
        """K_gamma against the bearing stiffness of the pinions of each role.

        Columns: kinematics, varied, stiffness_n_per_m, kind, k_gamma.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["scan"].copy()

    @fit_for_paper
    def plot(self) -> "Figure":
        """The errors that matter most.

        Returns
        -------
        Figure
            The figure.
        """
        from facegear.plots.hunting import sensitivity_figure

        _require_groups(self)
        return sensitivity_figure(self.content["sensitivity"])


class FollowingResult(Result):
    """How the running machine shares its load while runouts and pitch deviations turn."""

    STAGE: ClassVar = "following"

    def table(self) -> pd.DataFrame:
        """One row a group: K_gamma and K_v of the running machine beside K_gamma at rest.

        Columns: group, kind, speed_rpm, mesh_cycles, mean, torque_n_m, k_gamma, k_v, k_gamma_static,
        k_gamma_static_whole, cut, sampling, lead_cycles, memory.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["groups"].copy()

    def meshes(self) -> pd.DataFrame:
        """One row a mesh: loads (N), K_gamma and K_v.

        Columns: mesh, group, mean_n, least_n, largest_n, even_share_n, torque_n_m, k_gamma, k_v, group_ratio,
        drive_fraction, back_fraction, open_fraction, wedged_fraction, first_open_cycle.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["meshes"].copy()


def _require_groups(result: Result) -> None:
    """Refuse to draw where no meshes share a load. Raises FacegearError."""
    if result.content["groups"].empty:
        raise FacegearError(f"{result.values['case']}: no meshes share a load, there is nothing to draw")
