"""Stages of the machine at rest: ratings, modes, shafts, and vibration at orders of its turns."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pandas as pd

from facegear.build.machine import MachineInputs
from facegear.build.machine_layout import stepped_shaft
from facegear.build.rolling import rolling_shaft
from facegear.errors import ConfigError
from facegear.harmonics import Harmonics
from facegear.machine.loaded_modes import contact_table, frequency_table, shape_table, vibrating_machine
from facegear.machine.machine import Machine, mesh_frequency
from facegear.machine.modes import name_modes
from facegear.machine.ratings import body_table, compute_ratings, mesh_table, number_table
from facegear.machine.shaft_orders import (
    LoadedMachine,
    TurnOrders,
    loaded_machine,
    mesh_amplitudes,
    turn_orders,
)
from facegear.machine.shaft_tables import (
    deflection_table,
    load_table,
    seat_table,
    stiffness_table,
    torsion_table,
)
from facegear.machine.static_gears import at_rest
from facegear.machine.statics import mean_equilibrium
from facegear.number_format import count_noun, format_number
from facegear.pipeline.outcome import Outcome
from facegear.ties import first_largest, first_largest_row


def ratings(
    machine: Machine,
    speed_rpm: float,
) -> Outcome:
    """Compute gear ratio, speeds, torques and powers of the machine at rest under its mean torques.

    Parameters
    ----------
    machine : Machine
        The machine.
    speed_rpm : float
        Nominal speed of the pinions, rpm.

    Returns
    -------
    Outcome
        Table `ratings` (quantity, value), `bodies` (torque, speed, power of each body, positive if
        brought in) and `meshes` (force along the line of action, N, negative on the back flank; torque
        on the pinion; power to the gear).

    Raises
    ------
    NotConverged
        Where the equilibrium does not converge.
    """
    rating = compute_ratings(machine, speed_rpm)
    content = {
        "ratings": number_table(rating),
        "bodies": body_table(machine, speed_rpm),
        "meshes": mesh_table(machine, speed_rpm),
    }
    summary = f"ratio {rating.ratio:.4f}, mesh frequency {rating.mesh_frequency:.1f} Hz"
    return Outcome(
        content, f"{summary}, {1e-3 * rating.power_in:.4g} kW in, {1e-3 * rating.power_out:.4g} kW out"
    )


def modal(
    inputs: MachineInputs,
    mean_stiffness: float | None,
    source: str,
    definition: str,
) -> Outcome:
    """Compute natural frequencies and mode shapes of the machine, linear, with constant mesh stiffness.

    The stiffness is that of stage stiffness, its mean by `definition` at the operating load, if
    inputs.harmonics is its table; otherwise it is `mean_stiffness`. With a load-dependent mesh law
    (inputs.law) every mesh has its local stiffness under its own mean load instead. The transmission
    error plays no part.

    Parameters
    ----------
    inputs : MachineInputs
        Everything that a machine is built from: its section, the teeth, and results of earlier stages.
    mean_stiffness : float or None
        Mean mesh stiffness of the config, N/m; None if it gives none. It is used where no harmonics are
        given.
    source : str
        Source of the mesh stiffness in the config, such as `harmonics` or `fem_scaled`; it decides only
        how the stiffness is named in column `definition` and in the summary.
    definition : str
        `local` (slope of force over approach) or `average` (force over approach).

    Returns
    -------
    Outcome
        Tables `frequencies` (a row a mode), `shapes` (a row a mode and coordinate) and `contacts` (a
        row a mesh or bearing with clearance). `ModesResult` lists their columns.

    Raises
    ------
    ConfigError
        Without any mean stiffness.
    """
    if isinstance(inputs.harmonics, pd.DataFrame):
        mean: float | None = float(inputs.harmonics[f"mean_{definition}_n_per_m"].iloc[0])
        source_text = definition
    else:
        mean = mean_stiffness
        source_text = f"{definition}, given" if source == "fem_scaled" else "given"
    if mean is None:
        raise ConfigError("mesh_stiffness.mean_n_per_m", None, "given where k(t) is not computed")
    constant, no_error = Harmonics(np.zeros(1), np.array([mean])), Harmonics(np.zeros(1), np.zeros(1))
    machine = replace(inputs, harmonics=constant, unloaded_error=no_error).build()
    vibration = vibrating_machine(machine)
    modes, contacts = vibration.modes, contact_table(machine, vibration, source_text)
    rigid = int((modes.frequencies == 0.0).sum())
    elastic = modes.frequencies[rigid:]
    content = {
        "frequencies": frequency_table(vibration, name_modes(machine.layout, machine.linear, modes)),
        "shapes": shape_table(machine.linear.labels, modes),
        "contacts": contacts,
    }
    stiffness_of_closed = contacts.loc[
        contacts["state"].isin(["drive", "back", "wedged"]), "stiffness_n_per_m"
    ]
    sizes = [mean] if inputs.law is None else [stiffness_of_closed.min(), stiffness_of_closed.max()]
    size = " to ".join(format_number(1e-6 * stiffness) for stiffness in sizes)
    summary = (
        f"{count_noun(rigid, 'rigid body mode')}, {elastic.size} elastic from {elastic[0]:.1f} to "
        f"{elastic[-1]:.1f} Hz, with a mesh stiffness of {size} N/um ({source_text})"
    )
    return Outcome(content, summary + _remarks(contacts, vibration.is_decided))


def _remarks(contacts: pd.DataFrame, is_decided: np.ndarray) -> str:
    """Return text for the summary on contacts that are open, wedged or undecided, and on frequencies
    that depend on undecided ones.

    `contacts` is the table of contacts with columns contact and state. `is_decided` (modes,) is False
    where a frequency differs between undecided contacts taken as open and as closed.
    """
    parts = []
    for state in ("open", "wedged", "undecided"):
        if names := contacts.loc[contacts["state"] == state, "contact"].to_list():
            parts.append(f"; {state}: {', '.join(names)}")
    if not is_decided.all():
        parts.append(f"; {int((~is_decided).sum())} frequencies hang on contacts that are undecided")
    return "".join(parts)


def shafts(
    inputs: MachineInputs,
) -> Outcome:
    """Compute load and deflection of shafts and the twist of torsional springs, with the machine at
    rest under its mean torques.

    Parameters
    ----------
    inputs : MachineInputs
        Everything that a machine is built from.

    Returns
    -------
    Outcome
        Tables `seats` (displacement and slope of each pinion's seat), `stiffness` (its 5 x 5
        stiffness), `bearings` (forces and moments), `deflections` (along each shaft) and `torsion`
        (twist and frequencies of turning masses). `ShaftsResult` lists their columns.

    Raises
    ------
    ConfigError
        Without shafts and torsion.
    NotConverged
        Where the equilibrium does not converge.
    """
    machine = inputs.build()
    if (line := machine.drive_line) is None:
        raise ConfigError("transmission.shafts", {}, "given, or transmission.torsion")
    machine_at_rest, section = at_rest(machine), inputs.transmission
    equilibrium = mean_equilibrium(machine_at_rest)
    shaft_sections = {i: section.shaft_of(pinion) for i, pinion in enumerate(section.pinions)}
    stepped = {
        i: rolling_shaft(shaft) if shaft.is_rolling else stepped_shaft(shaft)
        for i, shaft in shaft_sections.items()
        if shaft is not None
    }
    content = {
        "seats": seat_table(machine_at_rest, line, equilibrium),
        "stiffness": stiffness_table(line),
        "bearings": load_table(machine_at_rest, line, equilibrium),
        "deflections": deflection_table(machine_at_rest, line, equilibrium, stepped),
        "torsion": torsion_table(machine, line),
    }
    return Outcome(content, _summary(content))


def _summary(content: dict[str, pd.DataFrame]) -> str:
    """Say in one line what the tables of shafts and torsion hold at worst."""
    parts, seats, bearings, torsion = [], content["seats"], content["bearings"], content["torsion"]
    if len(seats):
        sagged = np.hypot(seats["x_um"], seats["y_um"])
        worst = first_largest_row(bearings, "radial_n")
        parts.append(
            f"shafts give way by up to {sagged.max():.4g} um ({seats['pinion'][int(sagged.argmax())]}), "
            f"{worst['radial_n']:.5g} N on bearing {worst['bearing']} of {worst['pinion']}"
        )
    for row in torsion.itertuples():
        parts.append(f"{row.mass} on {row.body}: {row.windup_deg:.4g} deg, {row.frequency_hz:.5g} Hz")
    return "; ".join(parts)


SPEEDS = 61
"""Number of speeds at which the largest orders are followed."""
ORDERS_PER_GEAR = 4
"""Number of orders of each gear with the largest errors, and as many about the mesh frequency."""
COLUMNS = (
    *("turning", "order", "of_mesh", "frequency_hz", "mesh"),
    *("error_um", "force_n", "force_at_rest_n"),
)
"""Columns of the orders of turns; errors in µm, forces in N."""
EXCITED = (
    *("speed_rpm", "body", "order", "of_mesh", "frequency_hz", "part"),
    *("force_n", "torque_n_m"),
)
"""Columns of the response to periodic torques; forces in N, torques in N m."""
OVER_SPEED = ("speed_rpm", "turning", "order", "of_mesh", "frequency_hz", "mesh", "force_n")
"""Columns of the orders of turns over speed."""


def shaft_orders(
    machine: Machine,
    speed_rpm: float,
    first_rpm: float,
    last_rpm: float,
) -> Outcome:
    """Compute the vibration of the machine at the orders of its gears' turns, and under its periodic
    torques.

    It is linear about the static load: contacts stay as they are there, and the mesh stiffness is its
    mean. Runouts, pitch deviations and single teeth excite it at multiples of a gear's speed of
    rotation.

    Parameters
    ----------
    machine : Machine
        The machine, with geometric meshes.
    speed_rpm : float
        Nominal speed of the pinions, rpm.
    first_rpm : float
        First speed of the pinions in `over_speed` and `excited`, rpm.
    last_rpm : float
        Last speed of the pinions in `over_speed` and `excited`, rpm; SPEEDS even speeds are taken.

    Returns
    -------
    Outcome
        Table `orders` (COLUMNS): a row an order and mesh at the nominal speed. Table `over_speed`
        (OVER_SPEED): at each speed, the mesh with the largest force at each of the orders with the
        largest errors. Table `excited` (EXCITED): amplitudes of mesh forces (N) and of torques of
        springs (N m) under each periodic torque, first at the nominal speed, then over speed.

    Raises
    ------
    NotConverged
        Where the static load does not converge.
    """
    layout, names = machine.layout, machine.layout.mesh_names
    orders, machine_under_load = turn_orders(machine), loaded_machine(machine)

    def amplitudes(selection: TurnOrders, speed: float) -> np.ndarray:
        """Return the force amplitude (orders, meshes), N, of the flank of each mesh that carries load,
        at a pinion speed (rpm).
        """
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
    return Outcome(content, _shaft_orders_summary(table, speed_rpm))


def _excited(machine: Machine, model: LoadedMachine, speeds: Sequence[float]) -> pd.DataFrame:
    """Tabulate the linear response to each periodic torque at each pinion speed (rpm); columns EXCITED.

    A row a speed, torque and mesh has the amplitude of the mesh force (N), torque_n_m being nan. A row
    a speed, torque and torsional spring has the amplitude of the spring's torque with its damping,
    abs(k + i omega c) times abs(twist) (N m), force_n being nan; `part` is then the mass behind the spring.
    """
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
    """Return gear, order, order as a multiple of the mesh frequency, and frequency (Hz), for one row of
    `orders`.

    `frequency` is the mesh frequency, Hz.
    """
    of_mesh = float(orders.of_mesh[row])
    return orders.turning[row], int(orders.order[row]), of_mesh, of_mesh * frequency


def _largest(orders: TurnOrders) -> list[int]:
    """Return the rows of `orders` that are followed over speed: for each gear the ORDERS_PER_GEAR with
    the largest errors.

    As many are taken among low orders as among those within half the mesh frequency of it. The error of
    an order is the largest of all flanks.
    """
    size, rows = np.abs(orders.error).max(axis=1), []
    about = np.abs(orders.of_mesh - 1.0) < 0.5
    for gear in dict.fromkeys(orders.turning):
        is_of_gear = np.array([name == gear for name in orders.turning])
        for part in (is_of_gear & ~about, is_of_gear & about):
            part_rows = np.flatnonzero(part)
            rows += sorted(part_rows[np.argsort(-size[part_rows], kind="stable")][:ORDERS_PER_GEAR].tolist())
    return rows


def _shaft_orders_summary(table: pd.DataFrame, speed_rpm: float) -> str:
    """Say in one line which order has the largest force at the nominal speed."""
    if table.empty:
        return "nothing differs from tooth to tooth"
    row = first_largest_row(table, "force_n")
    gear = row["turning"].replace("_", " ")
    return (
        f"{row['mesh']}: {row['force_n']:.0f} N at order {row['order']} of a turn of the {gear} "
        f"({row['frequency_hz']:.0f} Hz) at {speed_rpm:g} rpm, {row['force_at_rest_n']:.0f} N turned slowly"
    )
