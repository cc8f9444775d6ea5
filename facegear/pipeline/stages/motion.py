"""Stages of the machine in motion: response at one speed, sweeps, branches of periodic motions."""

from collections.abc import Iterable, Mapping
from dataclasses import replace

import pandas as pd

from facegear.arrays import AnyArray, Arrays
from facegear.build.plans import branch_plan, settings, sweep_plan
from facegear.machine.loaded_modes import loaded_modes
from facegear.machine.machine import Machine
from facegear.motion.bearing_forces import bearing_table
from facegear.motion.branches import operating_tables, tables
from facegear.motion.branches.machine import (
    machine_loci,
    machine_period_map,
    machine_survey,
    margins,
    random_starts,
)
from facegear.motion.branches.margins import coexistence_ranges
from facegear.motion.branches.motion_arrays import (
    motions_from_arrays,
    motions_to_arrays,
    special_arrays,
    special_points,
    swept_motions,
)
from facegear.motion.branches.survey import loci_summary, survey_summary, tell
from facegear.motion.branches.tables import locus_table
from facegear.motion.response_tables import (
    law_loads_table,
    multiplier_table,
    response_table,
    spectrum_table,
    summary_of_response,
)
from facegear.motion.steady_state.simulate import build_model, simulate
from facegear.motion.steady_state.statistics import ORDERS
from facegear.motion.sweeps.sweep import run_chunk
from facegear.motion.sweeps.sweep_tables import (
    jump_table,
    resonance_table,
    response_summary,
    seam_table,
    sweep_summary,
    sweep_table,
)
from facegear.motion.sweeps.whole_sweep import Direction, from_arrays, to_arrays, whole_sweep
from facegear.number_format import count_noun
from facegear.pipeline.outcome import Outcome
from facegear.progress import Progress
from facegear.schema.motion import SECOND_LOOKS, Accuracy, Branches, Sweep


def dynamics_response(
    machine: Machine,
    accuracy: Accuracy,
    speed_rpm: float,
) -> Outcome:
    """Integrate the motion of the machine at one speed to its steady state, and tabulate it.

    A class of motion that is in doubt must come out again from SECOND_LOOKS other starts.

    Parameters
    ----------
    machine : Machine
        The machine.
    accuracy : Accuracy
        Section `dynamics.accuracy` of the config: tolerances and lengths of the integration.
    speed_rpm : float
        Speed of the pinions, rpm.

    Returns
    -------
    Outcome
        Tables `response` (deflection and force of each mesh over time), `spectrum` (amplitude by
        multiple of the mesh frequency), `summary` (the numbers that a sweep keeps), `multipliers`
        (Floquet multipliers; empty if not periodic) and `bearings`. `ResponseResult` lists the columns.

    Raises
    ------
    NotConverged
        Naming the speed.
    """
    model = build_model(machine)
    response = simulate(model, speed_rpm, replace(settings(accuracy), second_looks=SECOND_LOOKS))
    layout = model.machine.layout
    content = {
        "response": response_table(layout, response),
        "spectrum": spectrum_table(layout, response),
        "summary": summary_of_response(model, speed_rpm, response),
        "multipliers": multiplier_table(response),
        "bearings": bearing_table(model, response),
    }
    return Outcome(content, response_summary(response))


def dynamics_sweep_chunk(
    direction: str,
    number: int,
    machine: Machine,
    sweep: Sweep,
) -> Outcome:
    """Compute one chunk of a sweep: steady states at a range of speeds, each from the state at the
    speed before it.

    A sweep is cut into chunks of speeds that run in parallel. Each starts some speeds early, so that
    its first state is forgotten where the chunk before it ends.

    Parameters
    ----------
    direction : str
        Direction of the sweep, `up` or `down`.
    number : int
        Number of the chunk, from 0, in the order of running.
    machine : Machine
        The machine.
    sweep : Sweep
        Section `sweep` of the config.

    Returns
    -------
    Outcome
        Arrays `chunk`: results at the speeds of the overlap and at the chunk's own speeds, as
        `to_arrays` of `facegear.motion.sweeps.whole_sweep` stores them.

    Raises
    ------
    NotConverged
        Naming the speed.
    """
    plan = sweep_plan(sweep)
    total = sum(map(len, plan.chunk(direction, number)))
    progress = Progress(f"sweep {direction}, chunk {number}", total)
    model = build_model(machine)
    before, piece = run_chunk(model, plan, direction, number, progress.step)
    summary = f"{count_noun(len(piece.speeds), 'speed')} {direction}, {len(before.speeds)} for overlap"
    return Outcome({"chunk": to_arrays(before, piece)}, summary)


def dynamics_sweep(
    chunks: Iterable[Arrays],
    machine: Machine,
    sweep: Sweep,
    threads: int = 1,
) -> Outcome:
    """Join the chunks of a sweep, and find its jumps and resonances.

    Jumps are bracketed to the resolution that the config asks for, by more speeds between two of the
    sweep.

    Parameters
    ----------
    chunks : Iterable[Arrays]
        Arrays of all chunks, direction by direction in the order of the config.
    machine : Machine
        The machine.
    sweep : Sweep
        Section `sweep` of the config.
    threads : int
        Number of threads that compute jumps and seams; results do not depend on it.

    Returns
    -------
    Outcome
        Tables `sweep` (a row a direction, speed, quantity and body or mesh), `jumps`, `resonances` and
        `seams` (where chunks met, and whether one was run again). `SweepResult` lists the columns.
        Arrays `waterfall`: see `_waterfall`.
    """
    model = build_model(machine)
    plan, layout = sweep_plan(sweep), model.machine.layout
    chunk_arrays = iter(chunks)
    pieces = {name: [from_arrays(next(chunk_arrays)) for _ in range(plan.chunks)] for name in plan.directions}
    directions = whole_sweep(model, plan, pieces, threads)
    modes = loaded_modes(model.machine)
    content = {
        "sweep": pd.concat([sweep_table(layout, n, d.piece) for n, d in directions.items()]),
        "jumps": pd.concat([jump_table(layout, n, d, modes) for n, d in directions.items()]),
        "resonances": pd.concat([resonance_table(layout, n, d.piece, modes) for n, d in directions.items()]),
        "seams": seam_table([seam for d in directions.values() for seam in d.seams]),
        "waterfall": _waterfall(directions),
    }
    return Outcome(content, sweep_summary(directions))


def _waterfall(directions: Mapping[str, Direction]) -> dict[str, AnyArray]:
    """Return spectra of the mesh deflections by name of the array.

    `orders` (o,) are multiples of the mesh frequency. For each direction there are
    `<direction>_speed_rpm` (p,) in the order of running, and `<direction>_amplitude_m` (p, meshes, o).
    """
    arrays = {"orders": ORDERS}
    for name, direction in directions.items():
        arrays[f"{name}_speed_rpm"] = direction.piece.speeds
        arrays[f"{name}_amplitude_m"] = direction.piece.spectrum
    return arrays


def branches_starts(
    number: int,
    machine: Machine,
    branches: Branches | None,
    speed_rpm: float,
) -> Outcome:
    """Integrate the motion from random initial states at one speed, and count on which steady motions
    they end.

    Parameters
    ----------
    number : int
        Index of the speed among `branches.explore.speeds_rpm`, from 0; without such speeds 0 stands for
        the nominal one.
    machine : Machine
        The machine.
    branches : Branches or None
        Section `branches` of the config, None if it has none.
    speed_rpm : float
        Nominal speed of the pinions, rpm, from which defaults of the section follow.

    Returns
    -------
    Outcome
        Arrays `motions`: the different motions, with the fraction of starts that ends on each and its
        standard error.

    Raises
    ------
    NotConverged
        Naming the speed.
    """
    model = build_model(machine)
    plan = branch_plan(branches, speed_rpm)
    speed = plan.speeds_rpm[number]
    motions = random_starts(model, plan, speed, Progress("random starts", plan.starts).step)
    fractions = ", ".join(
        f"{motion.label} {100 * motion.fraction:.1f} +- {100 * motion.error:.1f} %" for motion in motions
    )
    return Outcome({"motions": motions_to_arrays(speed, motions)}, f"{speed:g} rpm: {fractions}")


def branches(
    starts: Iterable[Arrays],
    chunks: Iterable[Arrays],
    jumps: pd.DataFrame,
    machine: Machine,
    branches: Branches | None,
    sweep: Sweep,
    speed_rpm: float,
) -> Outcome:
    """Follow branches of periodic motions over the speed, stable or not, by continuation.

    They begin at the periodic motions on which random starts end, at those of the sweep, and at period
    doublings and branch points that are met on the way.

    Parameters
    ----------
    starts : Iterable[Arrays]
        Arrays of stage branches_starts, speed by speed.
    chunks : Iterable[Arrays]
        Arrays of the sweep's chunks, direction by direction in the order of the config.
    jumps : pd.DataFrame
        Table `jumps` of stage dynamics_sweep; those within the range of speeds are explained by special
        points.
    machine : Machine
        The machine.
    branches : Branches or None
        Section `branches` of the config, None if it has none.
    sweep : Sweep
        Section `sweep` of the config.
    speed_rpm : float
        Nominal speed of the pinions, rpm, about which margins are counted and from which defaults of
        the section follow.

    Returns
    -------
    Outcome
        Tables `branches` (a row a branch, point and mesh), `ends`, `unfollowed` (motions on no branch),
        `multipliers`, `special` (folds and other bifurcations), `coexistence`, `ranges`, `margins`,
        `swept` and `jumps`; `BranchesResult` describes them. Arrays `orbits`: the special points with
        their states, which stage branches_loci follows.

    Raises
    ------
    NotConverged
        If no motion of period one is found.
    """
    model = build_model(machine)
    plan, layout = branch_plan(branches, speed_rpm), model.machine.layout
    period_map, swept_plan = machine_period_map(model, plan), sweep_plan(sweep)
    start_motions = [motions_from_arrays(period_map, arrays) for arrays in starts]
    chunk_arrays = iter(chunks)
    pieces = {
        name: [from_arrays(next(chunk_arrays))[1] for _ in range(swept_plan.chunks)]
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


def branches_loci(
    orbits: Arrays,
    machine: Machine,
    branches: Branches | None,
    speed_rpm: float,
) -> Outcome:
    """Follow folds and period doublings while speed and a second parameter (torque, backlash, ...)
    change together.

    Parameters
    ----------
    orbits : Arrays
        Arrays `orbits` of stage branches: the special points with their states.
    machine : Machine
        The machine.
    branches : Branches or None
        Section `branches` of the config, None if it has none.
    speed_rpm : float
        Nominal speed of the pinions, rpm.

    Returns
    -------
    Outcome
        Table `loci`: a row a point of a curve, with the parameter, the factor on it and the speed; see
        `BranchLociResult`.
    """
    model = build_model(machine)
    plan = branch_plan(branches, speed_rpm)
    loci, failures = machine_loci(model, plan, special_points(machine_period_map(model, plan), orbits), tell)
    return Outcome({"loci": locus_table(loci)}, loci_summary(loci, failures))


def law_loads(
    levels: pd.DataFrame, response: pd.DataFrame, summary: pd.DataFrame, sweep: pd.DataFrame
) -> Outcome:
    """Compare the mesh forces of the running machine with the last level of the load-dependent mesh
    law.

    Beyond its last level the law is extrapolated linearly, so that this tells whether it reaches far
    enough.

    Parameters
    ----------
    levels : pd.DataFrame
        Table `levels` of stage mesh_law.
    response : pd.DataFrame
        Table `response` of stage dynamics_response, mesh forces over time.
    summary : pd.DataFrame
        Table `summary` of stage dynamics_response.
    sweep : pd.DataFrame
        Table `sweep` of stage dynamics_sweep.

    Returns
    -------
    Outcome
        Table `loads`, a row for each mesh: mesh, flank, mean force at the last level, smallest, mean
        and largest force at the nominal speed (N), and the largest fraction of the time past the last
        level, there and in the sweep.
    """
    table = law_loads_table(levels, response, summary, sweep)
    ratio = (table["largest_n"] / table["last_level_n"]).max()
    past = table["sweep_past_fraction"].max()
    text = (
        f"at most {100.0 * ratio:.0f} % of the last level's force at the nominal speed; in the sweep past it "
        f"for up to {100.0 * past:.2g} % of the time"
    )
    return Outcome({"loads": table}, text)
