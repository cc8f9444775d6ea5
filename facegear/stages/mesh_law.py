"""The load-dependent mesh law: contact at many torques, from light touch to the largest, as a table."""

import numpy as np
import pandas as pd

from facegear.arrays import Arrays
from facegear.config.contact import Contact, contact_plan
from facegear.config.stiffness import MeshStiffness, stiffness_request
from facegear.config.tooth_pair import ToothPair, pair
from facegear.contact.gear_flank import from_arrays
from facegear.contact.ltca import ContactModel, even_positions, loaded_contact
from facegear.contact.options import ContactOptions
from facegear.contact.pair import contact_model
from facegear.contact.position import LoadedPosition
from facegear.errors import FacegearError
from facegear.geometry.flank_errors import distinct_pairs
from facegear.number_format import count_noun
from facegear.stages.outcome import Outcome
from facegear.stiffness.curve import load_table
from facegear.stiffness.load_dependent import (
    FlankContacts,
    fitted_tables,
    law_arrays,
    law_torques,
    level_table,
)
from facegear.stiffness.request import StiffnessRequest

DEFAULT = ContactOptions()


def mesh_law(
    pinion: Arrays,
    face_gear: Arrays,
    ltca: pd.DataFrame,
    tooth_pair: ToothPair,
    contact: Contact,
    mesh_stiffness: MeshStiffness,
) -> Outcome:
    """`law` (arrays) and `levels` (table) of every flank that errors part from the others.

    ltca: table of stage contact, which says what source fem_scaled scales by. Raises NotConverged naming
    position and torque, FacegearError where teeth interfere.
    """
    plan = contact_plan(contact)
    request = stiffness_request(mesh_stiffness)
    design = pair(tooth_pair).design
    model = contact_model(design, from_arrays(pinion), from_arrays(face_gear))
    different, numbers = distinct_pairs(design)
    scale = _scale(ltca, request)
    largest = plan.torques[-1] / scale
    solved = [flank_contacts(model.of(other), plan.positions, largest, plan.options) for other in different]
    tables, errors = fitted_tables(solved, request.order)
    tables = [table.scale(scale) for table in tables]
    levels = level_table(tables, errors, numbers, design.pinion_base_radius)
    rms, largest = (100.0 * max(getattr(error, name) for error in errors) for name in ("rms", "largest"))
    summary = (
        f"{count_noun(tables[0].levels.size - 1, 'level')} up to {1e6 * tables[0].levels[-1]:.3g} um, "
        f"{tables[0].forces.shape[2] - 1} orders, times {scale:.4f}; against contact between the levels "
        f"{rms:.2g} % rms, {largest:.2g} % at most of the largest mean force"
    )
    return Outcome({"law": law_arrays(tables, numbers), "levels": levels}, summary)


def flank_contacts(
    model: ContactModel, positions: int, largest: float, options: ContactOptions = DEFAULT
) -> FlankContacts:
    """Contact of a flank at so many even positions of a pitch, for a law up to the largest torque (N m).

    Raises NotConverged naming position and torque, FacegearError where teeth interfere.
    """
    torques = law_torques(largest)
    contacts = loaded_contact(model, even_positions(positions), torques, options)
    if any(np.isnan(contact.k_average) for contact in contacts):
        raise FacegearError("mesh law: there is none, as the teeth interfere")

    def by_torque(values: list[float]) -> np.ndarray:
        return np.array(values).reshape(positions, len(torques)).T

    def approach(contact: LoadedPosition) -> float:
        return contact.ste - contact.unloaded

    return FlankContacts(
        np.array(torques) / model.design.pinion_base_radius,
        by_torque([approach(contact) for contact in contacts]),
        by_torque([contact.k_local for contact in contacts]),
    )


def _scale(ltca: pd.DataFrame, request: StiffnessRequest) -> float:
    """What source fem_scaled multiplies forces and slopes by: as stage stiffness multiplies k."""
    if request.source != "fem_scaled":
        return 1.0
    assert request.mean is not None
    assert request.torque is not None
    return request.mean / float(load_table(ltca).at(request.torque, request.definition).mean())
