"""Contact over pose at default accuracy: minutes of work, stored beside this file.

`python -m validation.poses.measure` renews `concentric_surface.npz`, the surface of stage pose_surface for
config/concentric.yaml, and `loaded.csv`, contact at 550 N m solved directly in three assemblies.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd

import facegear
from facegear.config.contact import contact_plan
from facegear.config.tooth_pair import pair
from facegear.contact.gear_flank import from_arrays
from facegear.contact.posed import posed_contacts
from facegear.geometry.bodies import BODIES
from facegear.geometry.design import AssemblyErrors
from facegear.stages.pose_surface import quantities

HERE = Path(__file__).parent
SURFACE, LOADED = HERE / "concentric_surface.npz", HERE / "loaded.csv"
TORQUE = 550.0
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


def store_loaded(flanks) -> None:  # type: ignore[no-untyped-def]
    """Contact in ASSEMBLIES with the flanks of both bodies."""
    config = facegear.load("config/concentric.yaml", results=None).config
    teeth, plan = pair(config.tooth_pair), replace(contact_plan(config.contact), torques=(TORQUE,))
    rows = []
    posed = posed_contacts(teeth.design, teeth.materials, flanks, plan, list(ASSEMBLIES.values()))
    for name, contact in zip(ASSEMBLIES, posed, strict=True):
        known = {key: float(value[0]) for key, value in quantities(teeth.design, flanks, contact).items()}
        rows.append({"assembly": name, **known, "ste_mean_m": 1e-6 * contact.ltca["ste_um"].mean()})
    pd.DataFrame(rows).to_csv(LOADED, index=False)


if __name__ == "__main__":
    main()
