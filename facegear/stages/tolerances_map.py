"""Percentiles of a machine with its tolerances over torque and speed."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pandas as pd

from facegear.config.base import parse
from facegear.config.lumped_model import with_torques
from facegear.config.tolerances import LoadMap, Tolerances
from facegear.progress import Progress
from facegear.scenarios.chunks import ERROR, identity
from facegear.scenarios.sampling import samples
from facegear.scenarios.summary import percentile_table, share_table
from facegear.stages.outcome import Outcome
from facegear.stages.sampled_machine import run_samples, sampled_machine
from facegear.stages.tolerances import SHARES
from facegear.stages.tooth_meshes import Flanks

COLUMNS = (
    *("torque_factor", "speed_rpm", "quantity", "percentile"),
    *("value", "low", "high", "samples", "failed"),
)


def tolerances_map(
    harmonics: pd.DataFrame,
    transmission: Mapping[str, Any],
    teeth: Mapping[str, Any],
    accuracy: Mapping[str, Any],
    speed_rpm: float,
    options: Mapping[str, Any],
    tolerances: Mapping[str, Any],
    pair: Mapping[str, Any] | None = None,
    flanks: Flanks | None = None,
    partial: str | Path | None = None,
    code: str = "",
) -> Outcome:
    """`load_map` (table): percentiles of every quantity at every torque and speed, COLUMNS; `load_shares`
    (table): share of the machines that fail, open or change their flank there.

    The same machines at every load, so that differences between loads are no accident of the samples. The
    mesh stiffness stays that of mesh_stiffness.torque_n_m. `pair`, `flanks`, `partial` and `code` as of
    `tolerances_chunk`.
    """
    section = parse(Tolerances, tolerances)
    asked = section.load_map or LoadMap()
    given = transmission, teeth, accuracy, speed_rpm, options, pair
    machine = sampled_machine(section, harmonics, *given, flanks)
    values, loads = samples(machine.causes, 0, asked.samples), asked.loads(speed_rpm)
    count = asked.samples * len(loads)

    def evaluate(number: int) -> dict[str, float]:
        load, row = divmod(number, asked.samples)
        factor, speed = loads[load]
        changed = machine.sample(values[row])
        off = changed["dynamics"]["speed_rpm"] - speed_rpm  # what a cause adds to it
        return machine.judge(
            {
                **changed,
                "transmission": with_torques(changed["transmission"], factor),
                "dynamics": {"speed_rpm": speed + off},
            }
        )

    same = identity(*given, tolerances, harmonics.to_csv(), code)
    progress = Progress("tolerances over torque and speed", count)
    frame = run_samples(evaluate, range(count), machine.names, partial, same, progress)
    tables, shares = [], []
    for place, (factor, speed) in enumerate(loads):
        own = frame.iloc[place * asked.samples : (place + 1) * asked.samples]
        found = percentile_table(own, (), section.confidence)
        failed = int((own[ERROR] != "").sum())
        tables.append(found.assign(torque_factor=factor, speed_rpm=speed, failed=failed))
        of_load = share_table(own, SHARES, section.confidence)
        of_load.insert(0, "torque_factor", factor)
        of_load.insert(1, "speed_rpm", speed)
        shares.append(of_load)
    table = pd.concat(tables, ignore_index=True)[list(COLUMNS)]
    failed = int((frame[ERROR] != "").sum())
    return Outcome(
        {"load_map": table, "load_shares": pd.concat(shares, ignore_index=True)},
        f"{len(loads)} loads of {asked.samples} samples each, {failed} machines failed",
    )
