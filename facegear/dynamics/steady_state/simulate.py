"""Steady state of a machine at a speed: the public entry of the dynamics."""

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from facegear.dynamics.integrator.compiled import TAU, Packed, pack
from facegear.dynamics.integrator.reduction import Reduced, reduce
from facegear.dynamics.integrator.system import System, machine_system
from facegear.dynamics.integrator.work import make_work
from facegear.dynamics.motion import Motion, Settings, State
from facegear.dynamics.steady_state.exponent import largest_exponent
from facegear.dynamics.steady_state.settle import Settled, settle
from facegear.dynamics.steady_state.statistics import drifts
from facegear.dynamics.steady_state.window import Window, run_window
from facegear.errors import NotConverged
from facegear.transmission.machine import Machine, mesh_frequency
from facegear.transmission.matrices import mass_diagonal
from facegear.transmission.statics import static_equilibrium

Array = NDArray[np.float64]
ESCAPING = 1e-3
"""Growing disturbances of a motion that repeats as closely as this tell of its end, not of chaos."""


@dataclass(frozen=True, eq=False)
class SteadyState:
    """The response over `periods` mesh periods (the orbit's own period, else the window), sampled evenly.

    samples K = periods * per_period; deflections (K, meshes) in m with e(t) taken off, forces (K, meshes)
    elastic mesh forces k f(d) in N, coordinates (K, n); displacements(machine) gives all DOF. shares (3,
    meshes): fraction of time open, on the drive flank, on the back flank. residual: change over the period,
    over the length scale. multipliers (2 n,) of a refined periodic orbit. exponent: largest Lyapunov
    exponent per mesh period with its 95 % half-width, for motions that are not periodic.
    """

    motion: Motion
    period: int
    frequency: float
    residual: float
    periods: int
    per_period: int
    deflections: Array
    forces: Array
    coordinates: Array
    shares: Array
    multipliers: NDArray[np.complex128] | None
    liouville: float | None
    exponent: tuple[float, float] | None
    periods_run: int
    state: State

    @property
    def label(self) -> str:
        """`period-n` or the class of motion."""
        return f"period-{self.period}" if self.motion is Motion.PERIODIC else self.motion.value

    @property
    def phases(self) -> Array:
        """Time of each sample in mesh periods, shape (K,)."""
        return np.arange(self.periods * self.per_period) / self.per_period


@dataclass(frozen=True, eq=False)
class Model:
    """A machine made model: its reduction and system, to be used at many speeds."""

    machine: Machine
    reduced: Reduced
    system: System

    def displacements(self, response: SteadyState) -> Array:
        """Displacements (K, 4 bodies) in m and rad; the free rigid rotation is left out."""
        return response.coordinates @ self.reduced.basis.T


def build_model(machine: Machine) -> Model:
    """Reduce a machine once for all speeds."""
    reduced = reduce(machine)
    return Model(machine, reduced, machine_system(machine, reduced))


def static_start(model: Model) -> State:
    """At rest in the static equilibrium with mean stiffness."""
    standing = static_equilibrium(model.machine).displacements
    displacement = model.reduced.basis.T @ (mass_diagonal(model.machine.layout) * standing)
    return State(displacement, np.zeros_like(displacement))


def simulate(
    model: Model | Machine, speed_rpm: float, settings: Settings | None = None, start: State | None = None
) -> SteadyState:
    """Steady state at a pinion speed, from `start` or from static equilibrium.

    Raises NotConverged if the integration itself fails; a motion that does not settle is a result, named so.
    """
    model = build_model(model) if isinstance(model, Machine) else model
    frequency = TAU * mesh_frequency(model.machine.layout, speed_rpm)
    start = static_start(model) if start is None else start
    try:
        return steady_state(model.system, frequency, settings or Settings(), start)
    except NotConverged as error:
        raise NotConverged(error.stage, f"{speed_rpm:g} rpm", error.tried) from None


def simulate_many(
    jobs: Sequence[tuple[Model | Machine, float]], settings: Settings, threads: int = 1
) -> list[SteadyState]:
    """simulate() for many (machine, speed), on threads: the compiled part runs without the interpreter's
    lock.
    """
    if threads <= 1:
        return [simulate(machine, speed, settings) for machine, speed in jobs]
    with ThreadPoolExecutor(threads) as pool:
        return list(pool.map(lambda job: simulate(job[0], job[1], settings), jobs))


def steady_state(system: System, frequency: float, settings: Settings, start: State) -> SteadyState:
    """Steady state of any system at an angular mesh frequency in rad/s."""
    packed = pack(system, frequency)
    work = make_work(packed, settings.taylor_order)
    displacement, velocity = (
        _widened(packed, start.displacement),
        _widened(packed, start.velocity / frequency),
    )
    exponent, window, periods_run = None, None, 0
    motion = Motion.PERIODIC
    for times in range(settings.extensions + 1):
        extended = settings.extended(times)
        settled = settle(packed, work, displacement, velocity, extended)
        periods_run += settled.periods_run
        if settled.period:
            motion, exponent = Motion.PERIODIC, None
            displacement, velocity = settled.displacement, settled.velocity
            window = run_window(packed, work, displacement, velocity, settled.period, settings)
            break
        motion, exponent, window = largest_exponent(
            packed, work, settled.displacement, settled.velocity, extended
        )
        if motion is Motion.CHAOTIC and settled.residual < ESCAPING:
            motion = Motion.NOT_SETTLED
        displacement, velocity = window.displacement, window.velocity
        if motion is not Motion.NOT_SETTLED:
            break
    return _result(packed, system, frequency, settings, settled, window, motion, exponent, periods_run)


def _result(
    packed: Packed,
    system: System,
    frequency: float,
    settings: Settings,
    settled: Settled,
    window: Window,
    motion: Motion,
    exponent: tuple[float, float] | None,
    periods_run: int,
) -> SteadyState:
    deflections, forces = mesh_response(system, window.samples, settings.samples)
    orbit = settled.orbit
    if motion in (Motion.CHAOTIC, Motion.QUASI_PERIODIC) and drifts(deflections, settings.samples):
        motion = Motion.NOT_SETTLED
    return SteadyState(
        motion=motion,
        period=settled.period,
        frequency=frequency,
        residual=settled.residual,
        periods=window.periods,
        per_period=settings.samples,
        deflections=deflections,
        forces=forces,
        coordinates=window.samples,
        shares=mesh_shares(system, window.shares / (TAU * window.periods)),
        multipliers=orbit.multipliers if orbit else None,
        liouville=orbit.liouville if orbit else None,
        exponent=exponent,
        periods_run=periods_run,
        state=State(window.displacement[: packed.n].copy(), window.velocity[: packed.n] * frequency),
    )


def mesh_response(system: System, coordinates: Array, per_period: int) -> tuple[Array, Array]:
    """Deflections and elastic mesh forces (K, meshes) of samples that start with a mesh period."""
    cycles = np.arange(per_period) / per_period
    error = series_values(system.error, cycles)[:, system.error_kind]
    stiffness = series_values(system.stiffness, cycles)
    for kind, piece in enumerate(system.pieces):
        index = np.searchsorted(piece.breaks, cycles, side="right") - 1
        ahead = cycles - piece.breaks[index]
        stiffness[:, kind] += (
            piece.coefficients[index] * np.vander(ahead, piece.coefficients.shape[1], True)
        ).sum(1)
    stiffness = stiffness[:, system.stiffness_kind]
    shape = (-1, per_period, len(system.mesh_jacobian))
    deflections = (coordinates @ system.mesh_jacobian.T).reshape(shape)
    deflections -= error
    if system.two_flanks:
        return flank_response(system, deflections.reshape(len(coordinates), -1), stiffness)
    # Without clearance everything counts from the upper edge.
    linear = system.lower >= system.upper
    lower, upper = (np.where(linear, system.upper, edge) for edge in (system.lower, system.upper))
    forces = np.clip(deflections, lower, upper)
    np.subtract(deflections, forces, out=forces)
    forces *= stiffness
    return deflections.reshape(len(coordinates), -1), forces.reshape(len(coordinates), -1)


def flank_response(system: System, deflections: Array, stiffness: Array) -> tuple[Array, Array]:
    """Tangential deflection and transmitted force of each mesh (K, meshes) from its flanks (K, 2 meshes).

    stiffness (per_period, 2 meshes) repeats.
    """
    over = (deflections - system.upper).reshape(-1, *stiffness.shape)
    forces = (np.maximum(over, 0.0) * stiffness).reshape(deflections.shape)
    over = over.reshape(deflections.shape)
    meshes = deflections.shape[1] // 2
    tangential = 0.5 * (over[:, :meshes] - over[:, meshes:])
    return tangential, forces[:, :meshes] - forces[:, meshes:]


def mesh_shares(system: System, shares: Array) -> Array:
    """Time open, on the drive and on the back flank (3, meshes) from that of each flank, where there are two.

    Time with both flanks wedged counts on both, so that the three may add up to more than one.
    """
    if not system.two_flanks:
        return shares
    drive, back = np.split(shares[1], 2)
    return np.stack([np.maximum(1.0 - drive - back, 0.0), drive, back])


def series_values(series: Array, cycles: Array) -> Array:
    """Values of Fourier rows (kinds, 2, harmonics + 1) at times in mesh periods, shape (times, kinds)."""
    angle = TAU * np.outer(cycles, np.arange(series.shape[2]))
    return np.sin(angle) @ series[:, 0].T + np.cos(angle) @ series[:, 1].T


def _widened(packed: Packed, values: Array) -> Array:
    wide = np.zeros(packed.omega_squared.size)
    wide[: packed.n] = values
    return wide
