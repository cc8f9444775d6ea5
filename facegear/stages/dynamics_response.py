"""Response at one speed: time history, spectrum, statistics, multipliers, forces on the bearings."""

from dataclasses import replace

from facegear.config.dynamics import SECOND_LOOKS, Accuracy, settings
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
from facegear.transmission.machine import Machine


def dynamics_response(
    machine: Machine,
    accuracy: Accuracy,
    speed_rpm: float,
) -> Outcome:
    """Compute the response at one speed.

    Parameters
    ----------
    machine : Machine
        The machine.
    accuracy : Accuracy
        Section `dynamics.accuracy` of the config.
    speed_rpm : float
        Speed of the pinions, rpm.

    Returns
    -------
    Outcome
        Tables `response`, `spectrum`, `summary`, `multipliers` and `bearings`.

    Raises
    ------
    NotConverged
        Naming the speed.
    """
    model = build_model(machine)
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
