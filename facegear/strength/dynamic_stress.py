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
    positions: Mapping[str, Array],
    base_radius: float,
    contacts: Mapping[str, Mapping[str, FlankContact]],
) -> pd.DataFrame:
    """Tabulate the stress of each mesh under its forces.

    `mean`: largest over the passage with the mesh's mean force, on the flank that carries more; `running`:
    largest of the history, every tooth with its share of the force of that moment (a tooth is quasi-static);
    `bound`: with the largest force of each flank all through the passage.

    Parameters
    ----------
    forces : Mapping[str, array]
        Forces along the line of action by mesh, (n,) N, negative on the back flank, evenly in time.
    positions : Mapping[str, array]
        Positions of the loaded flank in the mesh cycle by mesh, (n,), in pitches, in [0, 1).
    base_radius : float
        Base radius of the pinion, m.
    contacts : Mapping[str, Mapping[str, FlankContact]]
        Contacts by mesh and flank.

    Returns
    -------
    DataFrame
        One row a mesh, columns as DYNAMIC_STRESS_COLUMNS.
    """
    rows = [_row(mesh, force, positions[mesh], base_radius, contacts[mesh]) for mesh, force in forces.items()]
    return pd.DataFrame(rows, columns=list(DYNAMIC_STRESS_COLUMNS))


def _row(
    mesh: str, force: Array, positions: Array, base_radius: float, contacts: Mapping[str, FlankContact]
) -> tuple[str | float | bool, ...]:
    mean, max_force = float(np.abs(force).mean()), float(np.abs(force).max())
    by_flank = {"drive": np.maximum(force, 0.0), "back": np.maximum(-force, 0.0)}
    loaded_flanks = {flank: part for flank, part in by_flank.items() if part.any()} or {
        "drive": by_flank["drive"]
    }
    steady = contacts[max(loaded_flanks, key=lambda flank: float(loaded_flanks[flank].mean()))]
    max_torque = {flank: base_radius * float(part.max()) for flank, part in loaded_flanks.items()}
    stresses: list[float] = []
    for body in BODIES:
        running = (
            contacts[at].history[body](base_radius * part, positions) for at, part in loaded_flanks.items()
        )
        bounds = (contacts[at].history[body].over_passage(torque) for at, torque in max_torque.items())
        largest = max(float(values.max()) for values in running)
        stresses += [steady.tension[body](base_radius * mean), largest, max(bounds)]
    stresses.append(steady.pressure.at(base_radius * mean))
    stresses.append(largest_pressure((contacts[at], torque) for at, torque in max_torque.items()))
    within = steady.is_solved(base_radius * mean) and steady.is_solved(base_radius * max_force)
    factor = max_force / mean if mean > 0.0 else np.nan
    return (mesh, mean, max_force, factor, *(1e-6 * stress for stress in stresses), within)
