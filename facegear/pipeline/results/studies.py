"""Results of many machines: studies, tolerances, searched designs."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from inspect import signature
from itertools import combinations as pairs
from itertools import product
from pathlib import Path
from typing import Any, ClassVar

import pandas as pd

from facegear.build.load import plain
from facegear.errors import FacegearError, extras_named, require_choice
from facegear.io.tables import write_workbook
from facegear.pipeline.results.base import Result, fit_for_paper
from facegear.report.figures.comparison import front_figure, hypervolume_figure
from facegear.report.figures.description import Figure
from facegear.report.figures.tolerances import (
    distribution_figure,
    importance_figure,
    load_map_figure,
    scatter_figure,
)
from facegear.report.table import value_in_words
from facegear.schema.studies import common_key

Changes = Mapping[str, Mapping[str, Any]]
"""Changed keys and their values by the label of a machine."""


@dataclass(frozen=True, eq=False)
class Study:
    """Changed copies of a machine by label, and what was changed in each.

    `machines` are gearboxes; `changes` hold the changed config keys with their values, by the same
    labels.

    >>> import facegear
    >>> study = facegear.example().study({"mesh_stiffness.mean_n_per_m": [4e8, 5e8]})
    >>>
    study.table("modes").groupby("mesh_stiffness.mean_n_per_m")["frequency_hz"].max().round(1).to_list()
    [6228.0, 6559.7]
    """

    machines: Mapping[str, Any]
    changes: Changes

    def results(self, answer: str, **arguments: Any) -> dict[str, Result]:
        """Compute one answer, such as `modes` or `sweep`, for each machine.

        Parameters
        ----------
        answer : str
            Name of a method of a gearbox that returns a Result.
        **arguments : Any
            Arguments of the method.

        Returns
        -------
        dict[str, Result]
            Result by label. Raises FacegearError for an answer that does not exist, and what the answer
            raises.
        """
        results = {}
        for label, machine in self.machines.items():
            method = getattr(machine, answer, None) if isinstance(answer, str) else None
            is_method = callable(method) and not answer.startswith("_")
            result = _answer(method, answer, arguments) if is_method else None
            if not isinstance(result, Result):
                raise FacegearError(f"answer = {answer!r}: must be a method of a gearbox that gives a result")
            results[label] = result
        return results

    def table(self, answer: str, **arguments: Any) -> pd.DataFrame:
        """Join the tables (`table()`) of an answer of all machines, with the changed keys as columns in
        front.

        Parameters
        ----------
        answer : str
            Name of a method of a gearbox.
        **arguments : Any
            Arguments of the method.

        Returns
        -------
        pd.DataFrame
            The rows of all machines, in their order.
        """
        parts = []
        for label, result in self.results(answer, **arguments).items():
            part = result.table()  # type: ignore[attr-defined]
            values = {
                key: str(value) if isinstance(value, list | dict) else value
                for key, value in self.changes[label].items()
            }
            parts.append(pd.concat([pd.DataFrame(values, index=part.index), part], axis=1))
        return pd.concat(parts, ignore_index=True)

    def to_excel(self, path: str | Path, answer: str, **arguments: Any) -> Path:
        """Write the table of an answer, with the changed keys in front, as a sheet of a workbook.

        Parameters
        ----------
        path : str or Path
            Workbook to write, which ends in ``.xlsx``.
        answer : str
            Method of a gearbox, such as ``modes``.
        **arguments
            Its arguments.

        Returns
        -------
        Path
            The workbook.

        Raises
        ------
        MissingExtra
            Where openpyxl is not installed.
        """
        with extras_named():
            return write_workbook(path, {answer: self.table(answer, **arguments)})

    @fit_for_paper
    def plot(self, answer: str, plot: Mapping[str, Any] | None = None, **arguments: Any) -> "Figure":
        """Draw all machines in the same axes, for answers whose plot takes others `beside` it.

        Those answers are load_sharing and sweep. The legend names what was changed in words, with units.

        Parameters
        ----------
        answer : str
            Name of a method of a gearbox.
        plot : Mapping[str, Any] | None
            Further arguments of that plot.
        **arguments : Any
            Arguments of the method.

        Returns
        -------
        Figure
            The figure.
        """
        (label, first), *other_results = self.results(answer, **arguments).items()
        if answer not in ("load_sharing", "sweep"):
            raise FacegearError(f"answer = {answer!r}: must be one of load_sharing, sweep")
        results_by_words = {self._words(name): result for name, result in other_results}
        describe = type(first).plot.describe  # type: ignore[attr-defined]
        return describe(first, label=self._words(label), beside=results_by_words, **(plot or {}))

    def _words(self, label: str) -> str:
        """Return the changes of a machine in words with units; its label itself where a user has chosen
        it.
        """
        changes = self.changes[label]
        if label != combined_label(changes):
            return label
        return ", ".join(value_in_words(key, value) for key, value in changes.items())


def combined_label(changes: Mapping[str, Any]) -> str:
    """Return the label of a machine that is named by its changed keys.

    Parameters
    ----------
    changes : mapping
        Changed keys and their values.

    Returns
    -------
    str
        `key = value` for each, joined by commas.
    """
    return ", ".join(f"{key} = {value}" for key, value in changes.items())


def _answer(method: Any, answer: str, arguments: Mapping[str, Any]) -> Any:
    """Call a method of a gearbox, and raise FacegearError in place of TypeError for arguments that it
    does not take.
    """
    try:
        signature(method).bind(**arguments)
    except TypeError as error:
        raise FacegearError(f"{answer}: {error}") from None
    return method(**arguments)


def combinations(values: Mapping[str, Iterable[Any]]) -> dict[str, dict[str, Any]]:
    """Return keys and values in every combination (Cartesian product), by label.

    Parameters
    ----------
    values : Mapping[str, Iterable[Any]]
        Values of each dotted config key; not empty, and no key may hold another.

    Returns
    -------
    dict[str, dict[str, Any]]
        Keys and values by label. Raises FacegearError for a key without values, and for a key that
        holds another.
    """
    if not isinstance(values, Mapping) or not values:
        raise FacegearError(f"study = {values!r}: must be a mapping of config keys to lists of values")
    for key, points in values.items():
        if isinstance(points, str) or not isinstance(points, Iterable):
            raise FacegearError(f"study: {key} = {points!r}: must be a list of values")
    axes = {key: plain(list(points)) for key, points in values.items()}
    for key, points in axes.items():
        if not points:
            raise FacegearError(f"study: {key} = []: must hold at least one value")
    for first, second in pairs(axes, 2):
        if common_key([first], [second]):
            raise FacegearError(f"study: {second}: must not be set beside {first}, as one holds the other")
    combined = [dict(zip(axes, point, strict=True)) for point in product(*axes.values())]
    return {combined_label(point): point for point in combined}


TOLERANCE_KINDS = ("distributions", "importance", "scatter")
"""Names of the figures of tolerances."""


class LoadMapResult(Result):
    """Percentiles, and fractions of machines that open or reverse, over torque and speed."""

    STAGE: ClassVar = "tolerances_map"

    def table(self) -> pd.DataFrame:
        """One row a torque, speed, quantity and percentile: value, and the confidence interval from
        `low` to `high`.

        torque_factor multiplies the torques of the config.

        Columns: torque_factor, speed_rpm, quantity, percentile, value, low, high, samples, failed.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["load_map"].copy()

    def fractions(self) -> pd.DataFrame:
        """One row a torque, speed and event (`what`): fraction of the machines that it meets, with its
        confidence interval.

        Columns: torque_factor, speed_rpm, what, fraction, low, high, samples.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["load_fractions"].copy()

    @fit_for_paper
    def plot(self) -> "Figure":
        """K_gamma of the worst path over torque and speed.

        Returns
        -------
        Figure
            The figure.
        """
        return load_map_figure(self.content["load_map"])


class TolerancesResult(Result):
    """Percentiles of K_gamma and mesh forces, fractions of machines that open or reverse, main causes."""

    STAGE: ClassVar = "tolerances"

    def table(self) -> pd.DataFrame:
        """One row a quantity and percentile: value, and the confidence interval that holds it.

        Columns: quantity, percentile, value, low, high, samples.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["percentiles"].copy()

    def samples(self) -> pd.DataFrame:
        """One row a random sample: drawn values of its causes, computed quantities, and the error text
        where it failed.

        Returns
        -------
        pd.DataFrame
            The table.
        """
        return self.content["samples"].copy()

    def indices(self) -> pd.DataFrame:
        """First-order and total Sobol index of every quantity and cause, with confidence intervals.

        Columns: quantity, cause, first, first_low, first_high, total, total_low, total_high, blocks,
        blocks_failed.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["indices"].copy()

    @fit_for_paper
    def plot(self, kind: str = "distributions") -> "Figure":
        """Draw distributions, importance or scatter.

        Parameters
        ----------
        kind : str
            `distributions`, `importance` or `scatter`.

        Returns
        -------
        Figure
            The figure.
        """
        content = self.content
        if require_choice(kind, TOLERANCE_KINDS, "kind") == "distributions":
            return distribution_figure(content["samples"], content["percentiles"])
        if kind == "importance":
            return importance_figure(content["percentiles"], content["importance"], content["indices"])
        parts = (content[name] for name in ("samples", "percentiles", "importance", "indices"))
        return scatter_figure(*parts)


SEARCH_KINDS = ("front", "hypervolume")
"""Names of the figures of a search."""


class SearchResult(Result):
    """Front of a design search, the winners beside the nominal design, and the spread over seeds."""

    STAGE: ClassVar = "search"

    def table(self) -> pd.DataFrame:
        """One row a design of the Pareto front: values of the variables, objectives and limited
        quantities.

        Returns
        -------
        pd.DataFrame
            The table.
        """
        return self.content["front"].copy()

    def winners(self) -> pd.DataFrame:
        """The nominal design and the winners of the front at full accuracy; `<goal>_searched` is what
        the search had found.

        Returns
        -------
        pd.DataFrame
            The table.
        """
        return self.content["winners"].copy()

    def designs(self) -> pd.DataFrame:
        """Every design tried, with its generation and seed, and the error where it cannot be built.

        Returns
        -------
        pd.DataFrame
            The table.
        """
        return self.content["designs"].copy()

    def hypervolume(self) -> pd.DataFrame:
        """Share of the box around all fronts that the designs of each seed dominate, up to each
        generation.

        Columns: seed, generation, hypervolume.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["hypervolume"].copy()

    @fit_for_paper
    def plot(self, kind: str = "front") -> "Figure":
        """Draw the front or the hypervolume.

        Parameters
        ----------
        kind : str
            `front` or `hypervolume`.

        Returns
        -------
        Figure
            The figure.
        """
        content = self.content
        if require_choice(kind, SEARCH_KINDS, "kind") == "hypervolume":
            return hypervolume_figure(content["hypervolume"])
        objectives = [objective["name"] for objective in self.values["search"]["objectives"]]
        return front_figure(content["designs"], content["front"], content["winners"], objectives)
