"""Vibration of the machine at the orders of its gears' turns."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from facegear.stages.outcome import Outcome
from facegear.ties import first_largest, first_largest_row
from facegear.transmission.machine import Machine, mesh_frequency
from facegear.transmission.shaft_orders import (
    LoadedMachine,
    TurnOrders,
    loaded_machine,
    mesh_amplitudes,
    turn_orders,
)

SPEEDS = 61
"""Number of speeds at which the largest orders are followed."""
ORDERS_PER_GEAR = 4
"""Number of orders of each gear with the largest errors, and as many about the mesh frequency."""
COLUMNS = (
    *("turning", "order", "of_mesh", "frequency_hz", "mesh"),
    *("error_um", "force_n", "force_at_rest_n"),
)
EXCITED = (
    *("speed_rpm", "body", "order", "of_mesh", "frequency_hz", "part"),
    *("force_n", "torque_n_m"),
)
OVER_SPEED = ("speed_rpm", "turning", "order", "of_mesh", "frequency_hz", "mesh", "force_n")


def shaft_orders(
    machine: Machine,
    speed_rpm: float,
    first_rpm: float,
    last_rpm: float,
) -> Outcome:
    """Compute the vibration of the machine at the orders of its gears' turns.

    Parameters
    ----------
    machine : Machine
        The machine.
    speed_rpm : float
        Nominal speed of the pinions, rpm.
    first_rpm : float
        First speed of `over_speed` and `excited`, rpm.
    last_rpm : float
        Last speed of `over_speed` and `excited`, rpm.

    Returns
    -------
    Outcome
        Table `orders` at the nominal speed. Table `over_speed`: the mesh with the largest force of each of
        the largest orders. Table `excited`: amplitudes of mesh forces and of torques of springs under each
        periodic torque, at the nominal speed and over speed.

    Raises
    ------
    NotConverged
        Where the static load does not converge.
    """
    layout, names = machine.layout, machine.layout.mesh_names
    orders, machine_under_load = turn_orders(machine), loaded_machine(machine)

    def amplitudes(selection: TurnOrders, speed: float) -> np.ndarray:
        return mesh_amplitudes(
            machine_under_load.forces(selection, speed, layout.pinion_teeth), machine_under_load.contact_mask
        )

    running, still = (
        amplitudes(orders, speed_rpm),
        mesh_amplitudes(machine_under_load.at_rest(orders), machine_under_load.contact_mask),
    )
    error = 1e6 * mesh_amplitudes(orders.error, machine_under_load.contact_mask)
    nominal = mesh_frequency(layout, speed_rpm)
    rows = [
        (*_key(orders, row, nominal), name, error[row, mesh], running[row, mesh], still[row, mesh])
        for row in range(orders.order.size)
        for mesh, name in enumerate(names)
    ]
    largest, over_speed = orders.select(_largest(orders)), []
    for speed in np.linspace(first_rpm, last_rpm, SPEEDS).tolist():
        for row, forces in enumerate(amplitudes(largest, speed)):
            key = _key(largest, row, mesh_frequency(layout, speed))
            over_speed.append((speed, *key, names[first_largest(forces)], float(forces.max())))
    table = pd.DataFrame(rows, columns=list(COLUMNS))
    excited = _excited(
        machine, machine_under_load, [speed_rpm, *np.linspace(first_rpm, last_rpm, SPEEDS).tolist()]
    )
    content = {
        "orders": table,
        "over_speed": pd.DataFrame(over_speed, columns=list(OVER_SPEED)),
        "excited": excited,
    }
    return Outcome(content, _summary(table, speed_rpm))


def _excited(machine: Machine, model: LoadedMachine, speeds: Sequence[float]) -> pd.DataFrame:
    """Amplitudes at each speed: forces of meshes, torques of torsional springs by the mass behind them."""
    layout, line = machine.layout, machine.drive_line
    springs = [] if line is None else line.springs()
    rows: list[tuple[object, ...]] = []
    for speed in speeds:
        for excitation in machine.excitations:
            frequency = excitation.of_mesh * mesh_frequency(layout, speed)
            name = layout.body_names[excitation.body]
            key = (speed, name, excitation.order, excitation.of_mesh, frequency)
            motion = model.excited_motion(machine, excitation, speed)
            forces = mesh_amplitudes(model.flank_forces(motion), model.contact_mask)
            rows += [(*key, *row, np.nan) for row in zip(layout.mesh_names, forces.tolist(), strict=True)]
            for spring in springs:
                twist = motion[spring.second] - motion[spring.first]
                dynamic = spring.stiffness + 2j * np.pi * frequency * spring.damping
                label = machine.linear.labels[spring.second]
                rows.append((*key, label, np.nan, float(abs(dynamic * twist))))
    return pd.DataFrame(rows, columns=list(EXCITED))


def _key(orders: TurnOrders, row: int, frequency: float) -> tuple[str, int, float, float]:
    of_mesh = float(orders.of_mesh[row])
    return orders.turning[row], int(orders.order[row]), of_mesh, of_mesh * frequency


def _largest(orders: TurnOrders) -> list[int]:
    """Rows of each gear's largest errors: low orders of its turn, and orders about the mesh frequency."""
    size, rows = np.abs(orders.error).max(axis=1), []
    about = np.abs(orders.of_mesh - 1.0) < 0.5
    for gear in dict.fromkeys(orders.turning):
        is_of_gear = np.array([name == gear for name in orders.turning])
        for part in (is_of_gear & ~about, is_of_gear & about):
            part_rows = np.flatnonzero(part)
            rows += sorted(part_rows[np.argsort(-size[part_rows], kind="stable")][:ORDERS_PER_GEAR].tolist())
    return rows


def _summary(table: pd.DataFrame, speed_rpm: float) -> str:
    if table.empty:
        return "nothing differs from tooth to tooth"
    row = first_largest_row(table, "force_n")
    gear = row["turning"].replace("_", " ")
    return (
        f"{row['mesh']}: {row['force_n']:.0f} N at order {row['order']} of a turn of the {gear} "
        f"({row['frequency_hz']:.0f} Hz) at {speed_rpm:g} rpm, {row['force_at_rest_n']:.0f} N turned slowly"
    )
