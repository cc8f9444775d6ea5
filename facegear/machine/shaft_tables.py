"""Loads of the bearings of pinions' shafts, from the forces and moments of the pinions on their shafts."""

from collections.abc import Mapping
from string import ascii_uppercase

import numpy as np
import pandas as pd
import scipy.linalg

from facegear.arrays import Array
from facegear.bearings.shaft import RollingShaft
from facegear.machine.casing_coordinates import casing_motion
from facegear.machine.drive_line import DriveLine, Seat, TurningMass
from facegear.machine.machine import Machine
from facegear.machine.rolling_equilibria import ShaftLoads
from facegear.machine.statics import Equilibria, bearing_forces, bearing_loads
from facegear.machine.supports import seats_at
from facegear.parts.shafts import Shaft, deflections
from facegear.rigid_body import MOTIONS


def bearing_names(line: DriveLine) -> list[tuple[int, str]]:
    """Return pinion and letter of every bearing of a shaft, by pinions.

    Parameters
    ----------
    line : DriveLine
        The drive line.

    Returns
    -------
    list of tuple of int and str
        Number of the pinion, and letter; A is the first bearing that the config lists.
    """
    return [
        (pinion, ascii_uppercase[number])
        for pinion, seat in sorted(line.seats.items())
        for number in range(len(seat.shaft.reactions))
    ]


def shaft_bearing_loads(
    line: DriveLine,
    forces: Array,
    moments: Mapping[int, Array] | None = None,
    shafts: Mapping[int, ShaftLoads] | None = None,
    strains: Array | None = None,
) -> Array:
    """Return the loads of the shafts on their bearings, from the balance of each elastic shaft.

    Rolling bearings carry what `shafts` says, else what their tangent gives.

    Parameters
    ----------
    line : DriveLine
        The drive line.
    forces : (K, bodies, 3) array
        Forces of the bodies on what they sit on, along x, y, z, N.
    moments : mapping of int to (K, 2) array, or None
        Moments of pinions on their shafts about x and y by the numbers of pinions, N m; 0 for those left
        out.
    shafts : mapping of int to ShaftLoads, or None
        Shafts on rolling bearings at the same K equilibria by the numbers of pinions.
    strains : (K, bearings, 5) array or None
        Loads from seats that strain a shaft, as `ring_strains` returns them; None for seats that stand still.

    Returns
    -------
    (K, bearings, 5) array
        x, y, z, tilt_x, tilt_y in N and N m, in the order of `bearing_names`.
    """
    loads, first = [np.zeros((len(forces), 0, 5))], 0
    for pinion, seat in sorted(line.seats.items()):
        last = first + len(seat.shaft.reactions)
        if shafts is not None and pinion in shafts:
            loads.append(shafts[pinion].forces)
        else:
            about = (moments or {}).get(pinion, np.zeros((len(forces), 2)))
            load = seat.bearing_loads(np.concatenate([forces[:, pinion], about], axis=1))
            loads.append(load if strains is None else load + strains[:, first:last])
        first = last
    return np.concatenate(loads, axis=1)


def ring_strains(machine: Machine, displacements: Array) -> Array | None:
    """Return the loads of shafts on their bearings that come from the motions of seats against each other.

    Parameters
    ----------
    machine : Machine
        The machine.
    displacements : (K, n) array
        Displacements of all of its coordinates, m and rad.

    Returns
    -------
    (K, bearings, 5) array or None
        N and N m, in the order of `bearing_names`; None for a machine without casing or shafts.
    """
    casing, line = machine.casing, machine.drive_line
    if casing is None or line is None:
        return None
    motion = casing_motion(machine.linear, displacements)
    strains, first = casing.strain_loads(line, motion), 0
    for pinion, seat in sorted(line.seats.items()):
        last = first + len(seat.shaft.reactions)
        if seat.rolling is not None and any(casing.bearing_seats.get(pinion, ())):
            strains[:, first:last] = _rolling_strains(seat, motion @ casing.ring_motions(pinion).T)
        first = last
    return strains


def _rolling_strains(seat: Seat, seats: Array) -> Array:
    """Return the loads (K, bearings, 5) of a shaft on rolling bearings by motions (K, 5 bearings) of its
    seats, the pinion free and both counted from where the shaft is linearised.
    """
    shaft, state = seat.rolling, seat.state
    assert shaft is not None and state is not None
    across = state.stiffness[MOTIONS:, :MOTIONS]
    strain = state.stiffness[MOTIONS:, MOTIONS:] + seat.shaft.reactions.reshape(-1, MOTIONS) @ across.T
    loads = (seats_at(shaft, state) - seats) @ strain.T
    return np.asarray(loads.reshape(len(seats), -1, MOTIONS))


def tilting_moments(machine: Machine, at_rest: Equilibria) -> dict[int, Array]:
    """Return the moments by which meshes tilt pinions on their shafts.

    Parameters
    ----------
    machine : Machine
        The machine.
    at_rest : Equilibria
        Its equilibria at K positions.

    Returns
    -------
    dict of int to (K, 2) array
        Moments about x and y by the numbers of the pinions that tilt, N m; empty where meshes tilt no
        pinion.
    """
    line = machine.drive_line
    if line is None or not line.is_tilted_by_meshes:
        return {}
    loads = bearing_loads(machine.linear_without_rolling, at_rest.displacements, at_rest.on_shafts)
    return {pinion: loads[:, line.tilts(pinion)] for pinion in line.tilting}


def _pinion_loads(machine: Machine, at_rest: Equilibria, pinion: int) -> Array:
    """Return force and moment (5,) of a pinion on its shaft at the first equilibrium, N and N m."""
    moments = tilting_moments(machine, at_rest).get(pinion, np.zeros((1, 2)))
    return np.append(bearing_forces(machine, at_rest)[0, pinion], moments[0])


MOTION_NAMES = ("x", "y", "z", "tilt_x", "tilt_y")
"""Names of the five motions of a shaft at its pinion."""
STATIONS = 25
"""Even stations from end to end at which a deflected shaft is listed, beside steps, bearings and pinion."""


def stiffness_table(line: DriveLine) -> pd.DataFrame:
    """Return the stiffness of the pinions' shafts.

    Parameters
    ----------
    line : DriveLine
        The drive line.

    Returns
    -------
    pd.DataFrame
        Five rows a pinion with a shaft: columns pinion, motion, then its stiffness by MOTION_NAMES.
    """
    rows = [
        (line.layout.pinions[pinion].name, motion, *row)
        for pinion, seat in sorted(line.seats.items())
        for motion, row in zip(MOTION_NAMES, seat.shaft.stiffness, strict=True)
    ]
    return pd.DataFrame(rows, columns=["pinion", "motion", *MOTION_NAMES])


def seat_table(machine: Machine, line: DriveLine, at_rest: Equilibria) -> pd.DataFrame:
    """Return stiffness and static displacement of each pinion on a shaft.

    Parameters
    ----------
    machine : Machine
        The machine.
    line : DriveLine
        Its drive line.
    at_rest : Equilibria
        Equilibrium under the mean torques.

    Returns
    -------
    pd.DataFrame
        One row a pinion with a shaft: stiffness without moments along x, y, z, N/m, and displacement under
        the mean torques: x_um, y_um, z_um, tilt_x_urad, tilt_y_urad.
    """
    rows = []
    for pinion, seat in sorted(line.seats.items()):
        square = 1.0 / np.diagonal(seat.shaft.compliance)[:3]
        displacement = seat.shaft.compliance @ _pinion_loads(machine, at_rest, pinion)
        if pinion in at_rest.shafts:
            displacement = at_rest.shafts[pinion].pinion[0]
        elif machine.casing is not None:
            motion = casing_motion(machine.linear, at_rest.displacements[0])
            displacement = displacement + machine.casing.base_motions(pinion) @ motion
        rows.append((line.layout.pinions[pinion].name, *square, *(1e6 * displacement)))
    stiffness = [f"stiffness_{axis}_n_per_m" for axis in "xyz"]
    return pd.DataFrame(
        rows, columns=["pinion", *stiffness, "x_um", "y_um", "z_um", "tilt_x_urad", "tilt_y_urad"]
    )


def deflection_table(
    machine: Machine, line: DriveLine, at_rest: Equilibria, shafts: Mapping[int, Shaft | RollingShaft]
) -> pd.DataFrame:
    """Return the deflection along each shaft under the mean torques, on a casing against its seats.

    Parameters
    ----------
    machine : Machine
        The machine.
    line : DriveLine
        Its drive line.
    at_rest : Equilibria
        Equilibrium under the mean torques.
    shafts : Mapping of int to Shaft or RollingShaft
        Shafts by the numbers of their pinions.

    Returns
    -------
    pd.DataFrame
        Rows along each shaft: pinion, at_mm from its beginning, x_um and y_um.
    """
    rows = []
    for pinion, shaft in sorted(shafts.items()):
        at = _stations(shaft)
        if isinstance(shaft, RollingShaft):
            loads = at_rest.shafts[pinion]
            displacements = shaft.deflections(loads.pinion[0], loads.forces[0], at)[:, :2]
        else:
            displacements = deflections(shaft, at)[:, :2] @ _pinion_loads(machine, at_rest, pinion)
        name = line.layout.pinions[pinion].name
        rows += [(name, *row) for row in np.column_stack([1e3 * at, 1e6 * displacements]).tolist()]
    return pd.DataFrame(rows, columns=["pinion", "at_mm", "x_um", "y_um"])


def _stations(shaft: Shaft | RollingShaft) -> Array:
    """Return rising positions along a shaft, m from its beginning, at which its deflection is listed:
    STATIONS even ones, ends of segments, bearings and the pinion's middle, each once.
    """
    ends = np.cumsum([segment.length for segment in shaft.segments])
    bearings = shaft.bearings if isinstance(shaft, Shaft) else shaft.supports
    bearing_positions = [bearing.position for bearing in bearings]
    return np.unique(
        np.round([*np.linspace(0.0, ends[-1], STATIONS), *ends, *bearing_positions, shaft.pinion], 9)
    )


def load_table(machine: Machine, line: DriveLine, at_rest: Equilibria) -> pd.DataFrame:
    """Return the load of each shaft on its bearings under the mean torques.

    Parameters
    ----------
    machine : Machine
        The machine.
    line : DriveLine
        Its drive line.
    at_rest : Equilibria
        Equilibrium under the mean torques.

    Returns
    -------
    pd.DataFrame
        One row a bearing: pinion, bearing, x_n, y_n, z_n, tilt_x_n_m, tilt_y_n_m, radial_n.
    """
    forces, moments = bearing_forces(machine, at_rest), tilting_moments(machine, at_rest)
    strains = ring_strains(machine, at_rest.displacements)
    loads = shaft_bearing_loads(line, forces, moments, at_rest.shafts, strains)[0]
    rows = [
        (line.layout.pinions[pinion].name, letter, *load, np.hypot(*load[:2]))
        for (pinion, letter), load in zip(bearing_names(line), loads, strict=True)
    ]
    columns = ("pinion", "bearing", "x_n", "y_n", "z_n", "tilt_x_n_m", "tilt_y_n_m", "radial_n")
    return pd.DataFrame(rows, columns=list(columns))


def torsion_table(machine: Machine, line: DriveLine) -> pd.DataFrame:
    """Return torque and twist of the torsional springs under the mean torques.

    Parameters
    ----------
    machine : Machine
        The machine.
    line : DriveLine
        Its drive line.

    Returns
    -------
    pd.DataFrame
        One row a turning mass: body, mass, inertia_kg_m2, stiffness_n_m_per_rad, torque_n_m of its spring
        (that of the body), twist_deg of that spring, windup_deg of it and of all springs before it, and
        frequency_hz of the body with its chain alone: the k-th frequency in the row of mass k.
    """
    rows = []
    for body, _, chain in line.chains():
        torque, windup = float(machine.torques[body]), 0.0
        for mass, frequency in zip(chain, chain_frequencies(line, body, chain), strict=True):
            twist = float(np.degrees(torque / mass.stiffness))
            windup += twist
            name = line.layout.body_names[body]
            rows.append((name, mass.name, mass.inertia, mass.stiffness, torque, twist, windup, frequency))
    columns = ("inertia_kg_m2", "stiffness_n_m_per_rad", "torque_n_m", "twist_deg", "windup_deg")
    return pd.DataFrame(rows, columns=["body", "mass", *columns, "frequency_hz"])


def chain_frequencies(line: DriveLine, body: int, chain: tuple[TurningMass, ...]) -> Array:
    """Return the natural frequencies of a body and its chain of turning masses, free of all meshes and
    bearings.

    The zero frequency of their common rotation is left out.

    Parameters
    ----------
    line : DriveLine
        The drive line.
    body : int
        Number of the body in the layout.
    chain : tuple of TurningMass
        Turning masses of the chain, from the body outwards.

    Returns
    -------
    (masses,) array
        Hz, rising.
    """
    inertias = np.array([line.layout.bodies[body].inertia, *(mass.inertia for mass in chain)])
    stiffness = np.zeros((inertias.size, inertias.size))
    for number, mass in enumerate(chain):
        stiffness[number : number + 2, number : number + 2] += mass.stiffness * np.array([[1, -1], [-1, 1]])
    omega_squared = scipy.linalg.eigh(stiffness, np.diag(inertias), eigvals_only=True)
    return np.asarray(np.sqrt(omega_squared[1:]) / (2.0 * np.pi))
