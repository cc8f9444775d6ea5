"""Stage of the rolling bearings: loads, stiffness and life of each under every bin of the duty cycle."""

from dataclasses import replace

import numpy as np
import pandas as pd

from facegear.bearings.life import Lubrication
from facegear.build.machine import MachineInputs, with_torques
from facegear.build.placed_bearings import placed_bearings, require_loads
from facegear.errors import ConfigError, InvalidInput
from facegear.machine.static_gears import at_rest
from facegear.machine.statics import Equilibria, mean_equilibrium
from facegear.number_format import count_noun, format_number
from facegear.pipeline.outcome import Outcome
from facegear.report.bearings import largest_change
from facegear.schema.strength import Strength
from facegear.schema.transmission import Transmission
from facegear.strength.bearing_rating import (
    CURVE_COLUMNS,
    MEAN,
    WHOLE,
    RatedLoad,
    curve_rows,
    life_table,
    load_table,
    stiffness_table,
)

FRACTIONS = np.linspace(0.1, 1.5, 15)
"""Torques over those of the machine at which bearings are followed, as far as contact was solved,
dimensionless."""


def bearing_life(inputs: MachineInputs, speed_rpm: float, strength: Strength | None) -> Outcome:
    """Compute loads, stiffness and life of the rolling bearings.

    Loads are those of the machine at rest under the torque of each bin, times K_A. Without a duty cycle the
    machine's own torques at its nominal speed are the only bin.

    Parameters
    ----------
    inputs : MachineInputs
        Everything that a machine is built from; the torque is set bin by bin.
    speed_rpm : float
        Nominal speed of the pinions, rpm.
    strength : Strength or None
        Section `strength` of the config, None if it has none.

    Returns
    -------
    Outcome
        Tables `loads`, `stiffness`, `life` and `over_torque`, with the columns of
        `facegear.strength.bearing_rating`.

    Raises
    ------
    ConfigError
        Without rolling bearings, and for overloaded ones.
    NotConverged
        Where an equilibrium does not converge.
    """
    bearings = placed_bearings(inputs.transmission)
    if not bearings:
        raise ConfigError("transmission.shafts", {}, "given with rolling bearings")

    def equilibrium(case: MachineInputs, torque: float) -> Equilibria:
        """Return the equilibrium of a machine, each of its bearings within its limits."""
        at = mean_equilibrium(at_rest(case.build()))
        require_loads(bearings, at, torque)
        return at

    torque = _mesh_torque(inputs.transmission)
    mean = RatedLoad(MEAN, torque, speed_rpm, 1.0, equilibrium(inputs, torque))
    bins = []
    for number, load in enumerate(() if strength is None else strength.duty, start=1):
        rated_torque = load.torque_n_m * (1.0 if strength is None else strength.application_factor)
        at = equilibrium(inputs.at_torque(rated_torque, load.speed_rpm), rated_torque)
        bins.append(RatedLoad(str(number), rated_torque, load.speed_rpm, load.hours, at))
    section = None if strength is None else strength.bearings
    lubrication = None
    if section is not None and section.contamination_factor is not None:
        assert section.viscosity_ratio is not None
        # The fatigue load limit is each bearing's own.
        lubrication = Lubrication(section.contamination_factor, section.viscosity_ratio, 1.0)
    loads = [mean, *bins]
    required_hours = None if section is None else section.required_hours
    rows: list[tuple[object, ...]] = []
    for fraction in FRACTIONS.tolist():
        scaled_transmission = Transmission.of_config(
            with_torques(inputs.transmission.model_dump(mode="json"), fraction)
        )
        try:
            at = mean_equilibrium(at_rest(replace(inputs, transmission=scaled_transmission).build()))
        except (ConfigError, InvalidInput):
            if fraction <= 1.0:
                raise
            break  # beyond the torques of the mesh law or of the poses
        rows += curve_rows(bearings, fraction, fraction * torque, at)
    content = {
        "loads": load_table(bearings, loads),
        "stiffness": stiffness_table(bearings, loads),
        "life": life_table(bearings, bins or [mean], lubrication, required_hours),
        "over_torque": pd.DataFrame(rows, columns=list(CURVE_COLUMNS)),
    }
    return Outcome(content, _summary(content))


def _mesh_torque(section: Transmission) -> float:
    """Return the torque of an input pinion by each of its meshes, N m."""
    return abs(section.torque.per_input_n_m) / len(section.face_gears)


def _summary(content: dict[str, pd.DataFrame]) -> str:
    """Say in one line which bearing lives shortest, what all do together, and how stiffness changes."""
    life = content["life"]
    whole = life[life["bin"] == WHOLE]
    single, together = whole.iloc[:-1], whole.iloc[-1]
    shortest = single.iloc[int(single["l10r_hours"].to_numpy(float).argmin())]
    text = (
        f"{count_noun(len(single), 'rolling bearing')}, L10r {format_number(shortest['l10r_hours'])} h "
        f"(bearing {shortest['bearing']} of {shortest['pinion']}), all together "
        f"{format_number(together['l10r_hours'])} h"
    )
    if (change := largest_change(content["stiffness"])) > 0.0:
        text += f"; stiffness changes by up to {100 * change:.3g} % over the duty cycle"
    return text
