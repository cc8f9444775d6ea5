"""Stages of load sharing: at one speed, over studies, at rest, over the hunting cycle, and its map."""

from collections.abc import Sequence
from math import isclose

import pandas as pd

from facegear.build.machine import MachineInputs
from facegear.build.plans import map_options, settings, sharing_options
from facegear.errors import ConfigError
from facegear.machine.flanks import past_law
from facegear.machine.machine import Machine
from facegear.machine.static_gears import at_rest
from facegear.number_format import count_noun
from facegear.pipeline.outcome import Outcome
from facegear.schema.motion import Accuracy, LoadSharing, SharingMap
from facegear.schema.transmission import Transmission
from facegear.sharing.groups import GroupKind
from facegear.sharing.hunting import (
    bearing_table,
    cycle_table,
    group_table,
    hunting_cycle,
    hunting_length,
    mesh_table,
)
from facegear.sharing.ideal_machine import departures
from facegear.sharing.reference import reference_table, speed_range_table
from facegear.sharing.run import load_sharing as solve_load_sharing
from facegear.sharing.running_machine import running, running_mesh_table, running_table
from facegear.sharing.sensitivity import bearing_scan, sensitivities
from facegear.sharing.sharing_advice import advice
from facegear.sharing.sharing_map import idler_curves, input_curves, map_points
from facegear.sharing.tables import NOMINAL, collect_tables, curve_table, force_table, summary_table
from facegear.ties import first_largest_row


def load_sharing(
    machine: Machine,
    accuracy: Accuracy,
    speed_rpm: float,
    options: LoadSharing,
) -> Outcome:
    """Compute the load-sharing coefficients of the running machine at one speed, averaged over its
    motion.

    A coefficient of a group of meshes that share a load is the largest mesh load over the mean of the
    group.

    Parameters
    ----------
    machine : Machine
        The machine.
    accuracy : Accuracy
        Section `dynamics.accuracy` of the config: tolerances and lengths of the integration.
    speed_rpm : float
        Speed of the pinions, rpm.
    options : LoadSharing
        Section `load_sharing` of the config: how long, and from how many starts, it is averaged.

    Returns
    -------
    Outcome
        Tables `curve` (coefficient of each group over a mesh cycle), `summary` (a row a group) and
        `forces` (mean and largest force of each mesh, N). `LoadSharingResult` lists the columns of the
        first two.

    Raises
    ------
    NotConverged
        Naming the speed.
    """
    sharing = solve_load_sharing(
        machine,
        speed_rpm,
        settings(accuracy),
        sharing_options(options),
    )
    summary, response = summary_table(sharing), sharing.response
    forces = force_table(
        machine.layout,
        response.mean_forces[1],
        response.largest_forces,
        response.label,
    )
    means = ", ".join(f"{row.group} {row.mean:.3f}" for row in summary.itertuples())
    return Outcome(
        {"curve": curve_table(sharing), "summary": summary, "forces": forces},
        f"{response.label}; mean coefficients: {means or 'no meshes share a load'}",
    )


def load_sharing_summary(
    points: Sequence[Sequence[str]], summaries: Sequence[pd.DataFrame], curves: Sequence[pd.DataFrame]
) -> Outcome:
    """Collect the load sharing of the machine and of all points of its studies.

    Parameters
    ----------
    points : Sequence[Sequence[str]]
        Study, point and label of every point, without the machine itself.
    summaries : Sequence[pd.DataFrame]
        Tables `summary` of stage load_sharing: that of the machine itself first, then one a point.
    curves : Sequence[pd.DataFrame]
        Tables `curve` of stage load_sharing, one a point.

    Returns
    -------
    Outcome
        `summary`: table of all, with study, point and label in front. `studies`: a list with one table
        of curves for each study, in the order of the config.
    """
    keys = [(study, point) for study, point, _ in points]
    labels = {(study, point): label for study, point, label in points}
    frames = dict(zip([(NOMINAL, NOMINAL), *keys], summaries, strict=True))
    summary, every = collect_tables(frames, labels), dict(zip(keys, curves, strict=True))
    studies = [
        collect_tables({key: frame for key, frame in every.items() if key[0] == name}, labels)
        for name in dict.fromkeys(study for study, _ in keys)
    ]
    irregular = summary.loc[~summary["periodic"].astype(bool), ["study", "point"]].drop_duplicates()
    text = f"{count_noun(len(frames), 'case')}, "
    text += f"{len(irregular)} of them not periodic" if len(irregular) else "all periodic"
    return Outcome({"summary": summary, "studies": studies}, text)


def study_forces(
    points: Sequence[tuple[str, str, str, str, str, float]], tables: Sequence[pd.DataFrame]
) -> Outcome:
    """Collect mean and largest mesh forces of the cases of studies whose axis is a number.

    Parameters
    ----------
    points : Sequence[tuple[str, str, str, str, str, float]]
        Study, point, label of the axis with its unit, label of the point on the study's other axis,
        config key and number of every point, as `numbered_points` lists them.
    tables : Sequence[pd.DataFrame]
        Table `forces` of stage load_sharing of each point.

    Returns
    -------
    Outcome
        Table `forces`, a row for each point and mesh: study, point, axis, beside, key, number, then the
        columns of stage load_sharing's `forces`.
    """
    parts = []
    for point, table in zip(points, tables, strict=True):
        key_columns = dict(zip(("study", "point", "axis", "beside", "key", "number"), point, strict=True))
        parts.append(
            pd.DataFrame({**{name: [value] * len(table) for name, value in key_columns.items()}, **table})
        )
    forces = pd.concat(parts, ignore_index=True)
    worst = first_largest_row(forces, "largest_n")
    at = f"{worst['axis']} = {worst['number']:g}"
    text = f"largest force {worst['largest_n']:.5g} N, on {worst['mesh']} at {at}"
    return Outcome({"forces": forces}, text)


def load_sharing_reference(
    machine: Machine,
    accuracy: Accuracy,
    range_accuracy: Accuracy,
    options: LoadSharing,
) -> Outcome:
    """Compute reference values of load sharing: at rest, running slowly, and over a range of speeds.

    Parameters
    ----------
    machine : Machine
        The machine.
    accuracy : Accuracy
        Section `dynamics.accuracy` of the config.
    range_accuracy : Accuracy
        Section `dynamics.sweep.accuracy` of the config, for the range of speeds.
    options : LoadSharing
        Section `load_sharing` of the config.

    Returns
    -------
    Outcome
        Table `reference`: coefficients of the machine at rest and running slowly. Table `speeds`: a row
        a speed and group with the mean coefficient.

    Raises
    ------
    NotConverged
        Naming the speed.
    """
    sharing = sharing_options(options)
    reference = reference_table(machine, settings(accuracy), sharing)
    speeds = speed_range_table(machine, settings(range_accuracy), sharing)
    return Outcome({"reference": reference, "speeds": speeds}, _summary(speeds))


def _summary(speeds: pd.DataFrame) -> str:
    """Say in one line which group shares worst at which speed."""
    if not speeds["mean"].notna().any():
        return "no meshes share a load"
    worst = first_largest_row(speeds, "mean")
    return f"largest mean {worst['mean']:.2f} ({worst['group']}) at {worst['speed_rpm']:.0f} rpm"


def hunting(
    machine: Machine,
    positions: int,
) -> Outcome:
    """Compute the quasi-static load sharing over the hunting cycle, position by position, with statics
    alone.

    The hunting cycle is the number of mesh cycles until the pattern of errors repeats, 1 where no error
    turns with a body. Damping and inertia play no part.

    Parameters
    ----------
    machine : Machine
        The machine, with geometric meshes; its bodies are taken at rest.
    positions : int
        Number of positions in each mesh cycle.

    Returns
    -------
    Outcome
        Tables `meshes` and `groups` (loads and K_gamma), `bearings` (forces, N), `cycles` (mean load of
        each mesh by mesh cycle, N), described by `HuntingResult`. Tables `scan` (K_gamma against
        bearing stiffness) and `sensitivity` (change of K_gamma per um of each error), described by
        `SensitivityResult`.

    Raises
    ------
    NotConverged
        Where an equilibrium does not converge.
    """
    machine_at_rest = at_rest(machine)
    cycle = hunting_cycle(machine_at_rest, positions)
    content = {
        "meshes": mesh_table(cycle),
        "groups": (groups := group_table(cycle)),
        "bearings": bearing_table(cycle, machine.drive_line),
        "cycles": cycle_table(cycle),
        "scan": bearing_scan(machine_at_rest),
        "sensitivity": sensitivities(cycle),
    }
    groups_with_factor = groups.dropna(subset="k_gamma")
    if groups_with_factor.empty:
        return Outcome(content, "no path shares a load")
    past = float(past_law(machine_at_rest, cycle.cycles, cycle.flank_forces).max())
    beyond = f"; past the mesh law's last level at up to {100.0 * past:.2g} % of positions" if past else ""
    worst = first_largest_row(groups_with_factor, "k_gamma")
    summary = f"K_gamma {worst['k_gamma']:.3f} ({worst['group']}) at {worst['torque_n_m']:g} N m"
    return Outcome(content, f"{summary} over {worst['mesh_cycles']:.0f} mesh cycles{beyond}")


FINER = 4
"""Samples of the running machine for each position of the machine at rest: it has peaks between."""


def following(
    machine: Machine,
    accuracy: Accuracy,
    speed_rpm: float,
    positions: int,
    cycles: int | None,
) -> Outcome:
    """Integrate the running machine through mesh cycles of its hunting cycle, while runouts and pitch
    deviations turn.

    K_gamma is the largest mean load of a mesh cycle over the even share, K_v the largest load over that
    mean. Both stand beside the quasi-static K_gamma of the whole hunting cycle.

    Parameters
    ----------
    machine : Machine
        The machine.
    accuracy : Accuracy
        Section `dynamics.accuracy` of the config.
    speed_rpm : float
        Nominal speed of the pinions, rpm.
    positions : int
        Number of positions of a mesh cycle of the machine at rest; the running machine has FINER times
        as many samples.
    cycles : int or None
        Number of mesh cycles that are followed, at most the hunting cycle; None for all of it.

    Returns
    -------
    Outcome
        Tables `groups` and `meshes`, described by `FollowingResult`.

    Raises
    ------
    NotConverged
        Naming the position or the mesh phase.
    ConfigError
        If the flanks of the machine's mesh kinematics are not treated apart.
    """
    if not machine.layout.kinematics.flanks_apart:
        raise ConfigError(
            "transmission.mesh_kinematics", "printed", "geometric where the running machine is followed"
        )
    length = hunting_length(machine)
    part = length if cycles is None else min(cycles, length)
    running_machine = running(machine, speed_rpm, part, FINER * positions, settings(accuracy))
    groups = running_table(running_machine, hunting_cycle(machine, positions))
    factors = ", ".join(
        f"{row.group} {row.k_gamma:.3f} (at rest {row.k_gamma_static:.3f}), K_v {row.k_v:.3f}"
        for row in groups.itertuples()
    )
    return Outcome(
        {"groups": groups, "meshes": running_mesh_table(running_machine)},
        f"K_gamma over {part} of {length} mesh cycles: {factors or 'no path shares a load'}; "
        f"two starts differ by {running_machine.memory:.0e}",
    )


BEYOND = 1.2
"""Largest number on the curves over the largest of the machine's own."""
SHORTEST = 0.1
"""Largest number on the curves where the machine's own are smaller still."""


def sharing_map(
    inputs: MachineInputs,
    sharing_map: SharingMap | None,
    torques: Sequence[float],
) -> Outcome:
    """Compute the map of load sharing of the machine at rest: K_gamma over the numbers that decide it.

    For idlers the number is k_e sigma / W (path stiffness times deviation over load), for inputs 2 b k
    / W (backlash times mesh stiffness over load). The machine is placed on the map at its own torque
    and at `torques`.

    Parameters
    ----------
    inputs : MachineInputs
        Inputs of a machine with geometric meshes and two face gears.
    sharing_map : SharingMap or None
        Deviations and points; None for their defaults.
    torques : sequence of float
        Further torques of an input in each of its meshes, from the duty cycle, N m; unused where no
        torque is given per input.

    Returns
    -------
    Outcome
        Tables `curves` (idlers), `inputs`, `points` (the machine's places), `advice` (changes that were
        tried) and `reasons` (why the closed form may not hold), described by `SharingMapResult`. Raises
        NotConverged.
    """
    section, transmission = sharing_map or SharingMap(), inputs.transmission
    options, nominal = map_options(section), inputs.build()
    machines = {_torque(transmission, nominal): nominal}
    if transmission.torque.per_input_n_m != 0.0:
        for torque in torques:
            whole = torque * len(transmission.face_gears)
            if not any(isclose(whole, mapped) for mapped in machines):
                machines[whole] = inputs.at_torque(torque).build()
    points = map_points(sorted(machines.items()), options)
    largest = {
        kind: section.largest_number or max(BEYOND * _largest(points, kind), SHORTEST)
        for kind in (GroupKind.IDLERS, GroupKind.INPUTS)
    }
    content = {
        "curves": idler_curves(nominal, options, largest[GroupKind.IDLERS]),
        "inputs": input_curves(nominal, options, largest[GroupKind.INPUTS]),
        "points": points,
        "advice": (advice_table := advice(nominal, options)),
        "reasons": pd.DataFrame({"reason": departures(nominal)}, dtype=str),
    }
    return Outcome(content, _sharing_map_summary(advice_table))


def _torque(transmission: Transmission, machine: Machine) -> float:
    """Return the torque of an input over all its meshes, or without inputs that of the first face gear;
    a magnitude, N m.
    """
    torque = abs(transmission.torque.per_input_n_m)
    return torque or float(abs(machine.torques[len(machine.layout.pinions)]))


def _largest(points: pd.DataFrame, kind: GroupKind) -> float:
    """Return the largest number k_e sigma / W or 2 b k / W among the points of one kind of group, 0 if
    it has none.
    """
    return (
        float(points.loc[points["kind"] == kind.value, "number"].max())
        if kind.value in set(points["kind"])
        else 0.0
    )


def _sharing_map_summary(advice_table: pd.DataFrame) -> str:
    """Say in one line which change of the machine lowers the largest K_gamma most."""
    if advice_table.empty:
        return "no group carries a load to share"
    row = advice_table.loc[advice_table["worst_found"].idxmin()]
    before, after = row["worst"], row["worst_found"]
    if after >= before:
        return f"largest K_gamma {before:.3f}, which no change that was tried lowers"
    return f"largest K_gamma {before:.3f}, {after:.3f} by this change: {row['change']} ({row['from_to']})"
