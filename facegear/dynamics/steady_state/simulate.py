"""Steady state of a machine at a speed: the public entry of the dynamics."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.courses import Course, alone
from facegear.dynamics.integrator.compiled import TAU
from facegear.dynamics.integrator.integrator import Integrator
from facegear.dynamics.integrator.reduction import Reduced, reduce
from facegear.dynamics.integrator.system import System, machine_system
from facegear.dynamics.motion import Settings, State
from facegear.dynamics.steady_state.guide import Guide
from facegear.dynamics.steady_state.known_orbit import KnownOrbit
from facegear.dynamics.steady_state.mirror_images import (
    held_after,
    start_on_image,
    symmetries_of_start,
    with_chosen_image,
)
from facegear.dynamics.steady_state.response import SteadyState, response_of
from facegear.dynamics.steady_state.second_look import disagreeing
from facegear.dynamics.steady_state.watching import Begun, begin, not_settled, watch
from facegear.dynamics.symmetries import Symmetry
from facegear.errors import NotConverged
from facegear.transmission.loaded_modes import machine_in_motion
from facegear.transmission.machine import Machine, mesh_frequency
from facegear.transmission.statics import static_equilibrium


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
    """Reduce a machine once for all speeds. Raises NotConverged where its equilibrium is not found."""
    machine = machine_in_motion(machine)
    reduced = _reduced(machine.without_errors)
    return Model(machine, reduced, _excited(machine, reduced.basis, machine_system(machine, reduced)))


def _excited(machine: Machine, basis: Array, system: System) -> System:
    """The system with its periodic torques. Raises InvalidInput where one does not repeat with the mesh."""
    if not machine.excitations:
        return system
    last = max(excitation.mesh_harmonic for excitation in machine.excitations)
    load = np.zeros((system.size, 2, max(last + 1, system.load.shape[2])))
    load[:, :, : system.load.shape[2]] = system.load
    for excitation in machine.excitations:
        force = excitation.amplitude * (basis.T @ machine.straining_torque(excitation.body))
        number = excitation.mesh_harmonic
        load[:, 0, number] -= np.sin(excitation.phase) * force
        load[:, 1, number] += np.cos(excitation.phase) * force
    return replace(system, load=load)


@lru_cache(maxsize=8)
def _reduced(machine: Machine) -> Reduced:
    return reduce(machine.linear, machine.layout.contacts, machine.pushes)


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
    """A motion at a pinion speed that was watched for the first time; start_held: symmetries of its start."""

    system: System
    begun: Begun
    speed_rpm: float
    start_held: tuple[Symmetry, ...] = ()

    @property
    def known(self) -> bool:
        """Whether it came to the orbit that was known before, so that nothing is left to follow."""
        return self.begun.settled.known

    @property
    def state(self) -> State:
        """What it may hand on to a motion at another speed: a state of its own, the last that was seen."""
        return self.begun.integrator.by_time(self.begun.state)

    @property
    def held(self) -> tuple[Symmetry, ...]:
        """The symmetries of the motion that it hands on."""
        return held_after(self.begun, self.system)

    def followed(self) -> Course[SteadyState]:
        """The steady state that is left of it when it is watched until its class is known, and looked at
        again. Of a motion that has settled only after its first watch the image is chosen here.
        """
        with _naming(self.speed_rpm):
            response = yield from _steady(self.system, self.begun)
            late = self.begun.seen is None and self.start_held
            image = start_on_image(response, self.start_held) if late else None
            if image is None:
                return response
            integrator = self.begun.integrator
            begun = yield from begin(integrator, integrator.by_phase(image), self.begun.settings)
            again = yield from _steady(self.system, begun)
        run = response.periods_run + again.periods_run
        return replace(again, periods_run=run) if again.label == response.label else response


def started(
    model: Model | Machine,
    speed_rpm: float,
    settings: Settings | None = None,
    start: State | None = None,
    guide: Guide | None = None,
    known: KnownOrbit | None = None,
    held: Sequence[Symmetry] | None = None,
) -> Course[Started]:
    """The first watch of simulate(); it is over where the run comes to a `known` orbit of the model.

    held: symmetries of what the start belongs to, by default of the start itself. Where the run breaks one,
    which of the mirror images it takes is a matter of rule. A guide leads to the image next to it.
    """
    model = build_model(model) if isinstance(model, Machine) else model
    frequency = TAU * mesh_frequency(model.machine.layout, speed_rpm)
    start = static_start(model) if start is None else start
    with _naming(speed_rpm):
        begun = yield from _begun(model.system, frequency, settings or Settings(), start, guide, known)
        if guide is None and not begun.settled.known:
            held = symmetries_of_start(model.system, start) if held is None else held
            begun = yield from with_chosen_image(begun, model.system, held)
    return Started(model.system, begun, speed_rpm, tuple(held or ()))


@contextmanager
def _naming(speed_rpm: float) -> Iterator[None]:
    """What does not converge is said to be at a speed."""
    try:
        yield
    except NotConverged as error:
        raise NotConverged(error.stage, f"{speed_rpm:g} rpm", error.tried) from None


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
    system: System,
    frequency: float,
    settings: Settings,
    start: State,
    guide: Guide | None,
    known: KnownOrbit | None = None,
) -> Course[Begun]:
    """The first watch of a system from a start."""
    guide = guide if guide is not None and settings.refine and guide.serves(system) else None
    like = None if guide is None else guide.integrator
    integrator = Integrator(system, frequency, settings.tolerance, settings.order, like)
    return begin(integrator, integrator.by_phase(start), settings, guide, known)


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
    return response_of(system, integrator, seen, looks)
