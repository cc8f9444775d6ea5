"""Gear ratio, speeds, torques and powers of the machine at its nominal speed."""

import pandas as pd

from facegear.arrays import Arrays
from facegear.config.machine_layout import ToothNumbers
from facegear.config.machines import wired_machine
from facegear.config.transmission import Transmission
from facegear.stages.outcome import Outcome
from facegear.transmission.ratings import body_table, mesh_table, number_table, rated


def ratings(
    harmonics: pd.DataFrame,
    transmission: Transmission,
    teeth: ToothNumbers,
    speed_rpm: float,
    law: Arrays | None = None,
    poses: Arrays | None = None,
    bodies: Arrays | None = None,
) -> Outcome:
    """`ratings`, `bodies` and `meshes` (tables). Raises NotConverged."""
    machine = wired_machine(transmission, teeth, harmonics, law=law, poses=poses, bodies=bodies)
    rating = rated(machine, speed_rpm)
    content = {
        "ratings": number_table(rating),
        "bodies": body_table(machine, speed_rpm),
        "meshes": mesh_table(machine, speed_rpm),
    }
    summary = f"ratio {rating.ratio:.4f}, mesh frequency {rating.mesh_frequency:.1f} Hz"
    return Outcome(
        content, f"{summary}, {1e-3 * rating.power_in:.4g} kW in, {1e-3 * rating.power_out:.4g} kW out"
    )
