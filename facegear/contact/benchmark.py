"""Speed against error of the contact chain, and what each shortcut does to the stiffness."""

import resource
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd

from facegear.contact.compliance import FlankCompliance
from facegear.contact.layer import tied_system
from facegear.contact.ltca import LoadedPosition, analyse, even_positions
from facegear.contact.options import ContactOptions, ContactPlan, Refinement, Sector
from facegear.contact.pair import BUILDERS, body_compliance, contact_model
from facegear.contact.rungs import CUTS, LINEAR, SECTORS
from facegear.contact.teeth import piece_of
from facegear.geometry.design import Material, PairDesign
from facegear.harmonics.fit import fit_harmonics
from facegear.mesh.sizes import MeshSizes, named_sizes


@dataclass(frozen=True)
class Rung:
    """A resolution to be measured: name, mesh sizes and what the plan says."""

    name: str
    sizes: MeshSizes
    plan: ContactPlan


def rung(name: str, design: PairDesign, plan: ContactPlan) -> Rung:
    """A rung of the ladder with the positions and torques of `plan`. Raises KeyError for an unknown name."""
    resolution, cuts = CUTS["coarse_4x1x2" if name in SECTORS or name in LINEAR else name]
    changed = replace(plan, refinement=cuts, sector=Sector(), element="hex27")
    if name in SECTORS:
        changed = replace(changed, sector=Sector(SECTORS[name], SECTORS[name], "free"))
    if name in LINEAR:
        changed = replace(changed, element=LINEAR[name])
    return Rung(name, named_sizes(resolution, design.module), changed)


def compliances(
    design: PairDesign, rung: Rung, materials: tuple[Material, Material]
) -> tuple[FlankCompliance, FlankCompliance]:
    """Both bodies of a rung."""
    pinion, gear = (
        body_compliance(design, body, rung.sizes, material, rung.plan)
        for body, material in zip(BUILDERS, materials, strict=True)
    )
    return pinion, gear


def measure(design: PairDesign, rung: Rung, materials: tuple[Material, Material]) -> pd.DataFrame:
    """One row a torque: free dof, times (s), memory (GB), mean and first harmonic of both stiffnesses (N/m).

    The memory is the process's largest so far, so that rungs should be measured in processes of their own.
    """
    dof, assembly = 0, 0.0
    for body, material in zip(BUILDERS, materials, strict=True):
        piece, _ = piece_of(design, BUILDERS[body](design, rung.sizes), material)
        start = time.perf_counter()
        system = tied_system(piece, rung.plan.refinement, rung.plan.element)
        assembly += time.perf_counter() - start
        dof += int(np.count_nonzero(~system.held))
    start = time.perf_counter()
    bodies = compliances(design, rung, materials)
    compliance = time.perf_counter() - start
    model = contact_model(design, rung.sizes, *bodies)
    start = time.perf_counter()
    results = analyse(model, even_positions(rung.plan.positions), rung.plan.torques, rung.plan.options)
    contact = time.perf_counter() - start
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 / 1e9
    costs = {
        "dof": dof,
        "flank_nodes": sum(len(body.own) for body in bodies),
        "assembly_s": assembly,
        "compliance_s": compliance,
        "contact_s": contact,
        "contact_s_per_position_and_load": contact / len(results),
        "memory_gb": memory,
    }
    return summary(results).assign(rung=rung.name, element=rung.plan.element, **costs)


def summary(results: Sequence[LoadedPosition]) -> pd.DataFrame:
    """Mean and first harmonic (N/m) of average and local stiffness, one row a torque."""
    rows = []
    for torque in sorted({result.torque for result in results}):
        chosen = [result for result in results if result.torque == torque]
        average, local = (
            fit_harmonics(np.array([getattr(result, name) for result in chosen])).series
            for name in ("k_average", "k_local")
        )
        rows.append((torque, average.mean, average.amplitudes[1], local.mean, local.amplitudes[1]))
    names = ["mean_n_per_m", "amplitude_1_n_per_m", "local_mean_n_per_m", "local_amplitude_1_n_per_m"]
    return pd.DataFrame(rows, columns=["torque_n_m", *names])


def with_errors(table: pd.DataFrame, reference: str) -> pd.DataFrame:
    """Add the errors of mean and first harmonic, in percent of the reference rung's at the same torque."""
    finest = table[table["rung"] == reference].set_index("torque_n_m")
    result = table.copy()
    for name in ("mean", "amplitude_1"):
        column = f"{name}_n_per_m"
        result[f"{name}_error_percent"] = 100 * (table[column] / table["torque_n_m"].map(finest[column]) - 1)
    return result


def shortcuts(design: PairDesign, base: Rung, materials: tuple[Material, Material]) -> pd.DataFrame:
    """Effect (percent) of each shortcut on mean and first harmonic against the full model at `base`."""
    plan = base.plan
    plain, few = ContactOptions(), Refinement()
    cases = {"full model": base}
    for teeth, ends in ((3, "free"), (5, "free"), (9, "free"), (13, "free"), (5, "clamped")):
        sector = Sector(teeth, teeth, ends)
        cases[f"{teeth}-tooth sectors, {ends} cut faces"] = replace(base, plan=replace(plan, sector=sector))
    for name, options in (
        ("no coupling between neighbours", replace(plain, coupled=False)),
        ("no fillet contact", replace(plain, fillet=False)),
        ("no loads on tip edges", replace(plain, edges=False)),
    ):
        cases[name] = replace(base, plan=replace(plan, options=options))
    cases["contact strip not resolved"] = replace(base, plan=replace(plan, refinement=few))
    cases["8-node hexahedra"] = replace(base, plan=replace(plan, element="hex8"))
    cases["4-node tetrahedra"] = replace(base, plan=replace(plan, element="tet4"))
    rows, full = [], compliances(design, base, materials)
    for name, rung in cases.items():
        same_bodies = replace(rung.plan, options=plan.options) == plan
        bodies = full if same_bodies else compliances(design, rung, materials)
        model = contact_model(design, rung.sizes, *bodies)
        results = analyse(model, even_positions(plan.positions), plan.torques, rung.plan.options)
        rows.append(summary(results).assign(case=name))
    table = pd.concat(rows, ignore_index=True)
    return with_errors(table.rename(columns={"case": "rung"}), "full model").rename(columns={"rung": "case"})
