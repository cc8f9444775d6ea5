"""Loaded tooth contact at every position and torque."""

from collections.abc import Mapping
from typing import Any

from numpy.typing import NDArray

from facegear.config.base import parse
from facegear.config.contact import Contact, contact_plan
from facegear.config.tooth_pair import pair
from facegear.contact.gear_flank import GearFlank, from_arrays
from facegear.contact.ltca import even_positions, loaded_contact
from facegear.contact.nodal_loads import load_arrays
from facegear.contact.pair import contact_model
from facegear.contact.pressure import flank_pressure
from facegear.contact.summary import by_torque
from facegear.contact.tables import ltca_table, pressure_arrays
from facegear.stages.outcome import Outcome


def contact(
    pinion: Mapping[str, NDArray],
    face_gear: Mapping[str, NDArray],
    tooth_pair: Mapping[str, Any],
    contact: Mapping[str, Any],
) -> Outcome:
    """`ltca`, `by_torque` (tables), `pressure`, `loads` (arrays) from the flanks of stage compliance.

    Raises NotConverged naming position and torque.
    """
    return contact_of(from_arrays(pinion), from_arrays(face_gear), tooth_pair, contact)


def contact_of(
    pinion: GearFlank, face_gear: GearFlank, tooth_pair: Mapping[str, Any], contact: Mapping[str, Any]
) -> Outcome:
    """`contact` of flanks in memory."""
    plan = contact_plan(parse(Contact, contact))
    teeth = pair(tooth_pair)
    model = contact_model(teeth.design, pinion, face_gear)
    found = loaded_contact(model, even_positions(plan.positions), plan.torques, plan.options)
    pressed = flank_pressure(found, model.flanks, teeth.materials)
    table = ltca_table(found, pressed)
    worst, mean = table["kkt_residual"].max(), table["k_average_n_per_m"].mean()
    pressure = pressure_arrays(found, model.flanks.pinion, pressed)
    return Outcome(
        {
            "ltca": table,
            "by_torque": by_torque(table, pressure),
            "pressure": pressure,
            "loads": load_arrays(found),
        },
        f"{len(table)} contacts, mean stiffness {mean:.4g} N/m, worst KKT residual {worst:.0e}",
    )
