"""Map of load sharing, the machine's place on it, and what changes of the machine would buy."""

from typing import TYPE_CHECKING, ClassVar

import pandas as pd

from facegear.results.base import Result
from facegear.results.paper_figure import fit_for_paper

if TYPE_CHECKING:
    from facegear.plots.description import Figure


class SharingMapResult(Result):
    """How load sharing follows from stiffness, errors and torque, and what to change."""

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
        """Return the machine's place on the map at each of its torques.

        Returns
        -------
        pd.DataFrame
            Columns torque_n_m, group, kind, load_n, number, k_gamma_p50, k_gamma_p95, k_gamma_p99.
        """
        return self.content["points"].copy()

    def curves(self) -> pd.DataFrame:
        """Return K_gamma of idlers over k_e sigma / W, beside the closed form.

        Returns
        -------
        pd.DataFrame
            Columns group, floating, number, all_carry, k_gamma_p50, k_gamma_p95, k_gamma_p99, closed_p50,
            closed_p95, closed_p99.
        """
        return self.content["curves"].copy()

    def inputs(self) -> pd.DataFrame:
        """Return K_gamma of inputs over 2 b k / W, beside the loop formula.

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
        from facegear.plots.sharing_map import sharing_map_figure

        return sharing_map_figure(self.content["curves"], self.content["inputs"], self.content["points"])
