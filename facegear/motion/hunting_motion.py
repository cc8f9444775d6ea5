"""The motion under runouts and pitch deviations, integrated mesh cycle by mesh cycle.

Errors that turn slowly enter each cycle as a polynomial in time through their values at NODES instants, so
that they are continuous from cycle to cycle. A motion that has forgotten its past does not depend on where
the integration began; it is integrated from two starts to check this.
"""

from dataclasses import dataclass, replace

import numpy as np

from facegear.arrays import Array, Integers
from facegear.harmonics import stack_series, stacked_values
from facegear.machine.flank_errors import error_series, slow_errors
from facegear.machine.machine import mesh_frequency
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.integrator.kernel_system import TAU
from facegear.motion.plan import Settings, State
from facegear.motion.steady_state.simulate import Model, static_start

NODES = 6
"""Number of instants of a mesh cycle through which the polynomial of the slow errors goes."""
LEAD = 64
"""Number of mesh cycles before the cycles of the result."""
MAX_LEAD = 1024
"""Largest number of mesh cycles to which the lead is doubled."""
MEMORY_LIMIT = 1e-4
"""Difference between two starts, over the largest flank force, below which they agree."""
APART = 0.3
"""Distance of the second start from equilibrium, in length scales."""


@dataclass(frozen=True, eq=False)
class FollowedMotion:
    """The motion with all errors that turn, at K = mesh cycles x positions instants.

    Attributes
    ----------
    cycles : (K,) array
        Time of each instant, in mesh cycles of the reference, counted as `first` in follow().
    positions : int
        Number of instants in each mesh cycle.
    coordinates : (K, n) array
        Coordinates of the system.
    flank_forces : (K, 2 meshes) array
        Elastic forces, N, drive flanks first.
    lead : int
        Number of mesh cycles run before.
    memory : float
        Largest difference of the flank forces in the cycles after the lead between two starts, over the
        largest force; the motion depends on its past where it is not small.
    """

    cycles: Array
    positions: int
    coordinates: Array
    flank_forces: Array
    lead: int
    memory: float


def follow(
    model: Model,
    speed_rpm: float,
    first: int,
    count: int,
    positions: int = 16,
    settings: Settings | None = None,
) -> FollowedMotion:
    """Integrate a machine with geometric meshes through some mesh cycles with all errors that turn.

    The lead is doubled until two starts agree, up to MAX_LEAD cycles.

    Parameters
    ----------
    model : Model
        Reduced machine.
    speed_rpm : float
        Pinion speed, rpm.
    first : int
        Number of the first mesh cycle.
    count : int
        Number of mesh cycles.
    positions : int
        Number of instants in each mesh cycle.
    settings : Settings, optional
        Settings of the integrator.

    Returns
    -------
    FollowedMotion
        Coordinates and flank forces.

    Raises
    ------
    NotConverged
        If a step fails.
    """
    settings = settings or Settings()
    frequency = TAU * mesh_frequency(model.machine.layout, speed_rpm)
    integrator = Integrator(model.system, frequency, settings.tolerance, settings.order)
    rest = static_start(model)
    lead, compared_cycles = LEAD, min(count, LEAD)
    while True:
        starts = [integrator.by_phase(start) for start in (rest, _apart(model, rest))]
        whole = np.arange(first - lead, first + compared_cycles)
        results = [_run(model, integrator, start, whole, positions) for start in starts]
        runs = [samples[-compared_cycles * positions :] for samples, _ in results]
        forces = [_flank_forces(model, run, whole[-compared_cycles:], positions) for run in runs]
        memory = float(np.abs(forces[1] - forces[0]).max() / max(forces[0].max(), 1e-300))
        if memory <= MEMORY_LIMIT or lead >= MAX_LEAD:
            break
        lead *= 2
    rest_of_it = np.arange(first + compared_cycles, first + count)
    later, _ = _run(model, integrator, results[0][1], rest_of_it, positions)
    coordinates = np.concatenate([runs[0], later])
    whole = np.arange(first, first + count)
    return FollowedMotion(
        cycles=_instants(whole, positions),
        positions=positions,
        coordinates=coordinates,
        flank_forces=_flank_forces(model, coordinates, whole, positions),
        lead=lead,
        memory=memory,
    )


def slow_polynomials(model: Model, cycles: Integers) -> Array:
    """Compute the slow part of every flank's error in each mesh cycle, as polynomials of the mesh phase.

    Runouts, pitch deviations and errors of single teeth turn slowly. Each polynomial goes through the
    values of slow_errors() at NODES Chebyshev points, both ends of the cycle included; the phase counts
    from the cycle's start.

    Parameters
    ----------
    model : Model
        Reduced machine.
    cycles : (cycles,) array
        Numbers of the mesh cycles.

    Returns
    -------
    (cycles, NODES, flanks) array
        Coefficients by ascending powers of the phase, m/rad^power; drive flanks first.
    """
    nodes = 0.5 - 0.5 * np.cos(np.pi * np.arange(NODES) / (NODES - 1))
    values = slow_errors(model.machine, (cycles[:, None] + nodes).ravel())
    powers = np.linalg.inv(np.vander(nodes, increasing=True)) / TAU ** np.arange(NODES)[:, None]
    return np.einsum("pk,ckf->cpf", powers, values.reshape(cycles.size, NODES, values.shape[1]))


def _run(
    model: Model, integrator: Integrator, state: Array, cycles: Integers, positions: int
) -> tuple[Array, Array]:
    """Integrate mesh cycles from a state (2, n); return samples (cycles * positions, n) and the last
    state (2, n).

    In each of the `cycles`, given by number, the slow errors enter as slow_polynomials().
    """
    samples = np.zeros((cycles.size, positions, integrator.size))
    for cycle_samples, drift in zip(samples, slow_polynomials(model, cycles), strict=True):
        result = integrator.run(state, 1, samples=positions, drift=drift)
        cycle_samples[:], state = result.samples, result.state
    return samples.reshape(-1, integrator.size), state


def _flank_forces(model: Model, coordinates: Array, cycles: Integers, positions: int) -> Array:
    """Return the elastic forces of all flanks (K, flanks), N, drive flanks first, over mesh cycles given
    by number.

    `coordinates` (K, n) are samples of the motion, `positions` of them in each cycle.
    """
    machine, flanks = model.machine, model.system.contacts
    at = _instants(cycles, positions)
    error = stacked_values(stack_series(error_series(machine)), at) + slow_errors(machine, at)
    system = model.system
    over = coordinates @ system.mesh_jacobian[:flanks].T - error - system.upper[:flanks]
    phase_shifts = None if system.phase_shifts is None else coordinates @ system.phase_shifts.T
    return system.contact_forces(at, np.maximum(over, 0.0), phase_shifts)


def _instants(cycles: Integers, positions: int) -> Array:
    """Return the instants (cycles * positions,) in mesh cycles, `positions` of them evenly spaced from
    each cycle's start.
    """
    return (cycles[:, None] + np.arange(positions) / positions).ravel()


def _apart(model: Model, start: State) -> State:
    """Return a state APART length scales away from a start at most, in a direction to which every mesh
    responds.
    """
    reach = np.abs(model.reduction.mesh_jacobian).max()
    way = np.sign(np.cos(1.0 + np.arange(start.displacement.size)))
    return replace(start, displacement=start.displacement + APART * model.system.scale / reach * way)
