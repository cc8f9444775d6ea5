"""The map over whole mesh periods, its matrix and its change with the parameter, in weighted states."""

from dataclasses import dataclass, field, replace
from typing import cast

import numpy as np

from facegear.arrays import Array, Mask
from facegear.dynamics.branches.extrema import extrema
from facegear.dynamics.branches.family import Family
from facegear.dynamics.integrator.integrator import Integrator
from facegear.dynamics.integrator.system import RING_ROWS
from facegear.dynamics.motion import State
from facegear.dynamics.side_by_side import run_many
from facegear.dynamics.steady_state.orbits import monodromy

PARAMETER_STEP = 1e-5
"""Change of the parameter's logarithm in the central difference of the map."""
RATE_STEP = 1e-4
"""Step along a branch in the difference that tells how the map's matrix changes: far above the matrix's own
error, far below the steps of a branch."""
RIGID = 1e-10
STEPS = 0.1
"""Part of the tolerance to which each step is held: their errors add up."""
FINEST = 1e-14


@dataclass(frozen=True, eq=False)
class Linear:
    """The period map near a state.

    Attributes
    ----------
    gap : (2 n,)
        Change end - start.
    matrix : (2 n, 2 n)
        Derivative of the map.
    slope : (2 n,)
        Its change with the parameter's logarithm.
    contact : (meshes,)
        Whether a mesh is ever in contact.
    neutral : (2 n, k)
        Directions of bodies that touch nothing, orthonormal.
    divergence
        Integral of the trace.
    inverses
        Of the matrix bordered by a row.
    rates
        Change of the matrix along a direction, see PeriodMap.matrix_rate().
    """

    gap: Array
    matrix: Array
    slope: Array
    contact: Mask
    neutral: Array
    divergence: float
    inverses: dict[bytes, Array] = field(default_factory=dict, repr=False)
    rates: dict[bytes, Array] = field(default_factory=dict, repr=False)


@dataclass(frozen=True, eq=False)
class PeriodMap:
    """P(z, u) over `period` mesh periods at one tolerance: about the error of orbits in length scales, and of
    special points relative to the parameter.

    z (2 n,): places, then velocities by mesh phase, as mesh deflections over the length scale; u: logarithm
    of the family's parameter.
    """

    family: Family
    period: int = 1
    tolerance: float = 1e-10
    memory: dict[tuple, Integrator | Array] = field(default_factory=dict, repr=False)

    @property
    def step_tolerance(self) -> float:
        """Local error of a step over the length scale."""
        return max(STEPS * self.tolerance, FINEST)

    def over(self, period: int) -> "PeriodMap":
        """The same over another number of mesh periods."""
        return replace(self, period=period)

    def integrator(self, u: float) -> Integrator:
        """What runs the system at a parameter; all share scratch space while the system's sizes stay."""
        system, frequency = self.family.at(float(np.exp(u)))
        law = system.law
        key = (
            type(law),
            system.coupling is None,
            *system.mesh_jacobian.shape,
            system.contacts,
            None if system.rubbing is None else system.rubbing.ratios.shape,
            *(series.shape for series in (law.harmonic_fractions, law.levels, system.error, system.load)),
        )
        like = cast(Integrator | None, self.memory.get(key))
        made = Integrator(system, frequency, self.step_tolerance, like=like)
        self.memory.setdefault(key, made)
        return made

    def weights(self, integrator: Integrator) -> Array:
        """z = weights * state, shape (2 n,)."""
        return np.tile(integrator.weights / integrator.scale, 2)

    def state(self, z: Array, u: float) -> State:
        """Place and velocity by time of a weighted state."""
        integrator = self.integrator(u)
        return integrator.by_time(self._by_phase(integrator, z))

    def _by_phase(self, integrator: Integrator, z: Array) -> Array:
        return (z / self.weights(integrator)).reshape(2, -1)

    def weighted(self, state: State, u: float) -> Array:
        """Weighted state of place and velocity by time."""
        integrator = self.integrator(u)
        return self.weights(integrator) * integrator.by_phase(state).ravel()

    def gap(self, z: Array, u: float) -> Array:
        """P(z, u) - z."""
        integrator = self.integrator(u)
        end = integrator.run(self._by_phase(integrator, z), self.period, fine=True).state
        return self.weights(integrator) * end.ravel() - z

    def ends(self, states: Array, u: float, periods: int) -> list[Array]:
        """Weighted states (periods, 2 n) at the ends of mesh periods, from each of some states (S, 2 n)."""
        integrator = self.integrator(u)
        starts = [self._by_phase(integrator, z) for z in states]
        runs = run_many([integrator] * len(starts), starts, periods)
        return [self.weights(integrator) * run.ends.reshape(periods, -1) for run in runs]

    def linear(self, z: Array, u: float) -> Linear:
        """The map with its matrix and its slope at a state."""
        integrator = self.integrator(u)
        weights = self.weights(integrator)
        matrix, result = monodromy(integrator, self._by_phase(integrator, z), self.period)
        matrix = matrix * (weights[:, None] / weights)
        gap = weights * result.state.ravel() - z
        step = PARAMETER_STEP
        slope = (self.gap(z, u + step) - self.gap(z, u - step)) / (2.0 * step)
        lower, upper = integrator.edges
        contact = (result.fractions[1:].sum(axis=0) > 0.0) | (lower >= upper)
        for x in range(integrator.contacts, integrator.rows, RING_ROWS):
            contact[x : x + 2] = contact[x + 2]
        return Linear(
            gap=gap,
            matrix=matrix,
            slope=slope,
            contact=contact,
            neutral=self._rigid(integrator, contact, weights),
            divergence=result.divergence,
        )

    def matrix_rate(self, x: Array, tangent: Array, linear: Linear) -> Array:
        """Change of the map's matrix (2 n, 2 n) per unit length along a tangent (2 n + 1,) of the branch.

        linear: the map at x (2 n + 1,), which keeps the answer.
        """
        key = tangent.tobytes()
        if key not in linear.rates:
            ahead = x + RATE_STEP * tangent
            integrator = self.integrator(float(ahead[-1]))
            weights = self.weights(integrator)
            matrix, _ = monodromy(integrator, self._by_phase(integrator, ahead[:-1]), self.period)
            linear.rates[key] = (matrix * (weights[:, None] / weights) - linear.matrix) / RATE_STEP
        return linear.rates[key]

    def _rigid(self, integrator: Integrator, contact: Mask, weights: Array) -> Array:
        """Shifts that neither a mesh in contact nor a bearing feels: their multiplier is one."""
        key = (contact.tobytes(), weights.tobytes())
        if key not in self.memory:
            n = integrator.size
            jacobian = integrator.mesh_jacobian
            coupling = integrator.system.coupling
            held = np.concatenate(
                [
                    jacobian[contact] / np.abs(jacobian).max(),
                    np.diag(np.sign(integrator.omega_squared)),
                    *([coupling.displacement_terms(integrator.frequency)] if coupling else []),
                ]
            )
            _, sizes, rows = np.linalg.svd(held)
            free = rows[np.count_nonzero(sizes > RIGID) :]
            shifts = np.zeros((2 * n, len(free)))
            shifts[:n] = weights[:n, None] * free.T
            self.memory[key] = np.linalg.qr(shifts)[0]
        return cast(Array, self.memory[key])

    def extrema(self, z: Array, u: float) -> Array:
        """Maxima and minima of each mesh deflection over the period, over the length scale.

        Shape (m, 2, most), each falling, and minus infinity where there are fewer.
        """
        integrator = self.integrator(u)
        values = extrema(integrator, self._by_phase(integrator, z), self.period)
        return values / integrator.scale

    def edges(self, u: float) -> tuple[Array, Array]:
        """Lower and upper edge of each mesh over the length scale; infinite where it never opens."""
        integrator = self.integrator(u)
        lower, upper = (edge / integrator.scale for edge in integrator.edges)
        closed = lower >= upper
        return np.where(closed, -np.inf, lower), np.where(closed, np.inf, upper)

    def images(self, z: Array, u: float) -> list[Array]:
        """The orbit's states at the starts of its mesh periods, the given one first."""
        single, images = self.over(1), [z]
        for _ in range(self.period - 1):
            images.append(images[-1] + single.gap(images[-1], u))
        return images
