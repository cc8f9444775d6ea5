"""Load sharing at one speed."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, ClassVar

import pandas as pd

from facegear.errors import FacegearError, require_choice
from facegear.results.base import Result, require_answers
from facegear.results.paper_figure import fit_for_paper

if TYPE_CHECKING:
    from facegear.plots.description import Figure

STUDY = "compared"


class LoadSharingResult(Result):
    """Load-sharing coefficients of every group of meshes that share a load."""

    STAGE: ClassVar = "load_sharing"

    def table(self) -> pd.DataFrame:
        """One row a group: mean and its half_width, extremes, lost contact, class of motion.

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
        """Coefficient of every group over one mesh cycle, with the envelope over all cycles.

        Columns: group, kind, cycle_fraction, time_s, coefficient, envelope_low, envelope_high, lost_fraction.

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
        from facegear.load_sharing.collect import collect_tables
        from facegear.plots.load_sharing import sharing_figure

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
