"""Load sharing of one machine at one speed."""

import pandas as pd

from facegear.arrays import Arrays
from facegear.config.dynamics import Accuracy, settings
from facegear.config.load_sharing import LoadSharing, sharing_options
from facegear.config.machine_layout import ToothNumbers, layout
from facegear.config.machines import wired_machine
from facegear.config.transmission import Transmission
from facegear.load_sharing.run import load_sharing as shared
from facegear.load_sharing.study_forces import force_table
from facegear.load_sharing.tables import curve_table, summary_table
from facegear.stages.outcome import Outcome


def load_sharing(
    harmonics: pd.DataFrame,
    transmission: Transmission,
    teeth: ToothNumbers,
    accuracy: Accuracy,
    speed_rpm: float,
    options: LoadSharing,
    friction: pd.DataFrame | None = None,
    law: Arrays | None = None,
    poses: Arrays | None = None,
    bodies: Arrays | None = None,
) -> Outcome:
    """`curve`, `summary` and `forces` (tables). Raises NotConverged naming the speed."""
    sharing = shared(
        wired_machine(transmission, teeth, harmonics, friction=friction, law=law, poses=poses, bodies=bodies),
        speed_rpm,
        settings(accuracy),
        sharing_options(options),
    )
    summary, response = summary_table(sharing), sharing.response
    forces = force_table(
        layout(transmission, teeth),
        response.mean_forces[1],
        response.largest_forces,
        response.label,
    )
    means = ", ".join(f"{row.group} {row.mean:.3f}" for row in summary.itertuples())
    return Outcome(
        {"curve": curve_table(sharing), "summary": summary, "forces": forces},
        f"{response.label}; mean coefficients: {means or 'no meshes share a load'}",
    )
