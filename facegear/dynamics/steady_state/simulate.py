"""Steady state of a machine at a speed: the public entry of the dynamics."""

from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from facegear.arrays import Array, ComplexArray
from facegear.by_content import kept_by_content
from facegear.dynamics.courses import Course, alone
from facegear.dynamics.integrator.compiled import TAU
from facegear.dynamics.integrator.integrator import Integrator
from facegear.dynamics.integrator.reduction import Reduced, reduce
from facegear.dynamics.integrator.system import System, machine_system
from facegear.dynamics.motion import Motion, Settings, State
from facegear.dynamics.steady_state.averages import Averages, Moments
from facegear.dynamics.steady_state.guide import Guide
from facegear.dynamics.steady_state.mesh_samples import (
    by_mesh,
    each_deflection,
    mesh_forces,
    mesh_fractions,
    past_law,
)
from facegear.dynamics.steady_state.orbits import Orbit
from facegear.dynamics.steady_state.prepare import prepare_for
from facegear.dynamics.steady_state.second_look import disagreeing
from facegear.dynamics.steady_state.watching import Begun, Watched, begin, not_settled, watch
from facegear.errors import NotConverged
from facegear.transmission.machine import Machine, mesh_frequency
from facegear.transmission.statics import static_equilibrium


@dataclass(frozen=True, eq=False)
class SteadyState:
    """The response over K = periods * per_period samples, evenly spaced.

    `displacements(machine)` gives all DOF.

    Attributes
    ----------
    system
        What was integrated.
    motion
        Class of motion.
    period
        In mesh periods where the motion is periodic, else 0.
    frequency
        Angular mesh frequency, rad/s.
    residual
        Change over the period, over the length scale.
    periods, per_period
        Mesh periods (the orbit's own period, else the window) and samples in each.
    deflections : (K, meshes)
        With e(t) taken off, m.
    coordinates : (K, n)
        Of the system.
    averages
        Over the whole response.
    fractions : (3, meshes)
        Of time open, on the drive flank, on the back flank.
    orbit
        The periodic orbit where it was refined on its own.
    exponent
        Largest Lyapunov exponent per mesh period with its 95 % half-width, for motions that are not periodic.
    periods_run
        For how many mesh periods the motion was watched in all before it was named so.
    looks
        Mesh periods of the motion that this start and another one came to (0: none), where the two differ
        and the motion is called not settled for that reason alone; else None.
    state
        At the end.
    """

    system: System
    motion: Motion
    period: int
    frequency: float
    residual: float
    periods: int
    per_period: int
    deflections: Array
    coordinates: Array
    averages: Averages
    fractions: Array
    orbit: Orbit | None
    exponent: tuple[float, float] | None
    periods_run: int
    looks: tuple[int, int] | None
    state: State

    @property
    def label(self) -> str:
        """`period-n` or the class of motion."""
        return f"period-{self.period}" if self.motion is Motion.PERIODIC else self.motion.value

    @property
    def multipliers(self) -> ComplexArray | None:
        """Floquet multipliers (2 n,) of the orbit."""
        return None if self.orbit is None else self.orbit.multipliers

    @property
    def liouville(self) -> float | None:
        """As of the orbit."""
        return None if self.orbit is None else self.orbit.liouville

    @cached_property
    def forces(self) -> Array:
        """Elastic mesh forces k f(d) of the samples (K, meshes), N."""
        return mesh_forces(self.system, self._each, self.per_period)

    @cached_property
    def _each(self) -> Array:
        """Deflections of each mesh or flank."""
        if not self.system.two_flanks:
            return self.deflections
        return each_deflection(self.system, self.coordinates, self.per_period)

    @property
    def past_law(self) -> Array:
        """Fraction of samples (meshes,) at which a mesh is pressed in past the last level of its law."""
        if self.system.law.straight:
            return np.zeros(self.deflections.shape[1])
        return past_law(self.system, self._each)

    @property
    def moments(self) -> Moments:
        """Mean, RMS, extremes of the mesh deflections, m, exact for the steps' polynomials."""
        return self.averages.meshes(self.motion is Motion.PERIODIC)

    @property
    def mean_forces(self) -> Array:
        """Mean and mean magnitude (2, meshes) of the elastic mesh forces, N."""
        return self.averages.force

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
    linear = machine.linear
    any_clearance = replace(linear.rings, clearance=np.ones_like(linear.rings.clearance))
    reduced = _reduced(replace(linear, rings=any_clearance), machine.layout.contacts, machine.pushes)
    return Model(machine, reduced, machine_system(machine, reduced))


_reduced = kept_by_content(4)(reduce)
"""What has the same masses, bearings and contacts is reduced once, whatever its errors and clearances."""


def static_start(model: Model) -> State:
    """At rest in the static equilibrium with mean stiffness."""
    standing = static_equilibrium(model.machine).displacements
    displacement = model.reduced.basis.T @ model.machine.linear.momentum(standing)
    return State(displacement, np.zeros_like(displacement))


def simulate(
    model: Model | Machine,
    speed_rpm: float,
    settings: Settings | None = None,
    start: State | None = None,
    guide: Guide | None = None,
) -> SteadyState:
    """Steady state at a pinion speed, from `start` or from static equilibrium.

    A `guide`, an orbit of a like machine, is followed where it serves; then no multipliers are computed.
    Raises NotConverged if the integration itself fails; a motion that does not settle is a result, named so.
    """
    return alone(simulating(model, speed_rpm, settings, start, guide))


def simulating(
    model: Model | Machine,
    speed_rpm: float,
    settings: Settings | None = None,
    start: State | None = None,
    guide: Guide | None = None,
) -> Course[SteadyState]:
    """simulate() as a course, for many side by side."""
    return (yield from (yield from started(model, speed_rpm, settings, start, guide)).followed())


@dataclass(frozen=True, eq=False)
class Started:
    """A motion at a pinion speed that was watched for the first time."""

    system: System
    begun: Begun
    speed_rpm: float

    @property
    def state(self) -> State:
        """What it may hand on to a motion at another speed: a state of its own, the last that was seen."""
        return self.begun.integrator.by_time(self.begun.state)

    def followed(self) -> Course[SteadyState]:
        """The steady state that is left of it when it is watched until its class is known, and looked at
        again.
        """
        with _naming(self.speed_rpm):
            return (yield from _steady(self.system, self.begun))


def started(
    model: Model | Machine,
    speed_rpm: float,
    settings: Settings | None = None,
    start: State | None = None,
    guide: Guide | None = None,
) -> Course[Started]:
    """The first watch of simulate()."""
    model = build_model(model) if isinstance(model, Machine) else model
    frequency = TAU * mesh_frequency(model.machine.layout, speed_rpm)
    start = static_start(model) if start is None else start
    with _naming(speed_rpm):
        begun = yield from _begun(model.system, frequency, settings or Settings(), start, guide)
    return Started(model.system, begun, speed_rpm)


@contextmanager
def _naming(speed_rpm: float) -> Iterator[None]:
    """What does not converge is said to be at a speed."""
    try:
        yield
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


def steady_state(
    system: System, frequency: float, settings: Settings, start: State, guide: Guide | None = None
) -> SteadyState:
    """Steady state of any system at an angular mesh frequency in rad/s.

    A class of motion that does not come out again from starts a little aside is taken back: then the motion
    is not settled, and `looks` says why.
    """

    def course() -> Course[SteadyState]:
        return (yield from _steady(system, (yield from _begun(system, frequency, settings, start, guide))))

    return alone(course())


def _begun(
    system: System, frequency: float, settings: Settings, start: State, guide: Guide | None
) -> Course[Begun]:
    """The first watch of a system from a start."""
    prepare_for(system)
    integrator = Integrator(system, frequency, settings.tolerance, settings.order)
    serves = guide is not None and settings.refine and guide.serves(system)
    return begin(integrator, integrator.by_phase(start), settings, guide if serves else None)


def _steady(system: System, begun: Begun) -> Course[SteadyState]:
    """The steady state that a run comes to, and whether it holds from other starts."""
    integrator, settings = begun.integrator, begun.settings
    seen = yield from watch(begun)
    first, states = seen.settled, seen.window.ends
    looked = disagreeing(integrator, begun.start, settings, first, seen.motion, states, seen.wandered)
    other, looks = (yield from looked), None
    if other is not None:
        looks = (first.period, other.period)
        seen = yield from not_settled(integrator, seen, other, settings)
    return _response(system, integrator, seen, looks)


def _response(
    system: System, integrator: Integrator, seen: Watched, looks: tuple[int, int] | None
) -> SteadyState:
    settled, window, exponent = seen.settled, seen.window, seen.exponent
    each = each_deflection(system, window.samples, window.per_period)
    averages, square = window.averages, integrator.frequency**2
    return SteadyState(
        system=system,
        motion=seen.motion,
        period=settled.period,
        frequency=integrator.frequency,
        residual=settled.residual,
        periods=window.periods,
        per_period=window.per_period,
        deflections=by_mesh(system, each),
        coordinates=window.samples,
        averages=replace(averages, force=averages.force * square, pull=averages.pull * square),
        fractions=mesh_fractions(system, window.fractions[:, : system.contacts], each),
        orbit=settled.orbit,
        exponent=(exponent.value, exponent.half_width) if exponent else None,
        periods_run=seen.periods_run,
        looks=looks,
        state=integrator.by_time(window.ends[-1]),
    )
