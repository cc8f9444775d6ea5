"""Natural modes."""

from typing import TYPE_CHECKING, ClassVar

import pandas as pd

from facegear.results.base import Result
from facegear.results.paper_figure import fit_for_paper

if TYPE_CHECKING:
    from facegear.plots.description import Figure


class ModesResult(Result):
    """Natural frequencies, classes and shapes with the mean mesh stiffness, and the contacts they keep."""

    STAGE: ClassVar = "modal"

    def table(self) -> pd.DataFrame:
        """One row a mode: order, frequency_hz, what moves (symbols), class.

        Columns: order, frequency_hz, multiplicity, symbols, class, pinion_energy_fraction, decided.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["frequencies"].copy()

    def shapes(self) -> pd.DataFrame:
        """One row a mode, body and degree of freedom.

        Columns: order, body, dof, amplitude_m_or_rad, relative.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["shapes"].copy()

    def contacts(self) -> pd.DataFrame:
        """One row a mesh and a bearing with clearance: state under load, force, stiffness and its kind.

        Columns: contact, state, force_n, stiffness_n_per_m, definition.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["contacts"].copy()

    @fit_for_paper
    def plot(self) -> "Figure":
        """Typical mode shapes, one panel for each kind of mode.

        Returns
        -------
        Figure
            The figure.
        """
        from facegear.plots.modal import mode_shapes

        return mode_shapes(self.content["frequencies"], self.content["shapes"])
