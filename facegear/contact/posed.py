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
    """Drive flanks in one assembly: tables and arrays as stage contact has them.

    reactions: as `touching_reactions` has them.
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
    """The contact of the drive flanks of pinion and face gear in each assembly.

    Raises NotConverged naming position and torque.
    """
    model = contact_model(design, *flanks)
    for errors in assemblies:
        yield _solved(model.assembled(errors), errors, materials, plan)


def met_contacts(
    design: PairDesign,
    materials: tuple[Material, Material],
    flanks: tuple[GearFlank, GearFlank],
    plan: ContactPlan,
    met: Sequence[tuple[PairDesign, tuple[float, ...]]],
) -> Iterator[PosedContact]:
    """The contact of pairs of the design's bodies, each at its own torques (N m).

    Raises NotConverged naming position and torque.
    """
    model = contact_model(design, *flanks)
    for other, torques in met:
        yield _solved(model.of(other), other.assembly, materials, replace(plan, torques=torques))


def _solved(
    model: ContactModel, errors: AssemblyErrors, materials: tuple[Material, Material], plan: ContactPlan
) -> PosedContact:
    results = loaded_contact(model, even_positions(plan.positions), plan.torques, plan.options)
    pressures = flank_pressure(results, model.flanks, materials)
    table = ltca_table(results, pressures)
    arrays = pressure_arrays(results, model.flanks.pinion, pressures)
    loads = load_arrays([results], ONE_FLANK)
    reactions = touching_reactions(model.flanks.pinion, results)
    return PosedContact(errors, table, by_torque(table, arrays), arrays, loads, reactions)
