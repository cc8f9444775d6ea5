"""Answers about many machines: studies, tolerances, maps of loads, searched designs."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from facegear.door.case import Case, drop_none
from facegear.errors import require_choice
from facegear.pipeline.results.studies import (
    LoadMapResult,
    SearchResult,
    Study,
    TolerancesResult,
    combinations,
)
from facegear.studies.statistics import Loosest, loosest


def study(self: Case, values: Mapping[str, Iterable[Any]]) -> "Study":
    """Make a changed copy of the machine for every combination of values of some keys.

    Parameters
    ----------
    values : Mapping[str, Iterable[Any]]
        Values of each dotted config key; not empty.

    Returns
    -------
    Study
        The changed machines by label, `key = value, ...`; nothing is computed yet. Raises ConfigErrors
        with one line for every value that the config would refuse.

    Examples
    --------
    >>> import facegear
    >>> study = facegear.example().study({"transmission.backlash_um": [80, 120]})
    >>> list(study.machines)
    ['transmission.backlash_um = 80', 'transmission.backlash_um = 120']
    """
    changes = combinations(values)
    return Study(
        {label: self._with_changes(label, changed_values) for label, changed_values in changes.items()},
        changes,
    )


def tolerances(self: Case, samples: int | None = None) -> "TolerancesResult":
    """Draw machines from the tolerances of the config, and compute percentiles, fractions and Sobol
    indices, in one process.

    Parameters
    ----------
    samples : int or None
        Number of random machines, then without Sobol indices; None for that of the config, with them.

    Returns
    -------
    TolerancesResult
        The results. Raises ConfigError without a section `tolerances`.
    """
    self._require_section("tolerances")
    changes = {} if samples is None else {"samples": samples, "chunk_samples": samples, "index_blocks": 0}
    changed_values = {f"tolerances.{key}": value for key, value in changes.items()}
    return self._with_changes("tolerances", changed_values)._chain.result(TolerancesResult)


def load_map(
    self: Case,
    torque_factors: Sequence[float] | None = None,
    speeds_rpm: Sequence[float] | None = None,
    samples: int | None = None,
) -> "LoadMapResult":
    """Compute percentiles of the machine with its tolerances over torque and speed, with the same
    random machines at every load.

    Arguments that are None are as in section `tolerances.load_map`, or its default.

    Parameters
    ----------
    torque_factors : Sequence[float] | None
        Factors by which all torques of the config are multiplied.
    speeds_rpm : Sequence[float] | None
        Speeds of the pinions, rpm; for a dynamic model only.
    samples : int or None
        Number of random machines.

    Returns
    -------
    LoadMapResult
        The percentiles. Raises ConfigError without a section `tolerances`.
    """
    tolerances = self._require_section("tolerances")
    load_map_values = {"torque_factors": torque_factors, "speeds_rpm": speeds_rpm, "samples": samples}
    section = {**(tolerances["load_map"] or {}), **drop_none(load_map_values)}
    return self._with_changes("load_map", {"tolerances.load_map": section})._chain.result(LoadMapResult)


def loosest_tolerances(
    self: Case,
    quantity: str,
    at_most: float,
    percentile: float = 99.0,
    causes: Sequence[str] | None = None,
    samples: int = 512,
    max_factor: float = 4.0,
) -> "Loosest":
    """Compute the factor by which deviations may grow until a percentile of a quantity exceeds a limit.

    Factors up to `max_factor` are tried with the same number of random machines each, twelve times
    `samples` in all.

    Parameters
    ----------
    quantity : str
        Column of `tolerances().samples()`, such as a K_gamma.
    at_most : float
        Limit, in the unit of the quantity.
    percentile : float
        Percentile, %.
    causes : Sequence[str] | None
        Names of the causes whose deviations grow; None for all.
    samples : int
        Number of random machines for each factor.
    max_factor : float
        Largest factor tried.

    Returns
    -------
    Loosest
        The factor (`scale`) with its interval, and all trials. Raises ConfigError without a section
        `tolerances`, FacegearError for names that do not exist, or a limit exceeded without any
        deviation.
    """
    cause_sections = self._require_section("tolerances")["causes"]
    names = [cause["name"] for cause in cause_sections]
    scaled_names = [require_choice(name, names, "causes") for name in (names if causes is None else causes)]

    def sample_quantity(scale: float) -> Any:
        """Return the quantity of all samples (n,) where the deviations of the chosen causes are
        multiplied by `scale`.
        """
        scaled_causes = [
            {**cause, "moves": {key: gain * scale for key, gain in cause["moves"].items()}}
            if cause["name"] in scaled_names
            else cause
            for cause in cause_sections
        ]
        frame = tolerances(
            self._with_changes("tolerances", {"tolerances.causes": scaled_causes}), samples
        ).samples()
        return frame[require_choice(quantity, list(frame.columns), "quantity")].to_numpy(float)

    return loosest(sample_quantity, at_most, percentile / 100.0, max_factor)


def search(self: Case, generations: int | None = None, seeds: Sequence[int] | None = None) -> "SearchResult":
    """Search the Pareto front of designs for section `search` of the config, by NSGA-II in one process.

    Parameters
    ----------
    generations : int or None
        Number of generations; None for that of the config.
    seeds : Sequence[int] | None
        Seeds of the random numbers, one for each island; None for those of the config.

    Returns
    -------
    SearchResult
        All designs, the front and its winners. Raises ConfigError without a section `search`, and
        FacegearError naming the extra where pymoo is not installed.
    """
    self._require_section("search")
    changes = drop_none({"search.generations": generations, "search.seeds": seeds})
    return self._with_changes("search", changes)._chain.result(SearchResult)
