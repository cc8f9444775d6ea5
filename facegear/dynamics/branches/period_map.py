"""The map over whole mesh periods, its matrix and its change with the parameter, in weighted states."""

from dataclasses import dataclass, field, replace
from typing import cast

import numpy as np
from numpy.typing import NDArray

from facegear.dynamics.branches.family import Family
from facegear.dynamics.branches.turning import MOST, turning_points
from facegear.dynamics.integrator.compiled import Packed, pack
from facegear.dynamics.integrator.periods import Log, disturbance_step, make_log, run_periods
from facegear.dynamics.integrator.rings import ROWS
from facegear.dynamics.integrator.work import Work, make_work
from facegear.dynamics.motion import Settings, State
from facegear.dynamics.steady_state.orbits import require

Array = NDArray[np.float64]
PARAMETER_STEP = 1e-5
"""Change of the parameter's logarithm in the central difference of the map."""
RIGID = 1e-10
STEPS = 0.1
"""Part of the tolerance to which each step is held: their errors add up."""
FINEST = 1e-14


@dataclass(frozen=True, eq=False)
class Linear:
    """The map near a state: change end - start (2 n,), matrix (2 n, 2 n), slope by the parameter's logarithm
    (2 n,), contact (meshes,): whether it is ever in contact, afloat (2 n, k): directions of bodies that touch
    nothing, orthonormal, divergence: integral of the trace. inverses: of the matrix bordered by a row.
    """

    gap: Array
    matrix: Array
    slope: Array
    contact: NDArray[np.bool_]
    afloat: Array
    divergence: float
    inverses: dict[bytes, Array] = field(default_factory=dict, repr=False)


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
    memory: dict[tuple, Work | Array] = field(default_factory=dict, repr=False)

    @property
    def step_tolerance(self) -> float:
        """Local error of a step over the length scale."""
        return max(STEPS * self.tolerance, FINEST)

    def over(self, period: int) -> "PeriodMap":
        """The same over another number of mesh periods."""
        return replace(self, period=period)

    def packed(self, u: float) -> Packed:
        """The system at a parameter, model for the kernels."""
        system, frequency = self.family.at(float(np.exp(u)))
        return pack(system, frequency)

    def work(self, packed: Packed) -> Work:
        """Scratch space, kept for systems of one shape."""
        series = (len(packed.stiffness), len(packed.error), len(packed.load))
        key = (*packed.mesh_jacobian.shape, packed.contacts, *series)
        if key not in self.memory:
            self.memory[key] = make_work(packed, Settings(tolerance=self.step_tolerance).taylor_order)
        return cast(Work, self.memory[key])

    def weights(self, packed: Packed) -> Array:
        """z = weights * state, shape (2 n,)."""
        return np.tile(packed.weights[: packed.n] / packed.scale, 2)

    def state(self, z: Array, u: float) -> State:
        """Place and velocity by time of a weighted state."""
        packed = self.packed(u)
        values = z / self.weights(packed)
        _, frequency = self.family.at(float(np.exp(u)))
        return State(values[: packed.n].copy(), values[packed.n :] * frequency)

    def weighted(self, state: State, u: float) -> Array:
        """Weighted state of place and velocity by time."""
        _, frequency = self.family.at(float(np.exp(u)))
        return self.weights(self.packed(u)) * np.concatenate([state.displacement, state.velocity / frequency])

    def gap(self, z: Array, u: float) -> Array:
        """P(z, u) - z."""
        return self._gap(self.packed(u), z)

    def _gap(self, packed: Packed, z: Array) -> Array:
        none = np.zeros((0, 2, packed.omega_squared.size))
        weights = self.weights(packed)
        displacement, velocity, _ = self._run(packed, z / weights, none)
        return weights * np.concatenate([displacement, velocity]) - z

    def _run(self, packed: Packed, values: Array, tangents: Array) -> tuple[Array, Array, Log]:
        displacement, velocity = _split(packed, values)
        log = make_log(packed, self.period)
        work = self.work(packed)
        tolerance = self.step_tolerance
        longest = disturbance_step(packed, work.order, tolerance)
        status = run_periods(
            packed, work, displacement, velocity, tangents, self.period, 0, tolerance, log, longest
        )
        require(status)
        return displacement[: packed.n], velocity[: packed.n], log

    def linear(self, z: Array, u: float) -> Linear:
        """The map with its matrix and its slope at a state."""
        packed = self.packed(u)
        n, weights = packed.n, self.weights(packed)
        tangents = np.zeros((2 * n, 2, packed.omega_squared.size))
        rows = np.arange(n)
        tangents[rows, 0, rows] = 1.0
        tangents[n + rows, 1, rows] = 1.0
        displacement, velocity, log = self._run(packed, z / weights, tangents)
        matrix = tangents[:, :, :n].reshape(2 * n, 2 * n).T * (weights[:, None] / weights)
        gap = weights * np.concatenate([displacement, velocity]) - z
        step = PARAMETER_STEP
        slope = (self.gap(z, u + step) - self.gap(z, u - step)) / (2.0 * step)
        contact = (log.shares[1:, : packed.m].sum(axis=0) > 0.0) | (
            packed.lower[: packed.m] >= packed.upper[: packed.m]
        )
        for x in range(packed.contacts, packed.m, ROWS):
            contact[x : x + 2] = contact[x + 2]
        return Linear(
            gap=gap,
            matrix=matrix,
            slope=slope,
            contact=contact,
            afloat=self._rigid(packed, contact, weights),
            divergence=float(log.divergence[0]),
        )

    def _rigid(self, packed: Packed, contact: NDArray[np.bool_], weights: Array) -> Array:
        """Shifts that neither a mesh in contact nor a bearing feels: their multiplier is one."""
        key = (contact.tobytes(), weights.tobytes())
        if key not in self.memory:
            n = packed.n
            directions = packed.transposed[: packed.m, :n][contact] / np.abs(packed.transposed).max()
            held = np.concatenate([directions, np.diag(np.sign(packed.omega_squared[:n]))])
            _, sizes, rows = np.linalg.svd(held)
            free = rows[np.count_nonzero(sizes > RIGID) :]
            shifts = np.zeros((2 * n, len(free)))
            shifts[:n] = weights[:n, None] * free.T
            self.memory[key] = np.linalg.qr(shifts)[0]
        return cast(Array, self.memory[key])

    def turning(self, z: Array, u: float) -> Array:
        """Maxima and minima of each mesh deflection over the period, over the length scale.

        Shape (m, 2, most), each falling, and minus infinity where there are fewer.
        """
        packed = self.packed(u)
        displacement, velocity = _split(packed, z / self.weights(packed))
        values = np.full((packed.m, 2, MOST * self.period), -np.inf)
        counts = np.zeros((packed.m, 2), dtype=np.int64)
        work = self.work(packed)
        tolerance = self.step_tolerance
        longest = disturbance_step(packed, work.order, tolerance)
        require(
            turning_points(
                packed, work, displacement, velocity, self.period, tolerance, longest, values, counts
            )
        )
        return -np.sort(-values[:, :, : min(counts.max(), values.shape[2])]) / packed.scale

    def edges(self, u: float) -> tuple[Array, Array]:
        """Lower and upper edge of each mesh over the length scale; infinite where it never opens."""
        packed = self.packed(u)
        lower, upper = packed.lower[: packed.m] / packed.scale, packed.upper[: packed.m] / packed.scale
        closed = lower >= upper
        return np.where(closed, -np.inf, lower), np.where(closed, np.inf, upper)

    def images(self, z: Array, u: float) -> list[Array]:
        """The orbit's states at the starts of its mesh periods, the given one first."""
        one, found = self.over(1), [z]
        for _ in range(self.period - 1):
            found.append(found[-1] + one.gap(found[-1], u))
        return found


def _split(packed: Packed, values: Array) -> tuple[Array, Array]:
    wide = np.zeros((2, packed.omega_squared.size))
    wide[0, : packed.n], wide[1, : packed.n] = values[: packed.n], values[packed.n :]
    return wide[0], wide[1]
