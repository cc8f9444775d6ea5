"""Percentiles of a machine with its tolerances over torque and speed."""

from pathlib import Path
from typing import Any

import pandas as pd

from facegear.config.lumped_model import with_torques
from facegear.config.tolerances import LoadMap
from facegear.scenarios.chunks import ERROR
from facegear.scenarios.sampling import samples
from facegear.scenarios.summary import percentile_table, share_table
from facegear.stages.outcome import Outcome
from facegear.stages.sampled_machine import SampledMachine
from facegear.stages.tolerances import SHARES

COLUMNS = (
    *("torque_factor", "speed_rpm", "quantity", "percentile"),
    *("value", "low", "high", "samples", "failed"),
)


def tolerances_map(partial: str | Path | None = None, code: str = "", **given: Any) -> Outcome:
    """`load_map` (table): percentiles of every quantity at every torque and speed, COLUMNS; `load_shares`
    (table): share of the machines that fail, open or change their flank there.

    The same machines at every load, so that differences between loads are no accident of the samples. The
    mesh stiffness stays that of mesh_stiffness.torque_n_m. `partial`, `code` and `given` as of
    `tolerances_chunk`.
    """
    machine = SampledMachine.of_stage(**given)
    section, judge = machine.section, machine.judge
    asked = section.load_map or LoadMap()
    values, loads = samples(machine.causes, 0, asked.samples), asked.loads(machine.speed_rpm)
    count = asked.samples * len(loads)

    def evaluate(number: int) -> dict[str, float]:
        load, row = divmod(number, asked.samples)
        factor, speed = loads[load]
        changed = machine.sample(values[row])
        off = changed["dynamics"]["speed_rpm"] - machine.speed_rpm  # what a cause adds to it
        return judge(
            {
                **changed,
                "transmission": with_torques(changed["transmission"], factor),
                "dynamics": {"speed_rpm": speed + off},
            }
        )

    frame = machine.run(evaluate, range(count), "tolerances over torque and speed", partial, code)
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
