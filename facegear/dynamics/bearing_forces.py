"""Forces on the bearings of every body: at rest, and over the response at one speed."""

import numpy as np
import pandas as pd
import scipy

from facegear.arrays import Array, Integers
from facegear.dynamics.integrator.compiled import TAU
from facegear.dynamics.steady_state.response import SteadyState
from facegear.dynamics.steady_state.simulate import Model
from facegear.dynamics.steady_state.statistics import moments
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
    """Force of every body on its bearing along x, y, z, shape (K, bodies, 3), N.

    Springs, their damping of equation (21) and dampers: K q + beta K q' + D q'. Mass damping acts from
    outside and is no bearing's. With clearance the spring acts beyond it, F = k (1 - c / r) (x, y), and its
    damping is beta dF/dt.
    """
    basis, linear, coordinates = model.reduced.basis, model.machine.linear, response.coordinates
    lag, rings = linear.bearing_damping, linear.rings
    rate, held = velocities(response), linear.translations
    forces = _held_by(model, response, rate, held.ravel()).reshape(-1, *held.shape)
    if rings.body.size:
        rows = basis[linear.ring_coordinates.ravel()].T
        moved, moving = ((motion @ rows).reshape(-1, rings.body.size, 2) for motion in (coordinates, rate))
        forces[:, rings.body, :2] = _ring_force(moved, moving, rings.stiffness, rings.clearance, lag)
    return forces


def _held_by(model: Model, response: SteadyState, rate: Array, coordinates: Integers) -> Array:
    """Force or moment (K, coordinates) on springs and dampers along some coordinates."""
    linear, basis = model.machine.linear, model.reduced.basis
    forces = (response.coordinates + linear.bearing_damping * rate) @ (
        basis.T @ linear.stiffness[:, coordinates]
    )
    if linear.dampers.any():
        forces += rate @ (basis.T @ linear.dampers[coordinates].T)
    return np.asarray(forces)


def shaft_bearing_history(model: Model, response: SteadyState, forces: Array) -> Array:
    """Loads of pinions' shafts on their bearings, (K, bearings, 5), N and N m, as shaft_bearing_loads() has
    them.

    forces (K, bodies, 3): bearing_history() of the response. Masses of shafts count nothing.
    """
    line = model.machine.drive_line
    if line is None:
        return np.zeros((len(forces), 0, 5))
    rate = velocities(response)
    moments = {i: _held_by(model, response, rate, line.tilts(i)) for i in line.tilting}
    return shaft_bearing_loads(line, forces, moments)


def _ring_force(displacement: Array, speed: Array, stiffness: Array, clearance: Array, lag: float) -> Array:
    """Forces (K, R, 2) of R bearings with clearance at displacements and speeds (K, R, 2)."""
    (x, y), (u, v) = np.moveaxis(displacement, -1, 0), np.moveaxis(speed, -1, 0)
    distance = np.maximum(np.hypot(x, y), clearance)
    fraction = 1.0 - clearance / distance
    turned = (1.0 - fraction) * (x * u + y * v) / distance**2
    touching = lag * (distance > clearance)
    both = ((x, u), (y, v))
    along = [fraction * shift + (fraction * rate + turned * shift) * touching for shift, rate in both]
    return stiffness[:, None] * np.stack(along, axis=-1)


def velocities(response: SteadyState) -> Array:
    """Time derivatives of the coordinates (K, n), 1/s, from cubic splines through the samples."""
    step = TAU / (response.frequency * response.per_period)
    if response.period > 0:
        return closed_spline_slopes(response.coordinates, step)
    time = np.arange(len(response.coordinates)) * step
    return scipy.interpolate.CubicSpline(time, response.coordinates)(time, 1)


def closed_spline_slopes(samples: Array, step: float) -> Array:
    """Slopes (K, columns) at the knots of the periodic cubic spline through K even samples.

    Slopes m satisfy m[i-1] + 4 m[i] + m[i+1] = 3 (f[i+1] - f[i-1]) / step, which Fourier's series solves wave
    by wave.
    """
    count = len(samples)
    angle = TAU * np.arange(count // 2 + 1) / count
    factor = 3.0j * np.sin(angle) / ((2.0 + np.cos(angle)) * step)
    return np.asarray(np.fft.irfft(np.fft.rfft(samples, axis=0) * factor[:, None], count, axis=0))


def bearing_table(model: Model, response: SteadyState) -> pd.DataFrame:
    """BEARING_COLUMNS, four rows a body: along x, y, z, and the magnitude of x and y together. Below them the
    same of each bearing of a pinion's shaft, `right input bearing A`.

    static: at rest under the mean torques; peak: the largest magnitude of the samples; interval: 95 %
    half-width, 0 for a periodic motion. A pinion's x is tangential and y along the gears' axis, both radial
    for its bearing; a face gear's axis is z.
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
