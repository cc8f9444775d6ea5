"""Deflections and elastic forces of the meshes at evenly spaced instants of a motion."""

import numpy as np

from facegear.arrays import Array, Integers, Mask
from facegear.by_content import kept_by_content
from facegear.dynamics.between_samples import FINE_STEPS, REACH, max_peaks, top_of, values_around
from facegear.dynamics.integrator.system import System
from facegear.harmonics.series import stacked_values
from facegear.mesh_law.law import beyond_edges, past_levels
from facegear.transmission.flanks import NO_LOAD


def mesh_response(system: System, coordinates: Array, per_period: int) -> tuple[Array, Array]:
    """Deflections and elastic mesh forces (K, meshes) of samples (K, n) that start with a mesh period."""
    each = each_deflection(system, coordinates, per_period)
    return by_mesh(system, each), mesh_forces(system, each, per_period)


def each_deflection(system: System, coordinates: Array, per_period: int) -> Array:
    """Deflections G y - e of samples (K, n) that start with a mesh period, one column for each mesh or
    flank.
    """
    contacts = system.contacts
    # Period by period: one large product would start threads, which then wait at full speed.
    by_period = coordinates.reshape(-1, per_period, coordinates.shape[1])
    deflections = by_period @ system.mesh_jacobian[:contacts].T
    deflections -= errors_of_period(system, per_period)
    return deflections.reshape(len(coordinates), -1)


def errors_of_period(system: System, per_period: int) -> Array:
    """Errors e (per_period, contacts) at the samples of a mesh period, m; shared, only read."""
    return _errors(system.error, system.error_kind[: system.contacts], per_period)


@kept_by_content(2)
def _errors(series: Array, kind: Integers, per_period: int) -> Array:
    """Errors (per_period, contacts) of the kinds of contacts at the samples of a mesh period, m."""
    return np.asarray(stacked_values(series, np.arange(per_period) / per_period)[:, kind])


def by_mesh(system: System, each: Array) -> Array:
    """Deflection of each mesh (K, meshes) from each_deflection(); with two flanks half the difference of what
    they are above their edges.
    """
    if not system.two_flanks:
        return each
    drive, back = np.split(each - system.upper[: system.contacts], 2, axis=1)
    return 0.5 * (drive - back)


def mesh_forces(system: System, each: Array, per_period: int) -> Array:
    """Elastic forces (K, meshes), N, from each_deflection(); with two flanks what both transmit."""
    by_period = each.reshape(-1, per_period, each.shape[1])
    forces = _transmitted(system, by_period, np.arange(per_period) / per_period)
    return forces.reshape(len(each), -1)


def _transmitted(system: System, each: Array, cycles: Array) -> Array:
    """Elastic forces (..., K, meshes), N, of deflections (..., K, contacts) at places (K,) in mesh cycles."""
    contacts = system.contacts
    beyond = beyond_edges(each, system.lower[:contacts], system.upper[:contacts])
    forces = system.law.force(cycles, beyond)
    if not system.two_flanks:
        return forces
    drive, back = np.split(forces, 2, axis=-1)
    return np.asarray(drive - back)


def largest_mesh_forces(system: System, each: Array, per_period: int, wraps: bool) -> Array:
    """Largest magnitude (meshes,) of the elastic mesh forces, N, located between the samples.

    Between samples the deflections are polynomials; the law makes forces of them, so that a short contact has
    its kink where the flank touches. each: each_deflection(); wraps: whether the samples are a whole period.
    """
    sizes = np.abs(mesh_forces(system, each, per_period))
    largest = np.asarray(sizes.max(axis=0))
    if len(each) <= 2 * REACH:
        return largest
    rows, is_peak = max_peaks(sizes, wraps)
    fine = values_around(each, rows.ravel())
    fine = fine.reshape(-1, fine.shape[2])
    instants = (rows.ravel() + FINE_STEPS[:, None]).ravel() / per_period
    forces = np.abs(_transmitted(system, fine, instants)).reshape(FINE_STEPS.size, *rows.shape, -1)
    for candidate, peak in enumerate(is_peak):
        own = np.diagonal(forces[:, candidate], axis1=1, axis2=2)
        largest = np.where(peak, np.maximum(largest, top_of(own)), largest)
    return largest


def past_law(system: System, each: Array) -> Array:
    """Fraction of samples (meshes,) at which a mesh is pressed in past the last level of its law, by the
    flank that is so more often.
    """
    contacts = system.contacts
    past = past_levels(system.law, beyond_edges(each, system.lower[:contacts], system.upper[:contacts]))
    return past.reshape(2, -1).max(axis=0) if system.two_flanks else past


def mesh_fractions(system: System, fractions: Array, each: Array) -> Array:
    """Time open, on the drive and on the back flank (3, meshes) from that of each flank, where there are two.

    Time with both flanks wedged counts on both, so that the three may add up to more than one. each (K,
    contacts): each_deflection() of the samples, by which a flank that is never pressed by more than rounding
    is open.
    """
    lower, upper = system.lower[: system.contacts], system.upper[: system.contacts]
    touching = fractions[1] if system.two_flanks else 1.0 - fractions[0]
    deepest = np.maximum(each.max(axis=0) - upper, lower - each.min(axis=0))
    never = (upper > lower) & _never_pressed(deepest, touching, len(each))
    if not system.two_flanks:
        return np.where(never, np.array([[1.0], [0.0], [0.0]]), fractions)
    drive, back = np.split(np.where(never, 0.0, touching), 2)
    wedged = np.minimum(fractions[2, : drive.size], np.minimum(drive, back))
    return np.stack([1.0 - drive - back + wedged, drive, back])


def _never_pressed(deepest: Array, fractions: Array, samples: int) -> Mask:
    """Which contacts touch for longer than a sample (fractions (m,)) without ever being pressed by more than
    rounding; deepest (m,) of the samples beyond the edge.
    """
    return (deepest <= NO_LOAD * max(float(deepest.max()), 0.0)) & (fractions * samples > 1.0)
