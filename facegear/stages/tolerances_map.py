"""Percentiles of a machine with its tolerances over torque and speed."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pandas as pd

from facegear.config.loads import with_torques
from facegear.config.tolerances import LoadMap
from facegear.load_sharing.quantity_names import BETTER_LARGE
from facegear.number_format import count_noun
from facegear.scenarios.chunks import ERROR
from facegear.scenarios.sampling import samples
from facegear.scenarios.summary import fraction_table, percentile_table, sampling_table
from facegear.stages.outcome import Outcome
from facegear.stages.tolerances import CHECKS, EVENTS
from facegear.variants.sampled_machine import CHECKED_SAMPLES, SampledMachine

COLUMNS = (
    *("torque_factor", "speed_rpm", "quantity", "percentile"),
    *("value", "low", "high", "samples", "failed"),
)


def tolerances_map(partial: str | Path | None = None, code: str = "", **machine_fields: Any) -> Outcome:
    """Compute percentiles of every quantity at every torque and speed of a load map.

    The same machines are used at every load, so that differences between loads are no accident of the
    samples. The mesh stiffness stays that of mesh_stiffness.torque_n_m.

    Parameters
    ----------
    partial : str or Path or None
        File that keeps finished rows, so that a killed run resumes after its last one; None keeps none.
    code : str
        Identity of the code; rows in `partial` count only for the same config and code.
    **machine_fields : Any
        Fields of SampledMachine.

    Returns
    -------
    Outcome
        Table `load_map`: percentiles at every load, with COLUMNS. Table `load_fractions`: fraction of the
        machines that fail, open or change their flank there. Table `load_sampling`: what the mesh cycles
        taken miss there, from CHECKED_SAMPLES samples at all loads together or one at each.
    """
    machine = SampledMachine.of_stage(**machine_fields)
    section = machine.section
    load_map = section.load_map or LoadMap()
    values, loads = samples(machine.causes, 0, load_map.samples), load_map.loads(machine.speed_rpm)
    count, checks_per_load = load_map.samples * len(loads), max(CHECKED_SAMPLES // len(loads), 1)

    def at_load(values: Mapping[str, Any], factor: float, speed: float) -> dict[str, Any]:
        off = values["dynamics"]["speed_rpm"] - machine.speed_rpm  # what a cause adds to it
        transmission = with_torques(values["transmission"], factor)
        return {**values, "transmission": transmission, "dynamics": {"speed_rpm": speed + off}}

    judges = [machine.judge_near(at_load(machine.start, *load)) for load in loads]

    def evaluate(number: int) -> dict[str, float]:
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
    """Return a table with its load in front."""
    return table.assign(**load)[[*load, *table.columns]]
