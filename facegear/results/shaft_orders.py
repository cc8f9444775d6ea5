"""Vibration of the machine at the orders of its gears' turns."""

from typing import TYPE_CHECKING, ClassVar

import pandas as pd

from facegear.errors import FacegearError
from facegear.results.base import Result
from facegear.results.paper_figure import fit_for_paper

if TYPE_CHECKING:
    from facegear.plots.description import Figure


class ShaftOrdersResult(Result):
    """Vibration at the orders of turns, by runouts, pitch deviations and single teeth, linearised."""

    STAGE: ClassVar = "shaft_orders"

    def table(self) -> pd.DataFrame:
        """One row an order of a gear's turns and mesh: frequency, error, force running and turned slowly.

        Columns: turning, order, of_mesh, frequency_hz, mesh, error_um, force_n, force_at_rest_n.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["orders"].copy()

    def over_speed(self) -> pd.DataFrame:
        """One row a speed and one of the largest orders: the mesh with the largest force.

        Columns: speed_rpm, turning, order, of_mesh, frequency_hz, mesh, force_n.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["over_speed"].copy()

    def excited(self) -> pd.DataFrame:
        """Return what each periodic torque of `transmission.excitations` does, linearised.

        Returns
        -------
        pd.DataFrame
            One row a speed (the nominal one first), torque and part: amplitude of the force of a mesh (N) or
            of the torque of the spring before a turning mass (N m). Columns: speed_rpm, body, order, of_mesh,
            frequency_hz, part, force_n, torque_n_m.
        """
        return self.content["excited"].copy()

    @fit_for_paper
    def plot(self) -> "Figure":
        """Forces at all orders at the nominal speed, and the largest orders over speed.

        Raises FacegearError for a machine without anything that turns with its gears.

        Returns
        -------
        Figure
            The figure.
        """
        from facegear.plots.shaft_orders import shaft_order_figure

        if self.content["orders"].empty:
            message = "no runout, pitch deviation or single tooth is given, there is nothing to draw"
            raise FacegearError(f"{self.values['case']}: {message}")
        return shaft_order_figure(self.content["orders"], self.content["over_speed"])
