"""Sensitivity of load sharing to every single error, and to the stiffness of the bearings."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd

from facegear.arrays import Array, Mask
from facegear.machine.drive_line import DriveLine
from facegear.machine.elastic_gears import ElasticGears
from facegear.machine.flanks import flank_law
from facegear.machine.imperfections import Imperfections, Runout, perfect
from facegear.machine.kinematics import KINEMATICS
from facegear.machine.layout import Kinematics, Layout, Role
from facegear.machine.machine import Machine
from facegear.machine.poses.mesh_poses import ForceDirections
from facegear.machine.torques import balanced_torques
from facegear.sharing.even_shares import even_shares
from facegear.sharing.hunting import HuntingCycle, at_cycles, hunting_cycle, hunting_length, largest
from facegear.ties import size_ranks

STEP = 1e-10
"""Step of the differences, m: far above rounding, and so small that no other mesh cycle becomes the
hardest.
"""
POSITIONS = 8
"""Positions in a mesh cycle."""
BEARINGS = np.geomspace(1e6, 1e11, 26)
"""Stiffness of the bearings in the scan, N/m."""


def worst_factor(run: HuntingCycle, kind: str | None = None) -> float:
    """Return the largest K_gamma of all meshes that share a load, or of those in the groups of one kind.

    Parameters
    ----------
    run : HuntingCycle
        The quasi-static motion.
    kind : str or None
        "inputs", "idlers" or "independent" (value of a GroupKind); None for all groups.

    Returns
    -------
    float
        K_gamma, dimensionless; nan where there is none.
    """
    factors = [largest(run.path_factors(group)) for group in run.groups if kind in (None, group.kind.value)]
    return largest(np.array(factors))


def sensitivities(base: HuntingCycle) -> pd.DataFrame:
    """Compute the change of K_gamma per um of each error.

    Central differences about the machine as it is; sizes that cannot be negative count from where they are.
    Both ends are taken at the same positions, POSITIONS or more, of the same mesh cycles: of the longer of
    their hunting cycles those that can be the hardest of a group. A group whose paths have no K_gamma has no
    row.

    Parameters
    ----------
    base : HuntingCycle
        The whole hunting cycle of the machine as it is.

    Returns
    -------
    pd.DataFrame
        One row an error and group, largest first, twins in the order of their errors: columns
        error, group, per_um.

    Raises
    ------
    NotConverged
        If no equilibrium is found.
    """
    base = _coarser(base)
    machine, rows, hard = base.machine, [], _may_be_hardest(base)
    for name, low, high, width in _changes(machine):
        end_machines = (low, high)
        # The base repeats itself through a longer hunting cycle.
        hardest = np.flatnonzero(np.tile(hard, max(map(hunting_length, end_machines)) // hard.size))
        ends = [at_cycles(end_machine, hardest, base.positions) for end_machine in end_machines]
        for group in base.groups:
            before, after = (largest(run.path_factors(group)) for run in ends)
            rows.append((name, group.name, 1e-6 * (after - before) / width))
    frame = pd.DataFrame(rows, columns=["error", "group", "per_um"]).dropna()
    order = np.argsort(size_ranks(frame["per_um"].to_numpy(float)), kind="stable")
    return frame.iloc[order].reset_index(drop=True)


def _coarser(base: HuntingCycle) -> HuntingCycle:
    """Thin the hunting cycle to POSITIONS evenly spaced positions of each mesh cycle, if their number
    allows.

    The equilibria `at_rest` are left as they are.
    """
    every = base.positions // POSITIONS
    if every < 2 or base.positions % every:
        return base
    loads = base.flank_forces[::every]
    return replace(base, positions=base.positions // every, cycles=base.cycles[::every], flank_forces=loads)


def _may_be_hardest(base: HuntingCycle) -> Mask:
    """Tell for each mesh cycle of the base whether it may hold a group's largest K_gamma after a change
    of STEP.

    Forces of springs that only push change by no more than the stiffest of them times the change of all
    gaps together. Where no group has a K_gamma the first cycle stands for all. Booleans (mesh cycles,).
    """
    machine, even = base.machine, even_shares(base.machine)
    factors = np.nan_to_num(base.cycle_means / even, nan=-np.inf)
    bearings = max(max(pinion.body.bearing[:2]) for pinion in machine.layout.pinions)
    meshes = float(flank_law(machine).steepest.max())
    stiffest = max(meshes, np.sqrt(meshes * bearings))
    reach = 2.0 * STEP * stiffest * np.sqrt(base.flank_forces.shape[1])
    hard = np.zeros(len(factors), dtype=bool)
    for group in base.groups:
        group_factors = factors[:, list(group.meshes)]
        threshold = (
            group_factors.max() - reach / np.nanmin(even) if np.isfinite(group_factors).any() else np.inf
        )
        hard |= (group_factors >= threshold).any(axis=1)
    hard[0] |= not hard.any()
    return hard


def bearing_scan(machine: Machine) -> pd.DataFrame:
    """Compute K_gamma of each kind of group against the bearing stiffness of inputs or idlers, in both
    kinematics, or in one alone for teeth that are not spur teeth at right angles.

    The scan takes one mesh cycle, with constant errors of meshes only. A kind whose paths have no even share
    has no K_gamma and no row.

    Parameters
    ----------
    machine : Machine
        The machine.

    Returns
    -------
    pd.DataFrame
        Columns kinematics, varied, stiffness_n_per_m, kind, k_gamma.

    Raises
    ------
    NotConverged
        If no equilibrium is found.
    """
    rows = []
    for name, kinematics in KINEMATICS.items():
        if machine.layout.kind is not None and kinematics is not machine.layout.kinematics:
            continue  # equation (13) as printed knows spur teeth alone
        base = _with_kinematics(machine, kinematics)
        for varied_pinions, roles in (("inputs", (Role.INPUT,)), ("idlers", (Role.IDLER, Role.TAIL))):
            for stiffness in BEARINGS:
                run = hunting_cycle(_with_bearings(base, roles, float(stiffness)), POSITIONS)
                for kind in dict.fromkeys(group.kind.value for group in run.groups):
                    rows.append((name, varied_pinions, stiffness, kind, worst_factor(run, kind)))
    columns = ["kinematics", "varied", "stiffness_n_per_m", "kind", "k_gamma"]
    return pd.DataFrame(rows, columns=columns).dropna(ignore_index=True)


def _changes(machine: Machine) -> Iterator[tuple[str, Machine, Machine, float]]:
    """Yield for each error: its name, the machine with less of it, the machine with more, and the
    difference (m).

    The differences are 2 STEP, or less where a size cannot be negative.
    """
    layout, errors, half = machine.layout, machine.imperfections, machine.half_backlash
    for mesh, name in enumerate(layout.mesh_names):
        yield f"error {name}", *_shift_error(machine, "error", mesh), 2 * STEP
        tighter, looser = _with_step(half, mesh, -min(STEP, half[mesh])), _with_step(half, mesh, STEP)
        low, high = (replace(machine, half_backlash=values) for values in (tighter, looser))
        yield f"backlash {name}", low, high, 2 * float(looser[mesh] - tighter[mesh])
    for i, pinion in enumerate(layout.pinions):
        for k, letter in enumerate("xy"):
            yield f"position {letter} {pinion.name}", *_shift_error(machine, "position", (i, k)), 2 * STEP
        if layout.kind is not None:
            yield f"position z {pinion.name}", *_shift_error(machine, "outwards", i), 2 * STEP
        if errors.bearing_clearance[i] > STEP:
            yield f"clearance {pinion.name}", *_shift_error(machine, "bearing_clearance", i), 2 * STEP
    for key, names in (
        ("pinion_runout", [pinion.name for pinion in layout.pinions]),
        ("gear_runout", [gear.name for gear in layout.gears]),
    ):
        for body, name in enumerate(names):
            amplitude = getattr(errors, key)[body].amplitude
            ends = max(amplitude - STEP, 0.0), amplitude + STEP
            low, high = (replace(machine, imperfections=_with_runout(errors, key, body, end)) for end in ends)
            yield f"runout {name}", low, high, ends[1] - ends[0]


def _shift_error(machine: Machine, key: str, index: int | tuple[int, int]) -> tuple[Machine, Machine]:
    """Return two machines, in which one entry of an error array is smaller, and larger, by STEP (m).

    `key` is a field of Imperfections ("error", "position", "outwards" or "bearing_clearance"), `index` the
    entry of its array.
    """
    errors = machine.imperfections

    def machine_with(step: float) -> Machine:
        """Return the machine with `step` (m) added to the entry."""
        values: dict[str, Any] = {key: _with_step(getattr(errors, key), index, step)}
        return replace(machine, imperfections=replace(errors, **values))

    return machine_with(-STEP), machine_with(STEP)


def _with_step(values: Array, index: int | tuple[int, int], step: float) -> Array:
    """Return a copy of the array with `step` added to the entry at `index`, in the array's unit."""
    stepped = values.copy()
    stepped[index] += step
    return stepped


def _with_runout(base: Imperfections, key: str, body: int, amplitude: float) -> Imperfections:
    """Return imperfections in which the runout of one body has another amplitude, m; its phase stays.

    `key` is "pinion_runout" or "gear_runout", `body` the index in it.
    """
    runouts: list[Runout] = list(getattr(base, key))
    runouts[body] = replace(runouts[body], amplitude=amplitude)
    values: dict[str, Any] = {key: tuple(runouts)}
    return replace(base, **values)


def _with_kinematics(machine: Machine, kinematics: Kinematics) -> Machine:
    """Return a simplified machine with other kinematics, for the bearing scan.

    It keeps mesh errors, backlash, stiffness and balanced torques, and loses tilt of the gears, drive
    line and all other errors. Elastic bodies and a casing stay only if the kinematics do.
    """
    layout = machine.layout
    conjugate = layout.pinion_radius * layout.gear_teeth / layout.pinion_teeth
    radius = kinematics.gear_radius(conjugate, layout.pressure_angle)
    gears = tuple(replace(gear, body=replace(gear.body, tilt=None)) for gear in layout.gears)
    new_layout = replace(layout, gear_radius=radius, kinematics=kinematics, gears=gears)
    old_errors = machine.imperfections
    errors = replace(perfect(new_layout), error=old_errors.error, stiffness=old_errors.stiffness)
    pinions = len(layout.pinions)
    lower = machine.torques[pinions] if len(layout.gears) > 1 else 0.0
    torques = balanced_torques(new_layout, machine.torques[:pinions], float(lower))
    # At rest a drive line is what the layout has in its place, unless meshes tilt the pinions. Rolling
    # bearings know their load; where both flanks share a line of action they are springs.
    line = machine.drive_line
    if line is not None and layout.kind is None:
        keeps_rolling = bool(line.rolling) and kinematics is layout.kinematics
        line = _rolling_alone(line, new_layout) if keeps_rolling else None
    elif line is not None:
        line = replace(line, layout=new_layout)
    directions = machine.directions
    if isinstance(directions, ForceDirections):
        directions = replace(directions, layout=new_layout)
    machine_with_layout = replace(
        machine,
        layout=new_layout,
        torques=torques,
        imperfections=errors,
        drive_line=line,
        directions=directions,
    )
    if kinematics is not layout.kinematics:
        return replace(machine_with_layout, bodies=None, softening=None, casing=None)
    if isinstance(machine.bodies, ElasticGears):
        return replace(machine_with_layout, bodies=replace(machine.bodies, layout=new_layout))
    return machine_with_layout


def _rolling_alone(line: DriveLine, layout: Layout) -> DriveLine:
    """Return the drive line of a layout with the shafts on rolling bearings alone, whose pinions do not
    tilt.
    """
    seats = {i: replace(line.seats[i], tilt_inertia=None) for i in line.rolling}
    return DriveLine(layout, seats, {})


def _with_bearings(machine: Machine, roles: tuple[Role, ...], stiffness: float) -> Machine:
    """Return the machine with a radial bearing stiffness (N/m) of the pinions of some roles; their shafts
    are removed.
    """
    machine_with_bearings = replace(machine, layout=_layout_with_bearings(machine.layout, roles, stiffness))
    if machine.drive_line is None:
        return machine_with_bearings
    pinions = {i for i, pinion in enumerate(machine.layout.pinions) if pinion.role in roles}
    return replace(
        machine_with_bearings,
        drive_line=machine.drive_line.without_shafts(pinions, machine_with_bearings.layout),
    )


def _layout_with_bearings(layout: Layout, roles: tuple[Role, ...], stiffness: float) -> Layout:
    """Return the layout with radial bearing stiffness x = y = `stiffness` (N/m) of the pinions of some
    roles; the axial one stays.
    """
    pinions = tuple(
        replace(
            pinion,
            body=replace(pinion.body, bearing=(stiffness, stiffness, pinion.body.bearing[2]), bearing_xy=0.0),
        )
        if pinion.role in roles
        else pinion
        for pinion in layout.pinions
    )
    return replace(layout, pinions=pinions)
