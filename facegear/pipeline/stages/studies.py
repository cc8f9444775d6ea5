"""Stages of tolerances: chunks of samples, what they say, maps of loads."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from facegear.build.machine import with_torques
from facegear.number_format import count_noun
from facegear.pipeline.outcome import Outcome
from facegear.quantities import (
    BETTER_LARGE,
    CONTACT_TEMPERATURE,
    CYCLE_SELECTION_ERRORS,
    LOSS,
    OPEN_FRACTION,
    PAST_LAW,
    REVERSED_FRACTION,
    SIMPLIFICATION_ERRORS,
    UNSOLVED,
)
from facegear.schema.tolerances import Design, LoadMap, Tolerances
from facegear.studies.sampled_machine import CHECKED_SAMPLES, SampledMachine
from facegear.studies.sampling import index_samples, samples
from facegear.studies.summary import (
    ERROR,
    fraction_table,
    importance_table,
    index_table,
    percentile_table,
    sampling_table,
)


def tolerances_chunk(
    design: Design,
    first: int,
    last: int,
    partial: str | Path | None = None,
    code: str = "",
    **machine_fields: Any,
) -> Outcome:
    """Compute samples `first` to `last` of a machine with its tolerances: draw its errors and judge
    each machine.

    A sample is one machine whose causes (errors with a distribution) have drawn values. One that cannot
    be built or computed is a row with its error. The first CHECKED_SAMPLES random samples are computed
    a second time without simplifications: columns CYCLE_SELECTION_ERRORS hold the errors by mesh cycles
    left out, SIMPLIFICATION_ERRORS those by few contact points of friction. They are empty in other
    rows.

    Parameters
    ----------
    design : Design
        `samples` for random ones, or `indices` for those of Saltelli's design, from which Sobol indices
        follow.
    first : int
        Number of the first sample.
    last : int
        Number of the last sample, which is computed as well.
    partial : str or Path or None
        File that keeps finished rows, so that a killed run resumes after its last one; None keeps none.
    code : str
        Fingerprint of the code; rows in `partial` count only for the same config and code.
    **machine_fields : Any
        Fields of SampledMachine, as plain config values and arrays.

    Returns
    -------
    Outcome
        Table `chunk`, a row a sample: sample, values of the causes, computed quantities, error (empty
        text if there is none).
    """
    return chunk_of(SampledMachine.of_stage(**machine_fields), design, first, last, partial, code)


def chunk_of(
    machine: SampledMachine,
    design: Design,
    first: int,
    last: int,
    partial: str | Path | None = None,
    code: str = "",
) -> Outcome:
    """Compute the samples of `tolerances_chunk` for a SampledMachine that is there already.

    Parameters
    ----------
    machine : SampledMachine
        Machine with its tolerances.
    design : Design
        `samples` for random ones, or `indices` for those from which Sobol indices follow.
    first : int
        Number of the first sample.
    last : int
        Number of the last sample, which is computed as well.
    partial : str or Path or None
        File that keeps finished rows, so that a killed run resumes after its last one; None keeps none.
    code : str
        Fingerprint of the code; rows in `partial` count only for the same config and code.

    Returns
    -------
    Outcome
        Table `chunk`, a row a sample: sample, values of the causes, computed quantities, error (empty
        text if there is none).
    """
    draw = samples if design == "samples" else index_samples
    values = draw(machine.causes, first, last - first + 1)

    def evaluate(number: int) -> dict[str, float]:
        """Return the quantities of the sample with this number, by name."""
        return machine.judge_sample(
            machine.sample(values[number - first]), design == "samples" and number < CHECKED_SAMPLES
        )

    label = f"{design} {first} to {last}"
    frame = machine.run(evaluate, range(first, last + 1), label, partial, design, code)
    for column, name in enumerate(machine.causes.names):
        frame.insert(1 + column, name, values[:, column])
    failure_count = int((frame["error"] != "").sum())
    return Outcome(
        {"chunk": frame},
        f"{count_noun(len(frame), 'sample')}, {failure_count} of them cannot be built or computed",
    )


EVENTS = {
    OPEN_FRACTION: "some mesh that shares a load opens",
    REVERSED_FRACTION: "some mesh is loaded on the flank that it does not work on",
    PAST_LAW: "some mesh is past the last level of its load-dependent law",
    UNSOLVED: "some mesh loses under a torque outside those of the contact analysis",
}
"""Events whose fraction of samples is listed, in words."""
CHECKS = {
    **CYCLE_SELECTION_ERRORS,
    **{f"{name}, of few places of the contact": column for name, column in SIMPLIFICATION_ERRORS.items()},
}
"""Quantity -> column that holds, for some samples, what their value misses."""


def tolerances(
    samples: Sequence[pd.DataFrame], indices: Sequence[pd.DataFrame], tolerances: Tolerances
) -> Outcome:
    """Compute percentiles, fractions of bad machines, and the importance of causes, from all chunks of
    samples.

    `sampling` tells what the mesh cycles taken from the hunting cycle miss, in the samples that were
    computed over the whole of it, and what friction misses that is taken at few points of the contact.

    Parameters
    ----------
    samples : Sequence[pd.DataFrame]
        Tables `chunk` of the random samples.
    indices : Sequence[pd.DataFrame]
        Tables `chunk` of the samples for Sobol indices, empty if there are none.
    tolerances : Tolerances
        Section `tolerances` of the config.

    Returns
    -------
    Outcome
        Tables `samples` (all random ones), `percentiles`, `fractions` (of machines with one of EVENTS),
        `importance` (rank correlation with each cause), `indices` (Sobol) and `sampling` (what
        simplifications miss, from the samples that were checked). `TolerancesResult` lists the columns
        of most.
    """
    causes = [cause.name for cause in tolerances.causes]
    every = pd.concat(samples, ignore_index=True)
    values = every.drop(columns=list(CHECKS.values()), errors="ignore")
    index_samples = pd.concat(indices, ignore_index=True) if indices else every.iloc[:0]
    design = index_samples.drop(columns=list(CHECKS.values()), errors="ignore")
    percentiles = percentile_table(values, causes, tolerances.confidence, BETTER_LARGE)
    fractions = fraction_table(every, EVENTS, tolerances.confidence)
    top = percentiles[(percentiles["percentile"] == 99.0) & percentiles["quantity"].str.startswith("k_gamma")]
    worst = top.nlargest(1, "value")
    summary = ", ".join(
        f"99 of 100 stay below {row.quantity} = {row.value:.3f}" for row in worst.itertuples()
    )
    sampling = sampling_table(every, CHECKS)
    summary = "; ".join(
        [summary or "no path shares a load", *_hot_in_words(percentiles), *_missed_in_words(sampling)]
    )
    failure_count = int((every[ERROR] != "").sum())
    if failure_count == len(every):
        summary = f"the first by: {every[ERROR].iloc[0]}"
    return Outcome(
        {
            "samples": every,
            "percentiles": percentiles,
            "fractions": fractions,
            "importance": importance_table(values, causes),
            "indices": index_table(design, causes, tolerances.confidence),
            "sampling": sampling,
        },
        f"{count_noun(len(every), 'sample')}, {failure_count} failed; {summary}",
    )


def _hot_in_words(percentiles: pd.DataFrame) -> list[str]:
    """Return, in a list of one text, loss (W) and contact temperature (C) that 1 % of the samples
    exceed; empty without friction.
    """
    rows = percentiles[percentiles["percentile"] == 99.0].set_index("quantity")["value"]
    if CONTACT_TEMPERATURE not in rows:
        return []
    return [f"{rows[LOSS]:.0f} W of friction and a contact temperature of {rows[CONTACT_TEMPERATURE]:.0f} C"]


def _missed_in_words(sampling: pd.DataFrame) -> list[str]:
    """Return, as a list of texts, the largest errors by mesh cycles left out and by few contact points
    of friction.
    """
    parts = [f"{row.quantity} {row.largest_missed:.1e}" for row in sampling.itertuples()]
    max_samples = sampling["samples"].max()
    cycles = [part for part in parts if part.partition(" ")[0] in CYCLE_SELECTION_ERRORS]
    misses_by_place = sampling.loc[~sampling["quantity"].isin(list(CYCLE_SELECTION_ERRORS)), "largest_missed"]
    cycle_texts = (
        [f"the mesh cycles taken miss at most {', '.join(cycles)} ({count_noun(max_samples, 'sample')})"]
        if cycles
        else []
    )
    return cycle_texts + (
        [f"the places that friction is taken at miss at most {misses_by_place.max():.1e}"]
        if len(misses_by_place)
        else []
    )


COLUMNS = (
    *("torque_factor", "speed_rpm", "quantity", "percentile"),
    *("value", "low", "high", "samples", "failed"),
)
"""Columns of the map of percentiles over torque and speed."""


def tolerances_map(partial: str | Path | None = None, code: str = "", **machine_fields: Any) -> Outcome:
    """Compute percentiles of every quantity at every torque and speed of section `tolerances.load_map`.

    The same machines are used at every load, so that differences between loads are no accident of the
    samples. The mesh stiffness stays that of mesh_stiffness.torque_n_m.

    Parameters
    ----------
    partial : str or Path or None
        File that keeps finished rows, so that a killed run resumes after its last one; None keeps none.
    code : str
        Fingerprint of the code; rows in `partial` count only for the same config and code.
    **machine_fields : Any
        Fields of SampledMachine, as plain config values and arrays.

    Returns
    -------
    Outcome
        Table `load_map`: percentiles at every load, with COLUMNS; torque_factor multiplies the torques
        of the config. Table `load_fractions`: fraction of the machines that fail, open or change their
        flank there. Table `load_sampling`: what the mesh cycles taken miss there, from CHECKED_SAMPLES
        samples at all loads together or one at each.
    """
    machine = SampledMachine.of_stage(**machine_fields)
    section = machine.section
    load_map = section.load_map or LoadMap()
    values, loads = samples(machine.causes, 0, load_map.samples), load_map.loads(machine.speed_rpm)
    count, checks_per_load = load_map.samples * len(loads), max(CHECKED_SAMPLES // len(loads), 1)

    def at_load(values: Mapping[str, Any], factor: float, speed: float) -> dict[str, Any]:
        """Return config values with all torques times `factor`, and the speed (rpm) plus what a cause
        adds to the nominal one.
        """
        off = values["dynamics"]["speed_rpm"] - machine.speed_rpm  # what a cause adds to it
        transmission = with_torques(values["transmission"], factor)
        return {**values, "transmission": transmission, "dynamics": {"speed_rpm": speed + off}}

    judges = [machine.judge_near(at_load(machine.start, *load)) for load in loads]

    def evaluate(number: int) -> dict[str, float]:
        """Return the quantities of one machine at one load; `number` counts all machines at the first
        load, then at the next.
        """
        load, row = divmod(number, load_map.samples)
        sample = at_load(machine.sample(values[row]), *loads[load])
        return machine.judge_sample(sample, row < checks_per_load, judges[load])

    frame = machine.run(evaluate, range(count), "tolerances over torque and speed", partial, code)
    tables: list[pd.DataFrame] = []
    fractions: list[pd.DataFrame] = []
    sampling: list[pd.DataFrame] = []
    for index, (factor, speed) in enumerate(loads):
        results_at_load = frame.iloc[index * load_map.samples : (index + 1) * load_map.samples]
        load = {"torque_factor": factor, "speed_rpm": speed}
        results = results_at_load.drop(columns=list(machine.checks))
        percentiles = percentile_table(results, (), section.confidence, BETTER_LARGE)
        failure_count = int((results_at_load[ERROR] != "").sum())
        tables.append(percentiles.assign(**load, failed=failure_count))
        fractions.append(_at_load(load, fraction_table(results_at_load, EVENTS, section.confidence)))
        sampling.append(_at_load(load, sampling_table(results_at_load, CHECKS)))
    table = pd.concat(tables, ignore_index=True)[list(COLUMNS)]
    failure_count = int((frame[ERROR] != "").sum())
    return Outcome(
        {
            "load_map": table,
            "load_fractions": pd.concat(fractions, ignore_index=True),
            "load_sampling": pd.concat(sampling, ignore_index=True),
        },
        f"{count_noun(len(loads), 'load')} of {count_noun(load_map.samples, 'sample')} each, "
        f"{count_noun(failure_count, 'machine')} failed",
    )


def _at_load(load: dict[str, float], table: pd.DataFrame) -> pd.DataFrame:
    """Return a table with torque_factor and speed_rpm of its load as first columns."""
    return table.assign(**load)[[*load, *table.columns]]
