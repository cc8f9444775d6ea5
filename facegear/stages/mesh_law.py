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
    """Compute the load-dependent mesh law of every flank that errors make differ from the others.

    Parameters
    ----------
    pinion : Arrays
        Compliance of the pinion's flank, arrays of stage compliance.
    face_gear : Arrays
        Compliance of the face gear's flank, arrays of stage compliance.
    ltca : pd.DataFrame
        Table of stage contact, which decides by how much source fem_scaled scales.
    tooth_pair : ToothPair
        Section `tooth_pair` of the config.
    contact : Contact
        Section `contact` of the config.
    mesh_stiffness : MeshStiffness
        Section `mesh_stiffness` of the config.

    Returns
    -------
    Outcome
        Arrays `law` and table `levels`.

    Raises
    ------
    NotConverged
        Naming position and torque.
    FacegearError
        Where teeth interfere.
    """
    plan = contact_plan(contact)
    request = stiffness_request(mesh_stiffness)
    design = pair(tooth_pair).design
    model = contact_model(design, from_arrays(pinion), from_arrays(face_gear))
    different, numbers = distinct_pairs(design)
    scale = _scale(ltca, request)
    largest = plan.torques[-1] / scale
    contacts = [
        flank_contacts(model.of(variant), plan.positions, largest, plan.options) for variant in different
    ]
    tables, errors = fitted_tables(contacts, request.order)
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
    """Solve the contact of a flank over a pitch, for a law up to the largest torque.

    Parameters
    ----------
    model : ContactModel
        Contact model of the flank.
    positions : int
        Number of even positions of a pitch.
    largest : float
        Largest torque of the law, N m.
    options : ContactOptions
        Options of the contact solver.

    Returns
    -------
    FlankContacts
        Forces (torques,) in N, approach in m and local stiffness in N/m (torques, positions).

    Raises
    ------
    NotConverged
        Naming position and torque.
    FacegearError
        Where teeth interfere.
    """
    torques = law_torques(largest)
    contacts = loaded_contact(model, even_positions(positions), torques, options)
    if any(np.isnan(contact.k_average) for contact in contacts):
        raise FacegearError("mesh law: there is none, as the teeth interfere")

    def by_torque(values: list[float]) -> np.ndarray:
        return np.array(values).reshape(positions, len(torques)).T

    def approach(contact: LoadedPosition) -> float:
        return contact.ste - contact.unloaded_error

    return FlankContacts(
        np.array(torques) / model.design.pinion_base_radius,
        by_torque([approach(contact) for contact in contacts]),
        by_torque([contact.k_local for contact in contacts]),
    )


def _scale(ltca: pd.DataFrame, request: StiffnessRequest) -> float:
    """Factor of source fem_scaled on forces and slopes, equal to the factor of stage stiffness on k."""
    if request.source != "fem_scaled":
        return 1.0
    assert request.mean is not None
    assert request.torque is not None
    return request.mean / float(load_table(ltca).at(request.torque, request.definition).mean())
