"""Root stress under the mesh forces of a running machine."""

from collections.abc import Mapping

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.geometry.bodies import BODIES
from facegear.strength.columns import DYNAMIC_STRESS_COLUMNS
from facegear.strength.flank_contacts import FlankContact, largest_pressure


def dynamic_stress_table(
    forces: Mapping[str, Array],
    places: Mapping[str, Array],
    base_radius: float,
    contacts: Mapping[str, Mapping[str, FlankContact]],
) -> pd.DataFrame:
    """One row a mesh, columns as DYNAMIC_STRESS_COLUMNS.

    forces (n,) N along the line of action by mesh, negative on the back flank, evenly in time; places (n,) of
    the loaded flank in the mesh cycle, in [0, 1); base_radius (m) of the pinion; contacts by mesh and flank.
    `mean`: largest over the passage with the mesh's mean force, on the flank that carries more; `running`:
    largest of the history, every tooth with its share of the force of that moment (a tooth is quasi-static);
    `bound`: with the largest force of each flank all through the passage.
    """
    rows = [_row(mesh, force, places[mesh], base_radius, contacts[mesh]) for mesh, force in forces.items()]
    return pd.DataFrame(rows, columns=list(DYNAMIC_STRESS_COLUMNS))


def _row(
    mesh: str, force: Array, places: Array, base_radius: float, contacts: Mapping[str, FlankContact]
) -> tuple[str | float | bool, ...]:
    mean, max_force = float(np.abs(force).mean()), float(np.abs(force).max())
    by_flank = {"drive": np.maximum(force, 0.0), "back": np.maximum(-force, 0.0)}
    loaded = {flank: part for flank, part in by_flank.items() if part.any()} or {"drive": by_flank["drive"]}
    steady = contacts[max(loaded, key=lambda flank: float(loaded[flank].mean()))]
    max_torque = {flank: base_radius * float(part.max()) for flank, part in loaded.items()}
    stresses: list[float] = []
    for body in BODIES:
        running = (contacts[at].history[body](base_radius * part, places) for at, part in loaded.items())
        bounds = (contacts[at].history[body].over_passage(torque) for at, torque in max_torque.items())
        largest = max(float(values.max()) for values in running)
        stresses += [steady.tension[body](base_radius * mean), largest, max(bounds)]
    stresses.append(steady.pressure.at(base_radius * mean))
    stresses.append(largest_pressure((contacts[at], torque) for at, torque in max_torque.items()))
    within = steady.solved(base_radius * mean) and steady.solved(base_radius * max_force)
    factor = max_force / mean if mean > 0.0 else np.nan
    return (mesh, mean, max_force, factor, *(1e-6 * stress for stress in stresses), within)
