"""Contact over pose at default accuracy: minutes of work, stored beside this file.

`python -m validation.poses.measure` renews `concentric_surface.npz`, the surface of stage pose_surface for
config/concentric.yaml, and `loaded.csv`, contact at 550 N m solved directly in three assemblies. It also
renews what reactions are held against: `tilting_surface.npz`, the contact of the same pair with two errors of
the shaft angle, `touching.csv`, forces and moment of the touching loads in the assemblies, and `frozen.csv`,
derivatives of the contact energy with the loads held.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd

import facegear
from facegear.build.plans import contact_plan
from facegear.build.tooth_pair import pair
from facegear.contact.analysis import posed_contacts
from facegear.contact.gear_flank import contact_model, from_arrays
from facegear.machine.poses.surface import SURFACE_ARRAYS
from facegear.pipeline.stages.poses import pose_surface, quantities
from facegear.quantities import BODIES
from facegear.teeth.design import AssemblyErrors
from validation.poses.frozen_reactions import STEPS, frozen_reactions

FOLDER = Path(__file__).parent
SURFACE, LOADED_CONTACT = FOLDER / "concentric_surface.npz", FOLDER / "loaded.csv"
TILTING, TOUCHING_REACTIONS, FROZEN_REACTIONS = (
    FOLDER / "tilting_surface.npz",
    FOLDER / "touching.csv",
    FOLDER / "frozen.csv",
)
TORQUE = 550.0
"""Torque on the pinion, N m."""
TORQUES = (80.0, 420.0, TORQUE, 930.0)
ASSEMBLIES = {
    "nominal": AssemblyErrors(),
    "offset 120 um, shaft angle 0.03 deg": AssemblyErrors(120e-6, float(np.radians(0.03))),
    "offset -120 um": AssemblyErrors(-120e-6),
}


def main() -> None:
    """Solve and store both."""
    changes = {"transmission.operating_pose": "static", "contact.root_stress": True}
    chain = facegear.load("config/concentric.yaml", results=None).with_values(changes)._chain
    np.savez_compressed(SURFACE, **chain.part("pose_surface", "surface"))
    arrays = [chain.part("compliance", "arrays", {"body": body}) for body in BODIES]
    store_loaded((from_arrays(arrays[0]), from_arrays(arrays[1])))
    store_reactions(arrays)


def store_reactions(arrays) -> None:  # type: ignore[no-untyped-def]
    """Compute and store the references for the energy's derivatives.

    Parameters
    ----------
    arrays
        Arrays of both bodies.
    """
    config = facegear.load("config/concentric.yaml", results=None).config
    teeth, flanks = pair(config.tooth_pair), (from_arrays(arrays[0]), from_arrays(arrays[1]))
    plan = replace(contact_plan(config.contact), torques=TORQUES, root_stress=False)
    rows_frozen = []
    for torque in (420.0, 930.0):
        model = contact_model(teeth.design, *flanks)
        along, compliance_part = frozen_reactions(model, torque, plan.positions, plan.options)
        rows = zip(STEPS, along, compliance_part, strict=True)
        rows_frozen += [(torque, name, first, second) for name, first, second in rows]
    columns = ["torque_n_m", "error", "along_normals", "giving_way"]
    pd.DataFrame(rows_frozen, columns=columns).to_csv(FROZEN_REACTIONS, index=False)
    contacts = posed_contacts(teeth.design, teeth.materials, flanks, plan, list(ASSEMBLIES.values()))
    tables = [
        contact.reactions.assign(assembly=name) for name, contact in zip(ASSEMBLIES, contacts, strict=True)
    ]
    pd.concat(tables).to_csv(TOUCHING_REACTIONS, index=False)
    contact = config.contact.model_copy(update={"root_stress": False})
    outcome = pose_surface(arrays[0], arrays[1], config.tooth_pair, contact, 663.8, tilting=True)
    surface_arrays = {
        name: part for name, part in outcome.content["surface"].items() if name in SURFACE_ARRAYS
    }
    np.savez_compressed(TILTING, **surface_arrays)


def store_loaded(flanks) -> None:  # type: ignore[no-untyped-def]
    """Solve and store contact in ASSEMBLIES.

    Parameters
    ----------
    flanks
        Flanks of both bodies.
    """
    config = facegear.load("config/concentric.yaml", results=None).config
    teeth, plan = pair(config.tooth_pair), replace(contact_plan(config.contact), torques=(TORQUE,))
    rows = []
    contacts = posed_contacts(teeth.design, teeth.materials, flanks, plan, list(ASSEMBLIES.values()))
    for name, contact in zip(ASSEMBLIES, contacts, strict=True):
        values = {key: float(value[0]) for key, value in quantities(teeth.design, flanks, contact).items()}
        rows.append({"assembly": name, **values, "ste_mean_m": 1e-6 * contact.ltca["ste_um"].mean()})
    pd.DataFrame(rows).to_csv(LOADED_CONTACT, index=False)


if __name__ == "__main__":
    main()
