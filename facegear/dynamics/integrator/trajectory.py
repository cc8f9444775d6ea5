"""Dense output: the Taylor polynomials of every step, for extremes and integrals to full accuracy."""

from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array, Integers
from facegear.dynamics.integrator.advance import advance, after, move
from facegear.dynamics.integrator.compiled import TAU, Packed
from facegear.dynamics.integrator.integrator import Integrator
from facegear.dynamics.integrator.kernel import kernel
from facegear.dynamics.integrator.system import System
from facegear.dynamics.integrator.work import Work
from facegear.dynamics.motion import Settings, State
from facegear.errors import NotConverged

MAX_STEPS = 200_000


@kernel
def step(
    packed: Packed, work: Work, s: float, stop: float, displacement: Array, velocity: Array, tolerance: float
) -> tuple[float, float]:
    """Make one step from s: displacement and velocity (n,) are moved, work holds its polynomials.

    Returns its length and the phase at its end.
    """
    length = advance(packed, work, s, stop, displacement, velocity, tolerance)
    move(work, length, displacement, velocity)
    return length, after(s, length)


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
    packed, work = integrator.packed, integrator.work
    displacement, velocity = integrator.padded(integrator.by_phase(state))
    starts, lengths, coordinates, deflections, states = [], [], [], [], []
    for period in range(periods):
        s = 0.0
        while s < TAU:
            starts.append(period * TAU + s)
            length, s = step(packed, work, s, TAU, displacement, velocity, settings.tolerance)
            lengths.append(length)
            coordinates.append(work.y[:, : packed.n].copy())
            polynomial = work.deflection[:, : packed.m].copy()
            polynomial[0] += work.edge[: packed.m]
            deflections.append(polynomial)
            states.append(work.state[: packed.m].copy())
            if len(starts) > MAX_STEPS or not np.isfinite(length):
                raise NotConverged("dynamics", f"mesh phase {s:.6g} rad", f"{len(starts)} steps")
    return Trajectory(
        frequency,
        np.array(starts),
        np.array(lengths),
        np.array(coordinates),
        np.array(deflections),
        np.array(states),
    )
