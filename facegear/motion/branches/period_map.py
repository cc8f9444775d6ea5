"""Period map: the state after whole mesh periods as a function of state and parameter, in weighted states."""

from dataclasses import dataclass, field, replace
from typing import cast

import numpy as np

from facegear.arrays import Array, Mask
from facegear.motion.branches.family import Family, extrema
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.integrator.system import RING_ROWS
from facegear.motion.plan import State
from facegear.motion.requests import run_many
from facegear.motion.steady_state.orbits import monodromy

PARAMETER_STEP = 1e-5
"""Change of the parameter's logarithm in the central difference of the map."""
RATE_STEP = 1e-4
"""Step along a branch in the difference that tells how the map's matrix changes: far above the matrix's own
error, far below the steps of a branch."""
RIGID = 1e-10
"""Singular values below this, relative to the largest mesh Jacobian entry, mark directions that touch
nothing.
"""
STEPS = 0.1
"""Part of the tolerance to which each step is held: their errors add up."""
FINEST = 1e-14
"""Smallest local error of a step over the length scale: little above the rounding of the map."""


@dataclass(frozen=True, eq=False)
class Linear:
    """Linearised period map at a state.

    Attributes
    ----------
    gap : (2 n,) array
        Change of the weighted state over the period: end - start.
    matrix : (2 n, 2 n) array
        Derivative of the end with respect to the start.
    slope : (2 n,) array
        Derivative of the end with respect to the parameter's logarithm.
    contact : (meshes,) array
        Whether a mesh is ever in contact.
    neutral : (2 n, k) array
        Orthonormal directions in which bodies shift without touching anything.
    divergence : float
        Integral of the trace of the system's Jacobian over the period.
    inverses : dict
        Cache of bordered_matrix() inverses, by the bytes of the row (row.tobytes()); at most one entry.
    rates : dict
        Cache of the change of the matrix along directions, by their bytes; see PeriodMap.matrix_rate().
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
    """Map P(z, u) of a weighted state over `period` mesh periods at one parameter.

    A weighted state `z` (2 n,) holds positions, then velocities by mesh phase. Each is multiplied by the
    mesh deflection that a unit of its coordinate makes, over the length scale, and so dimensionless. `u`
    is the natural logarithm of the family's parameter. A fixed point P(z, u) = z is a periodic motion.

    Attributes
    ----------
    family : Family
        Systems, by their parameter.
    period : int
        Number of mesh periods.
    tolerance : float
        Approximate error of orbits, in length scales, and of special points, relative to the parameter.
    memory : dict
        Cache: an integrator for each structure of system, whose scratch space is shared, and neutral
        directions by the contacts that are closed. All maps made by over() share it.
    """

    family: Family
    period: int = 1
    tolerance: float = 1e-10
    memory: dict[tuple, Integrator | Array] = field(default_factory=dict, repr=False)

    @property
    def step_tolerance(self) -> float:
        """Local error of an integration step over the length scale: STEPS times the tolerance, at least
        FINEST.
        """
        return max(STEPS * self.tolerance, FINEST)

    def over(self, period: int) -> "PeriodMap":
        """Return the map over another number of mesh periods, in all and not as a multiple of this one's.

        Parameters
        ----------
        period : int
            Number of mesh periods.

        Returns
        -------
        PeriodMap
            Map of the same family with the same tolerance.
        """
        return replace(self, period=period)

    def integrator(self, u: float) -> Integrator:
        """Return the integrator of the system at a parameter.

        Integrators of systems with the same sizes share their scratch space.

        Parameters
        ----------
        u : float
            Logarithm of the parameter, dimensionless.

        Returns
        -------
        Integrator
            Integrator at the map's step tolerance.
        """
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
        new_integrator = Integrator(system, frequency, self.step_tolerance, like=like)
        self.memory.setdefault(key, new_integrator)
        return new_integrator

    def weights(self, integrator: Integrator) -> Array:
        """Weights that turn a state by phase into a weighted state: z = weights * state.

        Parameters
        ----------
        integrator : Integrator
            Integrates the system at one mesh frequency.

        Returns
        -------
        (2 n,) array
            Mesh deflection over the length scale per unit of each coordinate, 1/m; the n weights twice.
        """
        return np.tile(integrator.weights / integrator.scale, 2)

    def state(self, z: Array, u: float) -> State:
        """Return position and velocity by time of a weighted state.

        Parameters
        ----------
        z : (2 n,) array
            Weighted state, dimensionless.
        u : float
            Logarithm of the parameter, dimensionless.

        Returns
        -------
        State
            Displacement and velocity of the system's coordinates.
        """
        integrator = self.integrator(u)
        return integrator.by_time(self._by_phase(integrator, z))

    def _by_phase(self, integrator: Integrator, z: Array) -> Array:
        """Return the state by phase (2, n), m and m/rad, of a weighted state z (2 n,)."""
        return (z / self.weights(integrator)).reshape(2, -1)

    def to_weighted(self, state: State, u: float) -> Array:
        """Return the weighted state of position and velocity by time.

        Parameters
        ----------
        state : State
            Displacement and velocity of the system's coordinates.
        u : float
            Logarithm of the parameter, dimensionless.

        Returns
        -------
        (2 n,) array
            Weighted state, dimensionless.
        """
        integrator = self.integrator(u)
        return self.weights(integrator) * integrator.by_phase(state).ravel()

    def gap(self, z: Array, u: float) -> Array:
        """Compute P(z, u) - z, the change of a state over the period; it vanishes on a periodic orbit.

        Parameters
        ----------
        z : (2 n,) array
            Weighted state, dimensionless.
        u : float
            Logarithm of the parameter, dimensionless.

        Returns
        -------
        (2 n,) array
            Change of the weighted state, dimensionless.
        """
        integrator = self.integrator(u)
        end = integrator.run(self._by_phase(integrator, z), self.period, fine=True).state
        return self.weights(integrator) * end.ravel() - z

    def ends(self, states: Array, u: float, periods: int) -> list[Array]:
        """Run several states side by side and return where they are at the end of each mesh period.

        Parameters
        ----------
        states : (S, 2 n) array
            Weighted states at the start, dimensionless.
        u : float
            Logarithm of the parameter, dimensionless.
        periods : int
            Number of mesh periods.

        Returns
        -------
        list of array
            For each start the weighted states (periods, 2 n) at the ends of its mesh periods, dimensionless.
        """
        integrator = self.integrator(u)
        starts = [self._by_phase(integrator, z) for z in states]
        runs = run_many([integrator] * len(starts), starts, periods)
        return [self.weights(integrator) * run.ends.reshape(periods, -1) for run in runs]

    def linear(self, z: Array, u: float) -> Linear:
        """Linearise the map at a state: its matrix and its derivative by the parameter.

        The matrix is the monodromy matrix; the derivative is a central difference of PARAMETER_STEP.

        Parameters
        ----------
        z : (2 n,) array
            Weighted state, dimensionless.
        u : float
            Logarithm of the parameter, dimensionless.

        Returns
        -------
        Linear
            Gap, matrix, slope and neutral directions, dimensionless; arrays of 2 n rows (2 n, ...).
        """
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
        """Compute the change of the map's matrix per unit length along a direction of the branch.

        Parameters
        ----------
        x : (2 n + 1,) array
            Weighted state and logarithm of the parameter, dimensionless.
        tangent : (2 n + 1,) array
            Direction of length one, dimensionless.
        linear : Linear
            Linearised map at x. It stores the result in `rates`.

        Returns
        -------
        (2 n, 2 n) array
            Forward difference over RATE_STEP, dimensionless.
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
        """Return orthonormal shifts (2 n, k) of weighted states that neither a closed contact nor a
        bearing feels.

        `contact` (m,) tells which rows are ever in contact. These shifts are neutral: their multiplier is
        one.
        """
        key = (contact.tobytes(), weights.tobytes())
        if key not in self.memory:
            n = integrator.size
            jacobian = integrator.mesh_jacobian
            coupling = integrator.system.coupling
            constraints = np.concatenate(
                [
                    jacobian[contact] / np.abs(jacobian).max(),
                    np.diag(np.sign(integrator.omega_squared)),
                    *([coupling.displacement_terms(integrator.frequency)] if coupling else []),
                ]
            )
            _, sizes, rows = np.linalg.svd(constraints)
            free = rows[np.count_nonzero(sizes > RIGID) :]
            shifts = np.zeros((2 * n, len(free)))
            shifts[:n] = weights[:n, None] * free.T
            self.memory[key] = np.linalg.qr(shifts)[0]
        return cast(Array, self.memory[key])

    def extrema(self, z: Array, u: float) -> Array:
        """Maxima and minima of each mesh deflection over the period.

        Parameters
        ----------
        z : (2 n,) array
            Weighted state, dimensionless.
        u : float
            Logarithm of the parameter, dimensionless.

        Returns
        -------
        (m, 2, most) array
            Maxima, then minima of each mesh in falling order, over the length scale (dimensionless); minus
            infinity fills the rows that have fewer.
        """
        integrator = self.integrator(u)
        values = extrema(integrator, self._by_phase(integrator, z), self.period)
        return values / integrator.scale

    def edges(self, u: float) -> tuple[Array, Array]:
        """Backlash edges of each mesh over the length scale.

        Parameters
        ----------
        u : float
            Logarithm of the parameter, dimensionless.

        Returns
        -------
        tuple of array
            Lower and upper edge (m,) of each mesh, dimensionless; minus and plus infinity where a mesh
            never opens.
        """
        integrator = self.integrator(u)
        lower, upper = (edge / integrator.scale for edge in integrator.edges)
        never_opens = lower >= upper
        return np.where(never_opens, -np.inf, lower), np.where(never_opens, np.inf, upper)

    def images(self, z: Array, u: float) -> list[Array]:
        """Return the orbit's states at the starts of its mesh periods, the given one first.

        Parameters
        ----------
        z : (2 n,) array
            Weighted state, dimensionless.
        u : float
            Logarithm of the parameter, dimensionless.

        Returns
        -------
        list of array
            Weighted states (2 n,), one for each mesh period, dimensionless.
        """
        single, images = self.over(1), [z]
        for _ in range(self.period - 1):
            images.append(images[-1] + single.gap(images[-1], u))
        return images
