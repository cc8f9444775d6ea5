"""Forces on the bearings of every body: at rest, and over the response at one speed."""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
import pandas as pd

from facegear.arrays import Array, Integers, Mask
from facegear.dynamics.at_instants import add_ring_forces
from facegear.dynamics.integrator.reduction import Reduced
from facegear.dynamics.steady_state.response import SteadyState
from facegear.dynamics.steady_state.simulate import Model
from facegear.dynamics.steady_state.statistics import moments
from facegear.dynamics.track import Track, track
from facegear.transmission.linear_model import LinearModel
from facegear.transmission.machine import Machine
from facegear.transmission.shaft_loads import bearing_names, shaft_bearing_loads
from facegear.transmission.static_gears import at_rest
from facegear.transmission.statics import static_bearing_forces

DIRECTIONS = ("x", "y", "z", "radial")
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


def bearing_history(model: Model, response: SteadyState) -> Array:
    """Force of every body on its bearing along x, y, z, shape (K, bodies, 3), N, as bearing_forces() has
    them.
    """
    return np.moveaxis(bearing_forces(model, track(response)), -1, 0)


def bearing_forces(model: Model, motion: Track) -> Array:
    """Force of every body on its bearing along x, y, z, shape (bodies, 3, K), N.

    Springs, their damping of equation (21) and dampers: K q + beta K q' + D q'. Mass damping acts from
    outside and is no bearing's. With clearance the spring acts beyond it, F = k (1 - c / r) (x, y), and its
    damping is beta dF/dt.
    """
    linear, felt = model.machine.linear, _felt(model.machine.without_errors, model.reduced)
    rings = linear.rings
    moving_parts = motion.along(felt.places, felt.speeds)
    first = len(moving_parts) - 4 * rings.body.size
    forces = np.zeros((felt.alone.size, motion.count))
    forces[felt.alone] = moving_parts[:first]
    forces = forces.reshape(*linear.translations.shape, -1)
    if rings.body.size:
        moved, moving = moving_parts[first:].reshape(2, rings.body.size, 2, -1)
        held = rings.stiffness, rings.clearance, linear.bearing_damping
        add_ring_forces(moved, moving, *held, rings.body, forces)
    return forces


class _Felt(NamedTuple):
    """What bearings feel of a motion: places and speeds (n, columns) that make the forces of those `alone`
    (3 bodies,), on which no ring acts, then place and speed of each body in a ring along x and y.
    """

    alone: Mask
    places: Array
    speeds: Array


@lru_cache(maxsize=8)
def _felt(machine: Machine, reduced: Reduced) -> _Felt:
    linear = machine.linear
    places, speeds = _held(linear, reduced, linear.translations.ravel())
    in_rings = np.zeros(linear.translations.shape, dtype=bool)
    in_rings[linear.rings.body, :2] = True
    alone = (places.any(axis=0) | speeds.any(axis=0)) & ~in_rings.ravel()
    rows = reduced.basis[linear.ring_coordinates.ravel()].T
    nothing = np.zeros_like(rows)
    return _Felt(
        alone,
        np.concatenate([places[:, alone], rows, nothing], axis=1),
        np.concatenate([speeds[:, alone], nothing, rows], axis=1),
    )


def _held(linear: LinearModel, reduced: Reduced, coordinates: Integers) -> tuple[Array, Array]:
    """What a place and a speed of the reduced coordinates (n, coordinates) give to the force or moment on
    springs and dampers along some coordinates.
    """
    basis = reduced.basis
    springs = basis.T @ linear.stiffness[:, coordinates]
    return springs, linear.bearing_damping * springs + basis.T @ linear.dampers[coordinates].T


def shaft_bearing_history(model: Model, response: SteadyState, forces: Array) -> Array:
    """Loads of pinions' shafts on their bearings, (K, bearings, 5), N and N m, as shaft_bearing_loads() has
    them.

    forces (K, bodies, 3): bearing_history() of the response. Masses of shafts count nothing.
    """
    line = model.machine.drive_line
    if line is None:
        return np.zeros((len(forces), 0, 5))
    motion = track(response)
    linear, reduced = model.machine.linear, model.reduced
    moments = {i: motion.along(*_held(linear, reduced, line.tilts(i))).T for i in line.tilting}
    return shaft_bearing_loads(line, forces, moments)


def velocities(response: SteadyState) -> Array:
    """Time derivatives of the coordinates (K, n), 1/s, from cubic splines through the samples."""
    each = np.eye(response.coordinates.shape[1])
    return track(response).along(0.0 * each, each).T


def bearing_table(model: Model, response: SteadyState) -> pd.DataFrame:
    """BEARING_COLUMNS, four rows a body: along x, y, z, and the magnitude of x and y together. Below them the
    same of each bearing of a pinion's shaft, `right input bearing A`.

    static: at rest under the mean torques; peak: the largest magnitude, located between the samples;
    interval: 95 % half-width, 0 for a periodic motion. A pinion's x is tangential and y along the gears'
    axis, both radial for its bearing; a face gear's axis is z.
    """
    machine = model.machine
    history, resting = bearing_history(model, response), static_bearing_forces(at_rest(machine))[None]
    bodies = list(machine.layout.body_names)
    if (line := machine.drive_line) is not None:
        bodies += [f"{bodies[pinion]} bearing {letter}" for pinion, letter in bearing_names(line)]
        own = shaft_bearing_history(model, response, history)[..., :3]
        history = np.concatenate([history, own], axis=1)
        resting = np.concatenate([resting, shaft_bearing_loads(line, resting)[..., :3]], axis=1)
    moving, static = _with_radial(history), _with_radial(resting)[0]
    statistics = moments(moving.reshape(len(moving), -1), response.per_period, response.period > 0)
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
    """Forces (K, bodies, 3) with their radial magnitude as a fourth."""
    return np.concatenate([forces, np.hypot(forces[..., :1], forces[..., 1:2])], axis=-1)
