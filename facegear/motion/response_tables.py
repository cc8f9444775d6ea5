"""Tables of the response at one speed."""

import numpy as np
import pandas as pd

from facegear.machine.flank_errors import flank_lags
from facegear.machine.layout import Layout
from facegear.machine.machine import Machine
from facegear.motion.between_samples import located_extremes
from facegear.motion.integrator.kernel_system import TAU
from facegear.motion.steady_state.response import SteadyState
from facegear.motion.steady_state.simulate import Model
from facegear.motion.steady_state.statistics import MAX_ORDER, spectrum
from facegear.motion.sweeps.sweep import collect
from facegear.motion.sweeps.sweep_tables import UM, sweep_table

SHOWN_PERIODS = 32
"""Largest number of mesh periods in the table of the response."""


def response_table(layout: Layout, response: SteadyState) -> pd.DataFrame:
    """Tabulate the mesh deflections and forces over at most SHOWN_PERIODS mesh periods.

    Parameters
    ----------
    layout : Layout
        Names of the meshes.
    response : SteadyState
        Response.

    Returns
    -------
    DataFrame
        Columns mesh_cycle, time_s, mesh (name), deflection_um, elastic_force_n; all instants of the first
        mesh, then of the next.
    """
    count = min(response.periods, SHOWN_PERIODS) * response.per_period
    cycles = response.phases[:count]
    frames = [
        pd.DataFrame(
            {
                "mesh_cycle": cycles,
                "time_s": cycles * TAU / response.frequency,
                "mesh": name,
                "deflection_um": UM * response.deflections[:count, m],
                "elastic_force_n": response.forces[:count, m],
            }
        )
        for m, name in enumerate(layout.mesh_names)
    ]
    return pd.concat(frames, ignore_index=True)


def shows_a_period(response: pd.DataFrame, summary: pd.DataFrame) -> bool:
    """Whether the history in the table of the response at one speed is one period of a periodic motion.

    Parameters
    ----------
    response : DataFrame
        Table of response_table().
    summary : DataFrame
        Table beside it, whose column `class` names the motion.

    Returns
    -------
    bool
        False where the motion is not periodic or the history is cut.
    """
    cycles = int(response["mesh_cycle"].max()) + 1
    return bool((summary["class"] == f"period-{cycles}").any())


def losses_in_motion(machine: Machine, response: pd.DataFrame, speed_rpm: float) -> dict[str, float]:
    """Compute the mean friction loss of each mesh over the table: pinion speed * base radius * mean
    friction force.

    Parameters
    ----------
    machine : Machine
        Machine with friction.
    response : DataFrame
        Table of response_table().
    speed_rpm : float
        Pinion speed, rpm.

    Returns
    -------
    dict
        Loss of each mesh by name, W.

    Raises
    ------
    ValueError
        If the machine has no friction.
    """
    layout, friction = machine.layout, machine.friction
    if friction is None:
        raise ValueError("a machine with friction is needed")
    forces = response["elastic_force_n"].to_numpy().reshape(len(layout.meshes), -1).T
    cycles = response["mesh_cycle"].to_numpy()[: len(forces)]
    lags = flank_lags(machine, machine.phases)
    mean_losses = friction.loss(lags, cycles, forces).mean(axis=0)
    return dict(zip(layout.mesh_names, speed_rpm * TAU / 60.0 * layout.pinion_arm * mean_losses, strict=True))


def spectrum_table(layout: Layout, response: SteadyState) -> pd.DataFrame:
    """Tabulate the amplitude spectra of the mesh deflections over the whole response.

    Parameters
    ----------
    layout : Layout
        Names of the meshes.
    response : SteadyState
        Response.

    Returns
    -------
    DataFrame
        Columns mesh, order (multiple of the mesh frequency), frequency_hz, amplitude_um.
    """
    orders, lines = spectrum(response.deflections, response.per_period, response.period > 0)
    is_shown = orders <= MAX_ORDER
    frames = [
        pd.DataFrame(
            {
                "mesh": name,
                "order": orders[is_shown],
                "frequency_hz": orders[is_shown] * response.frequency / TAU,
                "amplitude_um": UM * lines[is_shown, m],
            }
        )
        for m, name in enumerate(layout.mesh_names)
    ]
    return pd.concat(frames, ignore_index=True)


def summary_of_response(model: Model, speed_rpm: float, response: SteadyState) -> pd.DataFrame:
    """Tabulate the numbers that a sweep stores, at one speed.

    Parameters
    ----------
    model : Model
        Reduced machine.
    speed_rpm : float
        Pinion speed, rpm.
    response : SteadyState
        Response.

    Returns
    -------
    DataFrame
        Columns of sweep_table() without `direction` and `after_irregular`.
    """
    table = sweep_table(model.machine.layout, "none", collect(model, iter([(speed_rpm, response)])))
    return table.drop(columns=["direction", "after_irregular"])


def multiplier_table(response: SteadyState) -> pd.DataFrame:
    """Tabulate the Floquet multipliers.

    Parameters
    ----------
    response : SteadyState
        Response.

    Returns
    -------
    DataFrame
        Columns real, imaginary, magnitude; empty where the motion is not periodic.
    """
    values = np.zeros(0, dtype=complex) if response.multipliers is None else response.multipliers
    return pd.DataFrame({"real": values.real, "imaginary": values.imag, "magnitude": np.abs(values)})


LAW_LOAD_COLUMNS = (
    *("last_level_n", "smallest_n", "mean_n", "largest_n", "past_fraction"),
    *("sweep_largest_n", "sweep_past_fraction"),
)
"""Columns of law_loads_table() after mesh and flank."""


def law_loads_table(
    levels: pd.DataFrame, response: pd.DataFrame, summary: pd.DataFrame, sweep: pd.DataFrame
) -> pd.DataFrame:
    """Tabulate where the forces of each mesh lie in the table of its law.

    Parameters
    ----------
    levels : DataFrame
        Table of stage mesh_law, in which one gear alone is the upper.
    response, summary : DataFrame
        Tables of stage dynamics_response.
    sweep : DataFrame
        Table of stage dynamics_sweep.

    Returns
    -------
    DataFrame
        One row a mesh: mesh, flank, and LAW_LOAD_COLUMNS.

        - last_level_n: mean force at the last level of the table of the flank that carries the load
        - smallest_n, mean_n, largest_n: elastic force at the nominal speed, counted on that flank; extremes
          are located between the samples
        - past_fraction: largest fraction of the samples past the last level there
        - sweep_largest_n, sweep_past_fraction: the largest of both over the sweep
    """
    last = levels.groupby(["gear", "flank"])["force_n"].max()
    sides = {name.rpartition("/")[2] for name in response["mesh"]}
    rows, whole = [], shows_a_period(response, summary)
    for mesh, forces in response.groupby("mesh", sort=False)["elastic_force_n"]:
        sign = 1.0 if forces.mean() >= 0.0 else -1.0
        side = str(mesh).rpartition("/")[2] if len(sides) > 1 else "upper"
        flank = "drive" if sign > 0.0 else "back"
        flank_forces = sign * forces
        extremes = located_extremes(flank_forces.to_numpy()[:, None], whole)
        smallest, largest = (float(extreme[0]) for extreme in extremes)
        rows.append(
            (
                mesh,
                flank,
                last[side, flank],
                *(smallest, flank_forces.mean(), largest),
                _largest(summary, "past_law_fraction", mesh),
                _largest(sweep, "largest_elastic_force_n", mesh),
                _largest(sweep, "past_law_fraction", mesh),
            )
        )
    return pd.DataFrame(rows, columns=["mesh", "flank", *LAW_LOAD_COLUMNS])


def _largest(table: pd.DataFrame, quantity: str, mesh: object) -> float:
    """Return the largest `value` of a quantity of a mesh (`body_or_mesh`) in a table like sweep_table(),
    0 where there is none.
    """
    values = table.loc[(table["quantity"] == quantity) & (table["body_or_mesh"] == mesh), "value"]
    return float(values.max()) if len(values) else 0.0
