"""The motion while runouts and pitch deviations turn: followed mesh cycle by mesh cycle.

What turns slowly enters each cycle as a polynomial in time through its values at NODES instants, so that it
goes on without a jump from cycle to cycle. A motion whose past is forgotten does not depend on where the
following began: it is followed from two starts.
"""

from dataclasses import dataclass, replace

import numpy as np

from facegear.arrays import Array, Integers
from facegear.dynamics.integrator.compiled import TAU
from facegear.dynamics.integrator.integrator import Integrator
from facegear.dynamics.motion import Settings, State
from facegear.dynamics.steady_state.simulate import Model, static_start
from facegear.harmonics.series import stacked, stacked_values
from facegear.transmission.flanks import error_series, slow_errors
from facegear.transmission.machine import mesh_frequency

NODES = 6
LEAD = 64
"""Mesh cycles before those that are kept."""
MAX_LEAD = 1024
FORGOTTEN = 1e-4
"""Difference between two starts, over the largest flank force, that counts as none."""
APART = 0.3
"""How far the second start is from equilibrium, in length scales."""


@dataclass(frozen=True, eq=False)
class Followed:
    """K = mesh cycles x positions of the motion with everything that turns.

    Attributes
    ----------
    cycles : (K,)
        Mesh cycles of the reference.
    positions
        In each mesh cycle.
    coordinates : (K, n)
        Of the system.
    flank_forces : (K, 2 meshes)
        Elastic, N, drive flanks first.
    lead
        Cycles run before.
    memory
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
) -> Followed:
    """Follow a machine with geometric meshes through `count` mesh cycles from cycle `first` on.

    The lead is doubled until two starts agree, up to MAX_LEAD cycles. Raises NotConverged if a step fails.
    """
    settings = settings or Settings()
    frequency = TAU * mesh_frequency(model.machine.layout, speed_rpm)
    integrator = Integrator(model.system, frequency, settings.tolerance, settings.order)
    rest = static_start(model)
    lead, kept = LEAD, min(count, LEAD)
    while True:
        starts = [integrator.by_phase(start) for start in (rest, _apart(model, rest))]
        whole = np.arange(first - lead, first + kept)
        both = [_run(model, integrator, start, whole, positions) for start in starts]
        runs = [samples[-kept * positions :] for samples, _ in both]
        forces = [_flank_forces(model, run, whole[-kept:], positions) for run in runs]
        memory = float(np.abs(forces[1] - forces[0]).max() / max(forces[0].max(), 1e-300))
        if memory <= FORGOTTEN or lead >= MAX_LEAD:
            break
        lead *= 2
    rest_of_it = np.arange(first + kept, first + count)
    later, _ = _run(model, integrator, both[0][1], rest_of_it, positions)
    coordinates = np.concatenate([runs[0], later])
    whole = np.arange(first, first + count)
    return Followed(
        cycles=_instants(whole, positions),
        positions=positions,
        coordinates=coordinates,
        flank_forces=_flank_forces(model, coordinates, whole, positions),
        lead=lead,
        memory=memory,
    )


def slow_polynomials(model: Model, cycles: Integers) -> Array:
    """The slow part of every flank's error in each mesh cycle, (cycles, NODES, flanks), by powers of s."""
    nodes = 0.5 - 0.5 * np.cos(np.pi * np.arange(NODES) / (NODES - 1))
    values = slow_errors(model.machine, (cycles[:, None] + nodes).ravel())
    powers = np.linalg.inv(np.vander(nodes, increasing=True)) / TAU ** np.arange(NODES)[:, None]
    return np.einsum("pk,ckf->cpf", powers, values.reshape(cycles.size, NODES, values.shape[1]))


def _run(
    model: Model, integrator: Integrator, state: Array, cycles: Integers, positions: int
) -> tuple[Array, Array]:
    """Samples (cycles * positions, n) of the coordinates from a state (2, n), and the state at the end."""
    samples = np.zeros((cycles.size, positions, integrator.size))
    for kept, drift in zip(samples, slow_polynomials(model, cycles), strict=True):
        result = integrator.run(state, 1, samples=positions, drift=drift)
        kept[:], state = result.samples, result.state
    return samples.reshape(-1, integrator.size), state


def _flank_forces(model: Model, coordinates: Array, cycles: Integers, positions: int) -> Array:
    machine, flanks = model.machine, model.system.contacts
    at = _instants(cycles, positions)
    error = stacked_values(stacked(error_series(machine)), at) + slow_errors(machine, at)
    over = coordinates @ model.system.mesh_jacobian[:flanks].T - error - model.system.upper[:flanks]
    return model.system.law.force(at, np.maximum(over, 0.0))


def _instants(cycles: Integers, positions: int) -> Array:
    return (cycles[:, None] + np.arange(positions) / positions).ravel()


def _apart(model: Model, start: State) -> State:
    """A start away from equilibrium, in a direction that no mesh is blind to."""
    reach = np.abs(model.reduced.mesh_jacobian).max()
    way = np.sign(np.cos(1.0 + np.arange(start.displacement.size)))
    return replace(start, displacement=start.displacement + APART * model.system.scale / reach * way)
