"""Deflections and elastic forces of the meshes at evenly spaced instants of a motion."""

import numpy as np

from facegear.arrays import Array, Integers, Mask
from facegear.by_content import kept_by_content
from facegear.harmonics import stacked_values
from facegear.machine.flanks import NO_LOAD
from facegear.meshing.law import beyond_edges, past_levels
from facegear.motion.between_samples import FINE_STEPS, REACH, max_peaks, top_of, values_around
from facegear.motion.integrator.system import System


def mesh_response(system: System, coordinates: Array, per_period: int) -> tuple[Array, Array]:
    """Compute the deflections and elastic forces of the meshes.

    Parameters
    ----------
    system : System
        Equations of motion.
    coordinates : (K, n) array
        Samples that start with a mesh period, m.
    per_period : int
        Number of samples in each mesh period.

    Returns
    -------
    (K, meshes) array
        Deflections, m.
    (K, meshes) array
        Elastic mesh forces, N.
    """
    contact_deflections = each_deflection(system, coordinates, per_period)
    return by_mesh(system, contact_deflections), mesh_forces(system, contact_deflections, per_period)


def each_deflection(system: System, coordinates: Array, per_period: int) -> Array:
    """Compute the deflections G y - e of each contact: each mesh, or each flank where meshes have two.

    G is the mesh Jacobian, y are the coordinates, and e is the transmission error.

    Parameters
    ----------
    system : System
        Equations of motion.
    coordinates : (K, n) array
        Samples that start with a mesh period, m.
    per_period : int
        Number of samples in each mesh period.

    Returns
    -------
    (K, contacts) array
        Deflections, m; where the system has `phase_shifts`, those of the contacts follow as columns, rad.
    """
    contacts = system.contacts
    # Period by period: one large product would start threads, which then wait at full speed.
    by_period = coordinates.reshape(-1, per_period, coordinates.shape[1])
    deflections = by_period @ system.mesh_jacobian[:contacts].T
    deflections -= errors_of_period(system, per_period)
    deflections = deflections.reshape(len(coordinates), -1)
    return (
        deflections
        if system.phase_shifts is None
        else np.concatenate([deflections, coordinates @ system.phase_shifts.T], axis=1)
    )


def errors_of_period(system: System, per_period: int) -> Array:
    """Return the transmission errors of the contacts at even samples of a mesh period, which starts at
    phase 0.

    The array is shared and must not be changed.

    Parameters
    ----------
    system : System
        Equations of motion.
    per_period : int
        Number of samples in each mesh period.

    Returns
    -------
    (per_period, contacts) array
        Errors e, m.
    """
    return _errors(system.error, system.error_kind[: system.contacts], per_period)


@kept_by_content(2)
def _errors(series: Array, kind: Integers, per_period: int) -> Array:
    """Return the errors (per_period, contacts), m, at evenly spaced samples of a mesh period.

    `series` (kinds, 2, harmonics + 1) and `kind` (contacts,) are as System.error and error_kind.
    """
    return np.asarray(stacked_values(series, np.arange(per_period) / per_period)[:, kind])


def by_mesh(system: System, contact_deflections: Array) -> Array:
    """Compute the deflection of each mesh from those of its contacts.

    With two flanks it is half the difference of the heights of drive and back flank above their edges, so
    that it counts from the middle of the backlash and is positive towards the drive flank.

    Parameters
    ----------
    system : System
        Equations of motion.
    contact_deflections : (K, contacts) array
        Deflections of each_deflection(), m.

    Returns
    -------
    (K, meshes) array
        Deflections, m.
    """
    contacts = system.contacts
    if not system.two_flanks:
        return contact_deflections[:, :contacts]
    drive, back = np.split(contact_deflections[:, :contacts] - system.upper[:contacts], 2, axis=1)
    return 0.5 * (drive - back)


def mesh_forces(system: System, contact_deflections: Array, per_period: int) -> Array:
    """Compute the elastic force of each mesh, positive on the drive flank; with two flanks drive less
    back flank.

    Parameters
    ----------
    system : System
        Equations of motion.
    contact_deflections : (K, contacts) array
        Deflections of each_deflection(), m.
    per_period : int
        Number of samples in each mesh period.

    Returns
    -------
    (K, meshes) array
        Elastic forces, N.
    """
    by_period = contact_deflections.reshape(-1, per_period, contact_deflections.shape[1])
    forces = _transmitted(system, by_period, np.arange(per_period) / per_period)
    return forces.reshape(len(contact_deflections), -1)


def _transmitted(system: System, contact_deflections: Array, cycles: Array) -> Array:
    """Return elastic forces (..., K, meshes), N, from deflections (..., K, contacts), m, at phases (K,) in
    mesh cycles.
    """
    contacts = system.contacts
    deflections = contact_deflections[..., :contacts]
    beyond = beyond_edges(deflections, system.lower[:contacts], system.upper[:contacts])
    phase_shifts = None if system.phase_shifts is None else contact_deflections[..., contacts:]
    forces = system.contact_forces(cycles, beyond, phase_shifts)
    if not system.two_flanks:
        return forces
    drive, back = np.split(forces, 2, axis=-1)
    return np.asarray(drive - back)


def largest_mesh_forces(system: System, contact_deflections: Array, per_period: int, wraps: bool) -> Array:
    """Compute the largest magnitude of each elastic mesh force, located between the samples.

    Between samples the deflections are polynomials. The mesh law turns these into forces, so that a short
    contact has its kink where the flank touches.

    Parameters
    ----------
    system : System
        Equations of motion.
    contact_deflections : (K, contacts) array
        Deflections of each_deflection(), m.
    per_period : int
        Number of samples in each mesh period.
    wraps : bool
        Whether the samples are a whole period of the motion.

    Returns
    -------
    (meshes,) array
        Largest forces, N.
    """
    sizes = np.abs(mesh_forces(system, contact_deflections, per_period))
    largest = np.asarray(sizes.max(axis=0))
    if len(contact_deflections) <= 2 * REACH:
        return largest
    rows, is_peak = max_peaks(sizes, wraps)
    fine = values_around(contact_deflections, rows.ravel())
    fine = fine.reshape(-1, fine.shape[2])
    instants = (rows.ravel() + FINE_STEPS[:, None]).ravel() / per_period
    forces = np.abs(_transmitted(system, fine, instants)).reshape(FINE_STEPS.size, *rows.shape, -1)
    for candidate, peak in enumerate(is_peak):
        peak_forces = np.diagonal(forces[:, candidate], axis1=1, axis2=2)
        largest = np.where(peak, np.maximum(largest, top_of(peak_forces)), largest)
    return largest


def past_law(system: System, contact_deflections: Array) -> Array:
    """Compute the fraction of the samples at which a mesh is compressed beyond the last level of its
    law's table.

    With two flanks it is the larger fraction of both.

    Parameters
    ----------
    system : System
        Equations of motion.
    contact_deflections : (K, contacts) array
        Deflections of each_deflection(), m.

    Returns
    -------
    (meshes,) array
        Fraction of the samples.
    """
    contacts = system.contacts
    past = past_levels(
        system.law,
        beyond_edges(contact_deflections[:, :contacts], system.lower[:contacts], system.upper[:contacts]),
    )
    return past.reshape(2, -1).max(axis=0) if system.two_flanks else past


def mesh_fractions(system: System, fractions: Array, contact_deflections: Array) -> Array:
    """Compute the fractions of the time that each mesh is open, on its drive flank and on its back flank.

    Time with both flanks wedged counts on both, so that the three may add up to more than one. A flank that
    is never compressed by more than rounding is open.

    Parameters
    ----------
    system : System
        Equations of motion.
    fractions : (3, contacts) array
        Fractions of the time of each contact, as the integrator counts them.
    contact_deflections : (K, contacts) array
        Deflections of each_deflection(), m.

    Returns
    -------
    (3, meshes) array
        Fraction of the time open, on the drive flank, on the back flank.
    """
    lower, upper = system.lower[: system.contacts], system.upper[: system.contacts]
    contact_deflections = contact_deflections[:, : system.contacts]
    contact_fractions = fractions[1] if system.two_flanks else 1.0 - fractions[0]
    deepest = np.maximum(contact_deflections.max(axis=0) - upper, lower - contact_deflections.min(axis=0))
    never = (upper > lower) & _never_pressed(deepest, contact_fractions, len(contact_deflections))
    if not system.two_flanks:
        return np.where(never, np.array([[1.0], [0.0], [0.0]]), fractions)
    drive, back = np.split(np.where(never, 0.0, contact_fractions), 2)
    wedged = np.minimum(fractions[2, : drive.size], np.minimum(drive, back))
    return np.stack([1.0 - drive - back + wedged, drive, back])


def _never_pressed(deepest: Array, fractions: Array, samples: int) -> Mask:
    """Return which contacts touch for longer than a sample but are never compressed by more than
    rounding, (m,).

    `deepest` (m,) is the largest compression among the samples, m, negative where there is none.
    `fractions` (m,) of the time are those in contact, `samples` their number.
    """
    return (deepest <= NO_LOAD * max(float(deepest.max()), 0.0)) & (fractions * samples > 1.0)
