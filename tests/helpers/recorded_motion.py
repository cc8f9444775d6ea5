"""Dense output: the Taylor polynomials of every step, for extremes and integrals to full accuracy."""

from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array, Integers
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.integrator.kernel_system import TAU
from facegear.motion.integrator.system import System
from facegear.motion.plan import Settings, State

ROOM = 256
"""Steps of a period that there is room for before their number is known."""


@dataclass(frozen=True, eq=False)
class Trajectory:
    """Polynomials of S steps in the mesh phase s (rad), which runs on over the periods.

    starts, lengths (S,); coordinates (S, order + 1, n) and deflections (S, order + 1, meshes), ascending
    powers of the phase since the start of the step; states (S, meshes): 0 open, p in piece p of
    the law on the drive flank, -p on the back flank.
    """

    frequency: float
    starts: Array
    lengths: Array
    coordinates: Array
    deflections: Array
    states: Integers

    def at(self, phases: Array) -> tuple[Array, Array]:
        """Coordinates (K, n) and deflections (K, meshes) at mesh phases (K,) in rad."""
        step = np.clip(np.searchsorted(self.starts, phases, side="right") - 1, 0, self.starts.size - 1)
        ahead = (phases - self.starts[step])[:, None] ** np.arange(self.coordinates.shape[1])
        return (
            np.einsum("kp,kpn->kn", ahead, self.coordinates[step]),
            np.einsum("kp,kpm->km", ahead, self.deflections[step]),
        )

    def quadrature(self, points: int = 12) -> tuple[Array, Array]:
        """Phases (S * points,) and weights in rad for integrals over the run, exact to the steps' order."""
        nodes, weights = np.polynomial.legendre.leggauss(points)
        phases = self.starts[:, None] + 0.5 * self.lengths[:, None] * (1.0 + nodes)
        return phases.ravel(), (0.5 * self.lengths[:, None] * weights).ravel()

    def extremes(self, mesh: int) -> tuple[float, float]:
        """Least and largest deflection of a mesh, from the zeros of the polynomials' derivatives."""
        values = []
        for length, polynomial in zip(self.lengths, self.deflections[:, :, mesh], strict=True):
            scaled = np.polynomial.Polynomial(polynomial * length ** np.arange(polynomial.size))
            turning = scaled.deriv().roots()
            real = turning[np.abs(turning.imag) < 1e-9].real
            inside = real[(real > 0.0) & (real < 1.0)]
            values += scaled(np.concatenate([[0.0, 1.0], inside])).tolist()
        return min(values), max(values)


def record(
    system: System, frequency: float, state: State, periods: int, settings: Settings | None = None
) -> Trajectory:
    """Run whole mesh periods from a state and keep every step. Raises NotConverged if a step fails."""
    settings = settings or Settings()
    integrator = Integrator(system, frequency, settings.tolerance, settings.order)
    moved, runs = integrator.by_phase(state), []
    for _ in range(periods):
        end, count, steps = integrator.steps(moved, 1, ROOM)
        if count > ROOM:
            end, count, steps = integrator.steps(moved, 1, count)
        runs.append([part[:count] for part in steps])
        moved = end
    starts, *others = zip(*runs, strict=True)
    phases = [period * TAU + start for period, start in enumerate(starts)]
    return Trajectory(frequency, np.concatenate(phases), *(np.concatenate(parts) for parts in others))
