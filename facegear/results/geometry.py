"""Exact geometry of the pair."""

from typing import TYPE_CHECKING, ClassVar

import pandas as pd

from facegear.errors import require_choice
from facegear.results.base import Result
from facegear.results.paper_figure import fit_for_paper

if TYPE_CHECKING:
    from facegear.plots.description import Figure


class GeometryResult(Result):
    """Limits, contact path, backlash and smallest gaps of the unloaded pair."""

    STAGE: ClassVar = "geometry"

    def table(self) -> pd.DataFrame:
        """Columns quantity and value; the unit stands at the end of a quantity's name.

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
    def plot(self, what: str = "pair") -> "Figure":
        """`pair`: both gears in mesh; `sections` of both teeth; `separation` around the contact path.

        Parameters
        ----------
        what : str
            Kind of the figure, one of those above.

        Returns
        -------
        Figure
            The figure.
        """
        from facegear.plots.tooth_pair import separation, tooth_pair, tooth_sections

        record, flanks = self.content["pair"], self.content["flanks"]
        if require_choice(what, ("pair", "sections", "separation"), "plot") == "separation":
            return separation(record, flanks, self.content["contact"])
        return tooth_pair(record, flanks) if what == "pair" else tooth_sections(record, flanks)


def _sections(record: dict) -> list[tuple[str, dict]]:
    inner = [(name, value) for name, value in record.items() if isinstance(value, dict)]
    return [("", record), *inner]
