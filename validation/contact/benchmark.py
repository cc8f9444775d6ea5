"""Speed against error of the contact chain, and what each shortcut does to the stiffness."""

import resource
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, TypeVar

import numpy as np
import pandas as pd

from facegear.contact.bodies.compliance import coupled_compliance, whole
from facegear.contact.bodies.layer import tied_system
from facegear.contact.bodies.substructure import condense, halves
from facegear.contact.gear_flank import BUILDERS, GearFlank, contact_model, extent, gear_flank
from facegear.contact.ltca import even_positions, loaded_contact
from facegear.contact.options import ContactOptions, ContactPlan, CutFaces, Refinement, Sector
from facegear.contact.position import LoadedPosition
from facegear.contact.teeth import elastic_tooth
from facegear.errors import NotConverged
from facegear.harmonics import fit_harmonics
from facegear.teeth.design import Material, PairDesign
from facegear.teeth.mesh_sizes import MeshSizes, named_sizes
from validation.contact.refinement_levels import CUTS, DEFAULT, LIMITS, LINEAR, SECTORS

Result = TypeVar("Result")


@dataclass(frozen=True)
class Level:
    """A resolution to be measured: name, mesh sizes and what the plan says."""

    name: str
    sizes: MeshSizes
    plan: ContactPlan


def level(name: str, design: PairDesign, plan: ContactPlan) -> Level:
    """Return a refinement level with the positions and torques of a plan.

    Parameters
    ----------
    name : str
        Name of the level.
    design : PairDesign
        The pair.
    plan : ContactPlan
        The plan.

    Returns
    -------
    Level
        The level.

    Raises
    ------
    KeyError
        For an unknown name.
    """
    resolution, cuts = CUTS[DEFAULT if name in SECTORS or name in LINEAR else name]
    level_plan = replace(plan, refinement=cuts, sector=Sector(), element="hex27")
    if name in SECTORS:
        level_plan = replace(level_plan, sector=Sector(SECTORS[name], SECTORS[name], "free"))
    if name in LINEAR:
        level_plan = replace(level_plan, element=LINEAR[name])
    return Level(name, named_sizes(resolution, design.module), level_plan)


def compliances(
    design: PairDesign, level: Level, materials: tuple[Material, Material]
) -> tuple[GearFlank, GearFlank]:
    """Compute both bodies of a level.

    Parameters
    ----------
    design : PairDesign
        The pair.
    level : Level
        The level.
    materials : tuple[Material, Material]
        Materials of pinion and gear.

    Returns
    -------
    tuple[GearFlank, GearFlank]
        Pinion and gear.
    """
    pinion, gear = (
        gear_flank(design, body, level.sizes, material, level.plan)
        for body, material in zip(BUILDERS, materials, strict=True)
    )
    return pinion, gear


@dataclass
class Stopwatch:
    """Sum of the seconds of named steps."""

    seconds: dict[str, float] = field(default_factory=dict)

    def time(self, name: str, step: Callable[..., Result], *arguments: Any) -> Result:
        """Run a step and add its time.

        Parameters
        ----------
        name : str
            Name of the step.
        step : Callable[..., Result]
            The step.
        *arguments : Any
            Arguments of the step.

        Returns
        -------
        Result
            Result of the step.
        """
        start = time.perf_counter()
        result = step(*arguments)
        self.seconds[name] = self.seconds.get(name, 0.0) + time.perf_counter() - start
        return result


def measure(design: PairDesign, level: Level, materials: tuple[Material, Material]) -> pd.DataFrame:
    """Measure a level, one row a torque: free dof, times (s), memory (GB), mean and first harmonic of both
    stiffnesses.

    Times of both bodies: element matrices and factorisation down to flank and cut faces; compliance of the
    flanks in the ring; then contact at all positions and torques, and the sum. One position is solved
    beforehand, so that machine code is loaded. The memory is the process's largest so far, so that levels
    should be measured in processes of their own.

    Parameters
    ----------
    design : PairDesign
        The pair.
    level : Level
        The level.
    materials : tuple[Material, Material]
        Materials of pinion and gear.

    Returns
    -------
    DataFrame
        Columns of `summary` (N/m), level, element and costs.
    """
    watch, dof, bodies, plan = Stopwatch(), 0, [], level.plan
    for body, material in zip(BUILDERS, materials, strict=True):
        tooth = BUILDERS[body](design, level.sizes)
        elastic, side = elastic_tooth(design, tooth, material)
        system = watch.time("assembly_s", tied_system, elastic, plan.refinement, plan.element)
        dof_per_body, solutions = extent(tooth, body, plan), []
        for half in watch.time("assembly_s", halves, system):
            condensed_bodies = watch.time("factorisation_s", condense, half.system)
            rest = half.system, condensed_bodies, plan.refinement, *dof_per_body, plan.element
            solutions.append(watch.time("compliance_s", coupled_compliance, *rest))
        bodies.append(GearFlank(side, watch.time("compliance_s", whole, solutions)))
        dof += int(np.count_nonzero(~system.is_held))
    model = contact_model(design, *bodies)
    loaded_contact(model, [0.3], plan.torques, plan.options)
    run = model, even_positions(plan.positions), plan.torques, plan.options
    results = watch.time("contact_s", loaded_contact, *run)
    costs = {
        "dof": dof,
        "flank_nodes": sum(len(body.compliance.loaded_tooth) for body in bodies),
        **watch.seconds,
        "total_s": sum(watch.seconds.values()),
        "contact_s_per_position_and_load": watch.seconds["contact_s"] / len(results),
        "memory_gb": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 / 1e9,
    }
    return summary(results).assign(level=level.name, element=plan.element, **costs)


def growth(
    design: PairDesign,
    level: Level,
    materials: tuple[Material, Material],
    positions: Sequence[int],
    loads: Sequence[int],
) -> pd.DataFrame:
    """Measure the time of contact against the number of positions (at 4 torques) and of torques (at 16
    positions).

    Parameters
    ----------
    design : PairDesign
        The pair.
    level : Level
        The level.
    materials : tuple[Material, Material]
        Materials of pinion and gear.
    positions : Sequence[int]
        Numbers of positions.
    loads : Sequence[int]
        Numbers of torques.

    Returns
    -------
    DataFrame
        Columns varied, positions, loads and contact_s.
    """
    model = contact_model(design, *compliances(design, level, materials))
    low, high = min(level.plan.torques), max(level.plan.torques)
    loaded_contact(model, [0.3], level.plan.torques, level.plan.options)
    cases = [("positions", n, 4) for n in positions] + [("loads", 16, n) for n in loads]
    rows = []
    for quantity, count, number in cases:
        watch = Stopwatch()
        torques = np.geomspace(high, low, number)[::-1]
        watch.time("contact_s", loaded_contact, model, even_positions(count), torques, level.plan.options)
        rows.append((quantity, count, number, watch.seconds["contact_s"]))
    return pd.DataFrame(rows, columns=["varied", "positions", "loads", "contact_s"])


def summary(results: Sequence[LoadedPosition]) -> pd.DataFrame:
    """Fit mean and first harmonic of average and local stiffness, one row a torque.

    Parameters
    ----------
    results : Sequence[LoadedPosition]
        Results at evenly spaced positions.

    Returns
    -------
    DataFrame
        Columns torque_n_m and stiffnesses, N/m.
    """
    rows = []
    for torque in sorted({result.torque for result in results}):
        of_torque = [result for result in results if result.torque == torque]
        average, local = (
            fit_harmonics(np.array([getattr(result, name) for result in of_torque])).series
            for name in ("k_average", "k_local")
        )
        rows.append((torque, average.mean, average.amplitudes[1], local.mean, local.amplitudes[1]))
    names = ["mean_n_per_m", "amplitude_1_n_per_m", "local_mean_n_per_m", "local_amplitude_1_n_per_m"]
    return pd.DataFrame(rows, columns=["torque_n_m", *names])


def with_errors(table: pd.DataFrame, reference: str) -> pd.DataFrame:
    """Add the errors of mean and first harmonic of both stiffnesses (`local_*` the local one).

    Parameters
    ----------
    table : DataFrame
        Table of `summary` with a column level.
    reference : str
        Name of the reference level.

    Returns
    -------
    DataFrame
        The table with errors in percent of the reference level's values at the same torque.
    """
    finest = table[table["level"] == reference].set_index("torque_n_m")
    result = table.copy()
    for name in ("mean", "amplitude_1", "local_mean", "local_amplitude_1"):
        column = f"{name}_n_per_m"
        result[f"{name}_error_percent"] = 100 * (table[column] / table["torque_n_m"].map(finest[column]) - 1)
    return result


def cheapest(table: pd.DataFrame) -> str:
    """Return the quickest level of a table with errors that is within LIMITS at all torques.

    Parameters
    ----------
    table : DataFrame
        Table of `with_errors` with a column total_s.

    Returns
    -------
    str
        Name of the level.

    Raises
    ------
    NotConverged
        If there is none.
    """
    columns = [f"{name}_error_percent" for name in LIMITS]
    inside = (table[columns].abs() <= list(LIMITS.values())).all(axis=1)
    whole = inside.groupby(table["level"]).all()
    if not whole.any():
        raise NotConverged("contact", "all refinement levels", "errors of mean and first harmonic")
    times = table.groupby("level")["total_s"].first()
    return str(times[whole[whole].index].idxmin())


def shortcuts(design: PairDesign, base: Level, materials: tuple[Material, Material]) -> pd.DataFrame:
    """Measure the effect of each shortcut on mean and first harmonic against the full model.

    Parameters
    ----------
    design : PairDesign
        The pair.
    base : Level
        Level of the full model.
    materials : tuple[Material, Material]
        Materials of pinion and gear.

    Returns
    -------
    DataFrame
        Table with errors in percent and a column case.
    """
    plan = base.plan
    plain, few = ContactOptions(), Refinement()
    cases = {"full model": base}
    sectors: tuple[tuple[int, CutFaces], ...] = ((5, "free"), (9, "free"), (13, "free"), (5, "clamped"))
    for teeth, ends in sectors:
        sector = Sector(teeth, teeth, ends)
        cases[f"{teeth}-tooth sectors, {ends} cut faces"] = replace(base, plan=replace(plan, sector=sector))
    for name, options in (
        ("no coupling between neighbours", replace(plain, is_coupled=False)),
        ("no fillet contact", replace(plain, fillet=False)),
        ("no loads on tip edges", replace(plain, edges=False)),
        ("contact on the pitch section's path only", replace(plain, path_only=True)),
    ):
        cases[name] = replace(base, plan=replace(plan, options=options))
    cases["contact strip not resolved"] = replace(base, plan=replace(plan, refinement=few))
    cases["8-node hexahedra"] = replace(base, plan=replace(plan, element="hex8"))
    cases["4-node tetrahedra"] = replace(base, plan=replace(plan, element="tet4"))
    rows, full = [], compliances(design, base, materials)
    for name, level in cases.items():
        same_bodies = replace(level.plan, options=plan.options) == plan
        bodies = full if same_bodies else compliances(design, level, materials)
        model = contact_model(design, *bodies)
        results = loaded_contact(model, even_positions(plan.positions), plan.torques, level.plan.options)
        rows.append(summary(results).assign(case=name))
    table = pd.concat(rows, ignore_index=True)
    return with_errors(table.rename(columns={"case": "level"}), "full model").rename(
        columns={"level": "case"}
    )
