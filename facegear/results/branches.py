"""Branches of periodic motions."""

from typing import TYPE_CHECKING, ClassVar

import pandas as pd

from facegear.errors import require_choice
from facegear.results.base import Result
from facegear.results.paper_figure import fit_for_paper

if TYPE_CHECKING:
    from facegear.plots.description import Figure

FIGURES = ("amplitudes", "fractions", "multipliers")


class BranchesResult(Result):
    """Periodic motions found over speed, stable or not, and the points where motions end or change.

    Mirror images of motions that break a symmetry of the machine are branches of their own, see images().
    """

    STAGE: ClassVar = "branches"
    BESIDE: ClassVar = {"sweep": ("dynamics_sweep", "sweep")}

    def table(self) -> pd.DataFrame:
        """One row a branch, point and mesh: speed, stable or not, deflections, peak force, contact.

        Columns, among others: branch, point, arc, speed_rpm, period, stable, mesh, deflection_ac_rms_um,
        deflection_rms_um, deflection_minimum_um, deflection_maximum_um, peak_force_n, open_fraction,
        drive_fraction, back_fraction.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["branches"].copy()

    def images(self) -> pd.DataFrame:
        """Return branch and image_of: the branches that are mirror images, and the followed ones they map.

        Columns, among others: branch, period, points, image_of, tried.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        ends = self.content["ends"]
        rows = ends[ends["image_of"].astype(str) != ""]
        return rows[["branch", "image_of"]].astype(int).reset_index(drop=True)

    def special_points(self) -> pd.DataFrame:
        """One row a fold, period doubling, Neimark-Sacker point, branch point or graze, with its proof.

        Columns, among others: branch, period, kind, speed_rpm, arc, meshes, edge, proof.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["special"].copy()

    def margins(self) -> pd.DataFrame:
        """How far each stable motion at the nominal speed is from its end, in speed and in torque.

        Columns, among others: branch, parameter, margin.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["margins"].copy()

    def ranges(self) -> pd.DataFrame:
        """Speeds between which several stable motions exist.

        Columns, among others: from_rpm, to_rpm, branches.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["ranges"].copy()

    def coexistence(self) -> pd.DataFrame:
        """Fraction of random starts that ends on each motion, with its standard error.

        Columns, among others: speed_rpm, fraction, error, branch, motion.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["coexistence"].copy()

    def jumps(self) -> pd.DataFrame:
        """Each jump of the sweep with the special point that its motion runs into, or why there is none.

        Columns, among others: direction, speed_before_rpm, speed_after_rpm, class_before, branch, kind, note.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["jumps"].copy()

    def swept(self) -> pd.DataFrame:
        """Each periodic motion of the sweep with the branch it lies on, or why it lies on none.

        Columns, among others: direction, period, branch, note.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["swept"].copy()

    @fit_for_paper
    def plot(self, what: str = "amplitudes", branch: int = 0) -> "Figure":
        """Draw `amplitudes` over speed, `fractions` of random starts, or the `multipliers` of one branch.

        Parameters
        ----------
        what : str
            Kind of the figure, one of those above.
        branch : int
            Number of the branch, for `multipliers`.

        Returns
        -------
        Figure
            The figure.
        """
        from facegear.plots.branches import amplitudes, fractions, multipliers, typical_meshes

        require_choice(what, FIGURES, "plot")
        if what == "fractions":
            return fractions(self.content["coexistence"])
        if what == "multipliers":
            return multipliers(self.content["multipliers"], branch)
        meshes = typical_meshes(self.values["transmission"]["pinions"], self.content["branches"]["mesh"])
        speed = self.values["dynamics"]["speed_rpm"]
        return amplitudes(
            self.content["branches"], self.content["special"], self.content["sweep"], meshes, speed
        )
