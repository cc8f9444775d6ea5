"""Tables of shafts and of turning masses behind torsional springs, with the machine at rest under load."""

from collections.abc import Mapping

import numpy as np
import pandas as pd
import scipy.linalg

from facegear.arrays import Array
from facegear.shafts.condensed import Shaft, deflections
from facegear.transmission.drive_line import DriveLine, TurningMass
from facegear.transmission.machine import Machine
from facegear.transmission.shaft_loads import bearing_names, shaft_bearing_loads
from facegear.transmission.statics import Equilibria, bearing_forces

MOTION_NAMES = ("x", "y", "z", "tilt_x", "tilt_y")
STATIONS = 25
"""Even stations from end to end at which a deflected shaft is listed, beside steps, bearings and pinion."""


def stiffness_table(line: DriveLine) -> pd.DataFrame:
    """Five rows a pinion with a shaft: columns pinion, motion, then its stiffness by MOTION_NAMES."""
    rows = [
        (line.layout.pinions[pinion].name, motion, *row)
        for pinion, seat in sorted(line.seats.items())
        for motion, row in zip(MOTION_NAMES, seat.shaft.stiffness, strict=True)
    ]
    return pd.DataFrame(rows, columns=["pinion", "motion", *MOTION_NAMES])


def seat_table(machine: Machine, line: DriveLine, at_rest: Equilibria) -> pd.DataFrame:
    """One row a pinion with a shaft: stiffness without moments along x, y, z, N/m, and where it stands under
    the mean torques: x_um, y_um, z_um, tilt_x_urad, tilt_y_urad.
    """
    forces = bearing_forces(machine, at_rest)[0]
    rows = []
    for pinion, seat in sorted(line.seats.items()):
        square = 1.0 / np.diagonal(seat.shaft.compliance)[:3]
        moved = seat.shaft.compliance[:, :3] @ forces[pinion]
        rows.append((line.layout.pinions[pinion].name, *square, *(1e6 * moved)))
    stiffness = [f"stiffness_{axis}_n_per_m" for axis in "xyz"]
    return pd.DataFrame(
        rows, columns=["pinion", *stiffness, "x_um", "y_um", "z_um", "tilt_x_urad", "tilt_y_urad"]
    )


def deflection_table(
    machine: Machine, line: DriveLine, at_rest: Equilibria, shafts: Mapping[int, Shaft]
) -> pd.DataFrame:
    """Rows along each shaft, by the number of its pinion: at_mm from its beginning, x_um and y_um under the
    mean torques.
    """
    forces = bearing_forces(machine, at_rest)[0]
    rows = []
    for pinion, shaft in sorted(shafts.items()):
        at = _stations(shaft)
        moved = deflections(shaft, at)[:, :2, :3] @ forces[pinion]
        name = line.layout.pinions[pinion].name
        rows += [(name, *row) for row in np.column_stack([1e3 * at, 1e6 * moved]).tolist()]
    return pd.DataFrame(rows, columns=["pinion", "at_mm", "x_um", "y_um"])


def _stations(shaft: Shaft) -> Array:
    ends = np.cumsum([segment.length for segment in shaft.segments])
    held = [bearing.position for bearing in shaft.bearings]
    return np.unique(np.round([*np.linspace(0.0, ends[-1], STATIONS), *ends, *held, shaft.pinion], 9))


def load_table(machine: Machine, line: DriveLine, at_rest: Equilibria) -> pd.DataFrame:
    """One row a bearing of a shaft: load of the shaft on it under the mean torques, N and N m."""
    loads = shaft_bearing_loads(line, bearing_forces(machine, at_rest))[0]
    rows = [
        (line.layout.pinions[pinion].name, letter, *load, np.hypot(*load[:2]))
        for (pinion, letter), load in zip(bearing_names(line), loads, strict=True)
    ]
    columns = ("pinion", "bearing", "x_n", "y_n", "z_n", "tilt_x_n_m", "tilt_y_n_m", "radial_n")
    return pd.DataFrame(rows, columns=list(columns))


def torsion_table(machine: Machine, line: DriveLine) -> pd.DataFrame:
    """One row a turning mass: inertia_kg_m2, stiffness_n_m_per_rad, torque_n_m of its spring, twist_deg of it
    and of all before it (windup_deg), and frequency_hz of the chain by itself, the body free.
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
    """Natural frequencies of a body and its chain in the open, without the zero, (masses,), Hz."""
    inertias = np.array([line.layout.bodies[body].inertia, *(mass.inertia for mass in chain)])
    stiffness = np.zeros((inertias.size, inertias.size))
    for number, mass in enumerate(chain):
        stiffness[number : number + 2, number : number + 2] += mass.stiffness * np.array([[1, -1], [-1, 1]])
    omega_squared = scipy.linalg.eigh(stiffness, np.diag(inertias), eigvals_only=True)
    return np.asarray(np.sqrt(omega_squared[1:]) / (2.0 * np.pi))
