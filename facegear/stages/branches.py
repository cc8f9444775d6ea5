"""Branches of periodic motions over the speed, their special points, margins of the nominal speed."""

from collections.abc import Iterable

import pandas as pd

from facegear.arrays import Arrays
from facegear.config.branches import Branches, branch_plan
from facegear.config.dynamics import Sweep, sweep_plan
from facegear.dynamics.branches import operating_tables, tables
from facegear.dynamics.branches.machine import machine_period_map, machine_survey, margins
from facegear.dynamics.branches.margins import coexistence_ranges
from facegear.dynamics.branches.motion_arrays import from_arrays, special_arrays
from facegear.dynamics.branches.summary import survey_summary, tell
from facegear.dynamics.branches.sweep_orbits import swept_motions
from facegear.dynamics.steady_state.simulate import build_model
from facegear.dynamics.sweeps.chunk_arrays import from_arrays as chunk_from_arrays
from facegear.stages.outcome import Outcome
from facegear.transmission.machine import Machine


def branches(
    starts: Iterable[Arrays],
    chunks: Iterable[Arrays],
    jumps: pd.DataFrame,
    machine: Machine,
    branches: Branches | None,
    sweep: Sweep,
    speed_rpm: float,
) -> Outcome:
    """Follow branches of periodic motions over the speed, from random starts and from the sweep.

    Parameters
    ----------
    starts : Iterable[Arrays]
        Arrays of stage branches_starts, speed by speed.
    chunks : Iterable[Arrays]
        Arrays of the sweep's chunks, direction by direction in the order of the config.
    jumps : pd.DataFrame
        Table `jumps` of stage dynamics_sweep.
    machine : Machine
        The machine.
    branches : Branches or None
        Section `branches` of the config, None if it has none.
    sweep : Sweep
        Section `sweep` of the config.
    speed_rpm : float
        Nominal speed of the pinions, rpm.

    Returns
    -------
    Outcome
        Tables `branches`, `ends`, `unfollowed`, `multipliers`, `special`, `coexistence`, `ranges`, `margins`,
        `swept` and `jumps`, arrays `orbits`.

    Raises
    ------
    NotConverged
        If no motion of period one is found.
    """
    model = build_model(machine)
    plan, layout = branch_plan(branches, speed_rpm), model.machine.layout
    period_map, swept_plan = machine_period_map(model, plan), sweep_plan(sweep)
    start_motions = [from_arrays(period_map, arrays) for arrays in starts]
    chunk_arrays = iter(chunks)
    pieces = {
        name: [chunk_from_arrays(next(chunk_arrays))[1] for _ in range(swept_plan.chunks)]
        for name in swept_plan.directions
    }
    motions_of_sweep = swept_motions(period_map, pieces, plan.from_rpm, plan.to_rpm)
    survey = machine_survey(model, plan, start_motions, motions_of_sweep, tell)
    ranges, stability_limits = coexistence_ranges(survey.branches), margins(model, plan, survey.branches)
    within = jumps[jumps["speed_before_rpm"].between(plan.from_rpm, plan.to_rpm)]
    spacing = (swept_plan.last_rpm - swept_plan.first_rpm) / (swept_plan.points - 1)
    content = {
        "branches": tables.branch_table(layout, survey.branches),
        "ends": tables.end_table(survey.branches),
        "unfollowed": tables.unfollowed_table(survey.unfollowed_motions),
        "multipliers": tables.multiplier_table(survey.branches),
        "special": tables.special_table(layout, survey.branches),
        "coexistence": operating_tables.coexistence_table(start_motions, survey.branches),
        "ranges": operating_tables.range_table(ranges),
        "margins": operating_tables.margin_table(stability_limits),
        "swept": operating_tables.swept_table(motions_of_sweep, survey.branches, plan.longest_start_period),
        "jumps": operating_tables.jump_table(
            within, motions_of_sweep, survey.branches, swept_plan.jump_resolution_rpm, spacing
        ),
        "orbits": special_arrays(survey.branches),
    }
    return Outcome(
        content, survey_summary(survey, ranges, stability_limits, content["swept"], content["jumps"])
    )
