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


def tolerances_map(partial: str | Path | None = None, code: str = "", **given: Any) -> Outcome:
    """`load_map` (table): percentiles of every quantity at every torque and speed, COLUMNS; `load_fractions`
    (table): fraction of the machines that fail, open or change their flank there; `load_sampling` (table):
    what the mesh cycles taken miss there, from CHECKED_SAMPLES samples at all loads together or one at each.

    The same machines at every load, so that differences between loads are no accident of the samples. The
    mesh stiffness stays that of mesh_stiffness.torque_n_m. `partial`, `code` and `given` as of
    `tolerances_chunk`.
    """
    machine = SampledMachine.of_stage(**given)
    section = machine.section
    asked = section.load_map or LoadMap()
    values, loads = samples(machine.causes, 0, asked.samples), asked.loads(machine.speed_rpm)
    count, checked = asked.samples * len(loads), max(CHECKED_SAMPLES // len(loads), 1)

    def at_load(values: Mapping[str, Any], factor: float, speed: float) -> dict[str, Any]:
        off = values["dynamics"]["speed_rpm"] - machine.speed_rpm  # what a cause adds to it
        transmission = with_torques(values["transmission"], factor)
        return {**values, "transmission": transmission, "dynamics": {"speed_rpm": speed + off}}

    judges = [machine.judge_near(at_load(machine.start, *load)) for load in loads]

    def evaluate(number: int) -> dict[str, float]:
        load, row = divmod(number, asked.samples)
        loaded = at_load(machine.sample(values[row]), *loads[load])
        return machine.judge_sample(loaded, row < checked, judges[load])

    frame = machine.run(evaluate, range(count), "tolerances over torque and speed", partial, code)
    tables: list[pd.DataFrame] = []
    fractions: list[pd.DataFrame] = []
    sampling: list[pd.DataFrame] = []
    for index, (factor, speed) in enumerate(loads):
        own = frame.iloc[index * asked.samples : (index + 1) * asked.samples]
        load = {"torque_factor": factor, "speed_rpm": speed}
        results = own.drop(columns=list(machine.checks))
        percentiles = percentile_table(results, (), section.confidence, BETTER_LARGE)
        failed = int((own[ERROR] != "").sum())
        tables.append(percentiles.assign(**load, failed=failed))
        fractions.append(_at_load(load, fraction_table(own, EVENTS, section.confidence)))
        sampling.append(_at_load(load, sampling_table(own, CHECKS)))
    table = pd.concat(tables, ignore_index=True)[list(COLUMNS)]
    failed = int((frame[ERROR] != "").sum())
    return Outcome(
        {
            "load_map": table,
            "load_fractions": pd.concat(fractions, ignore_index=True),
            "load_sampling": pd.concat(sampling, ignore_index=True),
        },
        f"{count_noun(len(loads), 'load')} of {count_noun(asked.samples, 'sample')} each, "
        f"{count_noun(failed, 'machine')} failed",
    )


def _at_load(load: dict[str, float], table: pd.DataFrame) -> pd.DataFrame:
    """A table with its load in front."""
    return table.assign(**load)[[*load, *table.columns]]
