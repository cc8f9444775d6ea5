"""Results of the tooth pair: geometry, topography, single teeth."""

from typing import ClassVar

import pandas as pd

from facegear.errors import require_choice
from facegear.pipeline.results.base import Result, fit_for_paper
from facegear.report.figures.description import Figure
from facegear.report.figures.teeth import (
    separation,
    tooth_error_figure,
    tooth_pair,
    tooth_sections,
    topography_figure,
)


class GeometryResult(Result):
    """Limits, contact path, backlash and smallest gaps of the unloaded pair."""

    STAGE: ClassVar = "geometry"

    def table(self) -> pd.DataFrame:
        """All numbers and texts of the geometry's record: columns quantity and value; the unit ends a
        quantity's name.

        A quantity inside a section of the record is section.name.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        rows = [
            (f"{section}.{name}" if section else name, value)
            for section, content in _sections(self.content["pair"])
            for name, value in content.items()
            if isinstance(value, int | float | str)
        ]
        return pd.DataFrame(rows, columns=["quantity", "value"])

    def _sheets(self) -> dict[str, pd.DataFrame]:
        """Return the table of all quantities: the stage writes a record and arrays, but no table."""
        return {"geometry": self.table()}

    @fit_for_paper
    def plot(self, figure: str = "pair") -> "Figure":
        """`pair`: both gears in mesh; `sections` of both teeth; `separation` around the contact path.

        Parameters
        ----------
        figure : str
            Kind of the figure, one of those above.

        Returns
        -------
        Figure
            The figure.
        """
        record, flanks = self.content["pair"], self.content["flanks"]
        if require_choice(figure, ("pair", "sections", "separation"), "plot") == "separation":
            return separation(record, flanks, self.content["contact"])
        return tooth_pair(record, flanks) if figure == "pair" else tooth_sections(record, flanks)


def _sections(record: dict) -> list[tuple[str, dict]]:
    """Return a record under the empty name, and each mapping inside it under its own name."""
    inner = [(name, value) for name, value in record.items() if isinstance(value, dict)]
    return [("", record), *inner]


class TopographyResult(Result):
    """Nominal points and normals of all flanks, with the mean deviation of all teeth."""

    STAGE: ClassVar = "topography"

    def table(self) -> pd.DataFrame:
        """One row a place: face_mm and profile_mm, deviation (um), nominal point (mm) and normal.

        Columns: body, tooth, flank, face_mm, profile_mm, deviation_um, x_mm, y_mm, z_mm, nx, ny, nz.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["points"].copy()

    @fit_for_paper
    def plot(self, body: str = "face_gear") -> "Figure":
        """Draw the chart of both flanks of a body.

        Parameters
        ----------
        body : str
            `pinion` or `face_gear`.

        Returns
        -------
        Figure
            The figure.
        """
        return topography_figure(
            self.content["points"], require_choice(body, ("pinion", "face_gear"), "plot")
        )


class ToothErrorsResult(Result):
    """Contribution of teeth that deviate from the others of their gear to the transmission error, with
    and without load.
    """

    STAGE: ClassVar = "tooth_errors"

    def table(self) -> pd.DataFrame:
        """One row a body and order of its turn: amplitude (um) of the drive flank's transmission error,
        with and without load.

        Columns, among others: order, unloaded_um, loaded_um.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["orders"].copy()

    @fit_for_paper
    def plot(self) -> "Figure":
        """Draw what the teeth of either gear add under load, over one of its turns.

        Returns
        -------
        Figure
            The figure.
        """
        return tooth_error_figure(self.content["curves"], self.content["orders"])
