"""Response at one speed: time history, spectrum, statistics, multipliers, forces on the bearings."""

from dataclasses import replace

import pandas as pd

from facegear.arrays import Arrays
from facegear.config.dynamics import SECOND_LOOKS, Accuracy, settings
from facegear.config.machine_layout import ToothNumbers
from facegear.config.machines import wired_machine
from facegear.config.transmission import Transmission
from facegear.dynamics.bearing_forces import bearing_table
from facegear.dynamics.response_tables import (
    multiplier_table,
    response_table,
    spectrum_table,
    summary_of_response,
)
from facegear.dynamics.steady_state.simulate import build_model, simulate
from facegear.dynamics.sweeps.summary import response_summary
from facegear.stages.outcome import Outcome


def dynamics_response(
    harmonics: pd.DataFrame,
    transmission: Transmission,
    teeth: ToothNumbers,
    accuracy: Accuracy,
    speed_rpm: float,
    friction: pd.DataFrame | None = None,
    law: Arrays | None = None,
    poses: Arrays | None = None,
    bodies: Arrays | None = None,
) -> Outcome:
    """`response`, `spectrum`, `summary`, `multipliers` and `bearings` (tables).

    Raises NotConverged naming the speed.
    """
    model = build_model(
        wired_machine(transmission, teeth, harmonics, friction=friction, law=law, poses=poses, bodies=bodies)
    )
    response = simulate(model, speed_rpm, replace(settings(accuracy), second_looks=SECOND_LOOKS))
    layout = model.machine.layout
    content = {
        "response": response_table(layout, response),
        "spectrum": spectrum_table(layout, response),
        "summary": summary_of_response(model, speed_rpm, response),
        "multipliers": multiplier_table(response),
        "bearings": bearing_table(model, response),
    }
    return Outcome(content, response_summary(response))
