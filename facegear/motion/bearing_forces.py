"""Forces on the bearings of every body: at rest, and over the response at one speed."""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
import pandas as pd

from facegear.arrays import Array, Integers, Mask
from facegear.machine.linear_model import LinearModel
from facegear.machine.machine import Machine
from facegear.machine.shaft_tables import bearing_names, ring_strains, shaft_bearing_loads, tilting_moments
from facegear.machine.static_gears import at_rest
from facegear.machine.statics import mean_equilibrium, static_bearing_forces
from facegear.motion.integrator.reduction import Reduction
from facegear.motion.steady_state.response import SteadyState
from facegear.motion.steady_state.simulate import Model
from facegear.motion.steady_state.statistics import moments
from facegear.motion.track import Track, add_ring_forces, track

DIRECTIONS = ("x", "y", "z", "radial")
"""Directions in which the bearing forces of a body are tabulated; radial is the magnitude of x and y."""
BEARING_COLUMNS = (
    "body",
    "direction",
    "static_n",
    "mean_n",
    "rms_n",
    "ac_rms_n",
    "ac_rms_interval_n",
    "peak_n",
    "class",
)
"""Columns of the table of bearing forces; forces in N."""


def bearing_history(model: Model, response: SteadyState) -> Array:
    """Compute the force of every body on its bearing at each sample of a response, see bearing_forces().

    Parameters
    ----------
    model : Model
        Reduced machine.
    response : SteadyState
        Response.

    Returns
    -------
    (K, bodies, 3) array
        Forces along x, y, z, N.
    """
    return np.moveaxis(bearing_forces(model, track(response)), -1, 0)


def bearing_forces(model: Model, motion: Track) -> Array:
    """Compute the force of every body on its bearing: springs, their damping of equation (21), and
    dampers.

    It is positive along the body's displacement; the bearing pushes back with the opposite force.

    The force is K q + beta K q' + D q', less the constant loads that tangents of rolling bearings have. Mass
    damping acts from outside and not through a bearing. With clearance the spring acts beyond it, F = k (1 -
    c / r) (x, y), and its damping is beta dF/dt.

    Parameters
    ----------
    model : Model
        Reduced machine.
    motion : Track
        Motion of the model's coordinates at K instants.

    Returns
    -------
    (bodies, 3, K) array
        Forces along x, y, z, N.
    """
    linear, maps = model.machine.linear, _bearing_maps(model.machine.without_errors, model.reduction)
    rings = linear.rings
    moving_parts = motion.along(maps.displacement_columns, maps.velocity_columns)
    first = len(moving_parts) - 4 * rings.body.size
    forces = np.zeros((maps.alone.size, motion.count))
    forces[maps.alone] = moving_parts[:first]
    if linear.tangent_loads is not None:
        forces -= linear.tangent_loads[linear.translations.ravel(), None]
    forces = forces.reshape(*linear.translations.shape, -1)
    if rings.body.size:
        displacements, rates = moving_parts[first:].reshape(2, rings.body.size, 2, -1)
        ring_properties = rings.stiffness, rings.clearance, linear.bearing_damping
        add_ring_forces(displacements, rates, *ring_properties, rings.body, forces)
    return forces


class _BearingMaps(NamedTuple):
    """Matrices that map reduced displacement and velocity to bearing forces.

    `alone` (3 bodies,) marks the components x, y, z of bodies that have a bearing without clearance. The
    columns (n, columns) for displacement and velocity, multiplied and added, give the forces of these
    components, N, then displacements and then velocities along x and y of each body in a bearing with
    clearance (ring).
    """

    alone: Mask
    displacement_columns: Array
    velocity_columns: Array


@lru_cache(maxsize=8)
def _bearing_maps(machine: Machine, reduction: Reduction) -> _BearingMaps:
    """Return the matrices from reduced displacement and velocity to bearing forces, see _BearingMaps.

    The result is cached and must not be changed.
    """
    linear = machine.linear
    displacement_columns, velocity_columns = _force_matrices(linear, reduction, linear.translations.ravel())
    in_rings = np.zeros(linear.translations.shape, dtype=bool)
    in_rings[linear.rings.body, :2] = True
    alone = (displacement_columns.any(axis=0) | velocity_columns.any(axis=0)) & ~in_rings.ravel()
    rows = reduction.basis[linear.ring_coordinates.ravel()].T
    zeros = np.zeros_like(rows)
    return _BearingMaps(
        alone,
        np.concatenate([displacement_columns[:, alone], rows, zeros], axis=1),
        np.concatenate([velocity_columns[:, alone], zeros, rows], axis=1),
    )


def _force_matrices(linear: LinearModel, reduction: Reduction, coordinates: Integers) -> tuple[Array, Array]:
    """Return matrices (n, coordinates) from reduced displacement and velocity to forces on springs and
    dampers.

    Displacement @ first + velocity @ second gives the force (N) or moment (N m) along each of the given
    coordinates of the linear model.
    """
    stiffness, dampers = linear.bearing_rows(coordinates)
    springs = reduction.basis.T @ stiffness.T
    return springs, linear.bearing_damping * springs + reduction.basis.T @ dampers.T


def shaft_bearing_history(model: Model, response: SteadyState, forces: Array) -> Array:
    """Compute the loads of the pinion shafts on their bearings, see shaft_bearing_loads(). Shaft mass is
    neglected.

    Parameters
    ----------
    model : Model
        Reduced machine.
    response : SteadyState
        Response.
    forces : (K, bodies, 3) array
        bearing_history() of the response, N.

    Returns
    -------
    (K, bearings, 5) array
        Forces along x, y, z, N, and moments tilt_x, tilt_y, N m, of the shaft on each bearing, in the
        order of bearing_names(); none without a drive line.
    """
    line = model.machine.drive_line
    if line is None:
        return np.zeros((len(forces), 0, 5))
    motion = track(response)
    linear, reduction = model.machine.linear, model.reduction
    moments = {i: motion.along(*_force_matrices(linear, reduction, line.tilts(i))).T for i in line.tilting}
    if linear.tangent_loads is not None:
        moments = {i: about - linear.tangent_loads[line.tilts(i)] for i, about in moments.items()}
    strains = None
    if model.machine.casing is not None:
        displacements = motion.along(reduction.basis.T, np.zeros_like(reduction.basis.T)).T
        strains = ring_strains(model.machine, displacements)
    return shaft_bearing_loads(line, forces, moments, strains=strains)


def velocities(response: SteadyState) -> Array:
    """Compute the time derivatives of the coordinates from cubic splines through the samples.

    Parameters
    ----------
    response : SteadyState
        Response.

    Returns
    -------
    (K, n) array
        Velocities, in the coordinates' unit per second (1/s).
    """
    identity = np.eye(response.coordinates.shape[1])
    return track(response).along(0.0 * identity, identity).T


def bearing_table(model: Model, response: SteadyState) -> pd.DataFrame:
    """Tabulate the bearing forces: four rows a body, along x, y, z, and the magnitude of x and y together.

    Below them stand the rows of each bearing of a pinion's shaft, such as `right input bearing A`. A pinion's
    x is tangential and y along the gears' axis, both radial for its bearing; a face gear's axis is z.

    Parameters
    ----------
    model : Model
        Reduced machine.
    response : SteadyState
        Response.

    Returns
    -------
    DataFrame
        BEARING_COLUMNS. `static_n`: at rest under the mean torques; `peak_n`: the largest magnitude, located
        between the samples; `ac_rms_interval_n`: 95 % half-width, 0 for a periodic motion.
    """
    machine = model.machine
    history, machine_at_rest = bearing_history(model, response), at_rest(machine)
    static_forces = static_bearing_forces(machine_at_rest)[None]
    bodies = list(machine.layout.body_names)
    if (line := machine.drive_line) is not None:
        bodies += [f"{bodies[pinion]} bearing {letter}" for pinion, letter in bearing_names(line)]
        shaft_forces = shaft_bearing_history(model, response, history)[..., :3]
        history = np.concatenate([history, shaft_forces], axis=1)
        strains, about = None, None
        if machine.casing is not None or line.is_tilted_by_meshes:
            still = mean_equilibrium(machine_at_rest)
            strains = ring_strains(machine_at_rest, still.displacements)
            about = tilting_moments(machine_at_rest, still)
        static_loads = shaft_bearing_loads(line, static_forces, about, strains=strains)
        static_forces = np.concatenate([static_forces, static_loads[..., :3]], axis=1)
    dynamic_forces, static = _with_radial(history), _with_radial(static_forces)[0]
    statistics = moments(
        dynamic_forces.reshape(len(dynamic_forces), -1), response.per_period, response.period > 0
    )
    names = [(body, direction) for body in bodies for direction in DIRECTIONS]
    table = pd.DataFrame(names, columns=["body", "direction"])
    values = (
        static.ravel(),
        statistics.mean,
        statistics.rms,
        statistics.ac_rms,
        statistics.ac_rms_interval,
        np.maximum(np.abs(statistics.minimum), np.abs(statistics.maximum)),
    )
    for column, value in zip(BEARING_COLUMNS[2:-1], values, strict=True):
        table[column] = value
    return table.assign(**{"class": response.label})


def _with_radial(forces: Array) -> Array:
    """Return forces (K, bodies, 3) along x, y, z, with hypot(x, y) appended as a fourth, (K, bodies, 4),
    N.
    """
    return np.concatenate([forces, np.hypot(forces[..., :1], forces[..., 1:2])], axis=-1)
