"""Contact of one pair in many assemblies, on the same compliances of both bodies."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd

from facegear.arrays import AnyArray
from facegear.contact.gear_flank import GearFlank
from facegear.contact.ltca import ContactModel, even_positions, loaded_contact
from facegear.contact.nodal_loads import load_arrays
from facegear.contact.options import ContactPlan
from facegear.contact.pair import contact_model
from facegear.contact.pressure import flank_pressure
from facegear.contact.reactions import touching_reactions
from facegear.contact.summary import by_torque
from facegear.contact.tables import ltca_table, pressure_arrays
from facegear.geometry.design import AssemblyErrors, Material, PairDesign

ONE_FLANK = np.zeros((2, 2), dtype=int)


@dataclass(frozen=True, eq=False)
class PosedContact:
    """Drive flanks in one assembly: tables and arrays as stage contact stores them.

    reactions: as returned by `touching_reactions`.
    """

    errors: AssemblyErrors
    ltca: pd.DataFrame
    by_torque: pd.DataFrame
    pressure: dict[str, AnyArray]
    loads: dict[str, AnyArray]
    reactions: pd.DataFrame


def posed_contacts(
    design: PairDesign,
    materials: tuple[Material, Material],
    flanks: tuple[GearFlank, GearFlank],
    plan: ContactPlan,
    assemblies: Sequence[AssemblyErrors],
) -> Iterator[PosedContact]:
    """Solve the contact of the drive flanks of pinion and face gear in each assembly.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    materials : tuple[Material, Material]
        Pinion and face gear.
    flanks : tuple[GearFlank, GearFlank]
        Surfaces and compliances of pinion and face gear.
    plan : ContactPlan
        Torques, positions and options.
    assemblies : Sequence[AssemblyErrors]
        Errors of each assembly.

    Yields
    ------
    PosedContact
        Contact in each assembly.

    Raises
    ------
    NotConverged
        Names position and torque.
    """
    model = contact_model(design, *flanks)
    for errors in assemblies:
        yield _solve_assembly(model.with_assembly(errors), errors, materials, plan)


def met_contacts(
    design: PairDesign,
    materials: tuple[Material, Material],
    flanks: tuple[GearFlank, GearFlank],
    plan: ContactPlan,
    pair_torques: Sequence[tuple[PairDesign, tuple[float, ...]]],
) -> Iterator[PosedContact]:
    """Solve the contact of pairs of the design's bodies, each at its own torques.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    materials : tuple[Material, Material]
        Pinion and face gear.
    flanks : tuple[GearFlank, GearFlank]
        Surfaces and compliances of pinion and face gear.
    plan : ContactPlan
        Positions and options.
    pair_torques : Sequence[tuple[PairDesign, tuple[float, ...]]]
        Pairs of the same bodies, and torques of each, N m.

    Yields
    ------
    PosedContact
        Contact of each pair.

    Raises
    ------
    NotConverged
        Names position and torque.
    """
    model = contact_model(design, *flanks)
    for pair_design, torques in pair_torques:
        yield _solve_assembly(
            model.of(pair_design), pair_design.assembly, materials, replace(plan, torques=torques)
        )


def _solve_assembly(
    model: ContactModel, errors: AssemblyErrors, materials: tuple[Material, Material], plan: ContactPlan
) -> PosedContact:
    results = loaded_contact(model, even_positions(plan.positions), plan.torques, plan.options)
    pressures = flank_pressure(results, model.flanks, materials)
    table = ltca_table(results, pressures)
    arrays = pressure_arrays(results, model.flanks.pinion, pressures)
    loads = load_arrays([results], ONE_FLANK)
    reactions = touching_reactions(model.flanks.pinion, results)
    return PosedContact(errors, table, by_torque(table, arrays), arrays, loads, reactions)
