"""Steady state of a machine at a speed: the public entry of the dynamics."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from facegear.arrays import Array
from facegear.errors import NotConverged
from facegear.machine.loaded_modes import machine_in_motion
from facegear.machine.machine import Machine, mesh_frequency
from facegear.machine.statics import static_equilibrium
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.integrator.kernel_system import TAU
from facegear.motion.integrator.reduction import Reduction, reduce
from facegear.motion.integrator.system import System, machine_system
from facegear.motion.plan import Look, Settings, State
from facegear.motion.requests import RunPlan, alone
from facegear.motion.steady_state.guide import Guide
from facegear.motion.steady_state.mirror_images import (
    held_after,
    start_on_image,
    symmetries_of_start,
    with_chosen_image,
)
from facegear.motion.steady_state.periodicity import KnownOrbit
from facegear.motion.steady_state.response import SteadyState, response_of
from facegear.motion.steady_state.second_look import find_disagreement, withdraw_class
from facegear.motion.steady_state.watch import FirstWatch, begin, watch
from facegear.motion.symmetries import Symmetry


@dataclass(frozen=True, eq=False)
class Model:
    """A machine with its reduced coordinates and equations of motion, to be used at many speeds; see
    build_model().
    """

    machine: Machine
    reduction: Reduction
    system: System

    def displacements(self, response: SteadyState) -> Array:
        """Compute the displacements along all coordinates of the linear model (LinearModel.labels),
        without the free rigid rotation.

        Parameters
        ----------
        response : SteadyState
            Response of this model.

        Returns
        -------
        (K, 4 bodies) array
            Displacements, m and rad.
        """
        return response.coordinates @ self.reduction.basis.T


def build_model(machine: Machine) -> Model:
    """Reduce a machine's coordinates, without truncation, and make its equations of motion, once for all
    speeds.

    Parameters
    ----------
    machine : Machine
        Machine with meshes, bodies and springs.

    Returns
    -------
    Model
        Reduced machine.

    Raises
    ------
    NotConverged
        If its static equilibrium is not found.
    InvalidInput
        If a periodic torque does not repeat with the mesh.
    """
    machine = machine_in_motion(machine)
    reduction = _cached_reduction(machine.without_errors)
    return Model(machine, reduction, _excited(machine, reduction.basis, machine_system(machine, reduction)))


def _excited(machine: Machine, basis: Array, system: System) -> System:
    """Return the system with the load of the machine's periodic torques added. Raises InvalidInput.

    `basis` (dof, n) is that of the reduction. InvalidInput is raised where a torque does not repeat with
    the mesh.
    """
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
def _cached_reduction(machine: Machine) -> Reduction:
    """Reduce the coordinates of a machine without errors; the result is shared by equal machines and must
    not be changed.
    """
    return reduce(machine.linear, machine.layout.contacts, machine.pushes)


def static_start(model: Model) -> State:
    """Return the state at rest in the static equilibrium with mean stiffness, in reduced coordinates.

    Parameters
    ----------
    model : Model
        Reduced machine.

    Returns
    -------
    State
        Displacement (n,) and velocity (n,), which is zero.
    """
    displacements = static_equilibrium(model.machine).displacements
    displacement = model.reduction.basis.T @ model.machine.linear.momentum(displacements)
    return State(displacement, np.zeros_like(displacement))


def simulate(
    model: Model | Machine,
    speed_rpm: float,
    settings: Settings | None = None,
    start: State | None = None,
    guide: Guide | None = None,
) -> SteadyState:
    """Compute the steady state of a machine at a pinion speed, from `start` or from static equilibrium.

    The machine is integrated until its motion repeats, and the periodic orbit is refined by Newton's
    method. A motion that does not repeat is classified by its largest Lyapunov exponent.

    Parameters
    ----------
    model : Model or Machine
        Machine, reduced or not.
    speed_rpm : float
        Pinion speed, rpm.
    settings : Settings, optional
        Settings of the run.
    start : State, optional
        Start; the static equilibrium if None.
    guide : Guide, optional
        Orbit of a similar machine, which is followed where it serves; then no multipliers are computed.

    Returns
    -------
    SteadyState
        Response. A motion that does not settle is a result, too, and is labelled so.

    Raises
    ------
    NotConverged
        If the integration itself fails.
    """
    return alone(simulating(model, speed_rpm, settings, start, guide))


def simulating(
    model: Model | Machine,
    speed_rpm: float,
    settings: Settings | None = None,
    start: State | None = None,
    guide: Guide | None = None,
) -> RunPlan[SteadyState]:
    """Return the run plan of simulate(), to compute many steady states side by side with side_by_side().

    Parameters
    ----------
    model : Model or Machine
        Machine, reduced or not.
    speed_rpm : float
        Pinion speed, rpm.
    settings : Settings, optional
        Settings of the run.
    start : State, optional
        Start; the static equilibrium if None.
    guide : Guide, optional
        Orbit of a similar machine, see simulate().

    Returns
    -------
    RunPlan of SteadyState
        Generator for requests.alone() or side_by_side(), which returns the response.
    """
    return (yield from (yield from start_run(model, speed_rpm, settings, start, guide)).follow())


@dataclass(frozen=True, eq=False)
class StartedRun:
    """A run at a pinion speed after its first watch.

    Attributes
    ----------
    system : System
        Equations of motion.
    first_watch : FirstWatch
        The run up to where it settled or was first taken not to settle.
    speed_rpm : float
        Pinion speed.
    start_symmetries : tuple of Symmetry
        Symmetries of the motion to which the start belongs.
    """

    system: System
    first_watch: FirstWatch
    speed_rpm: float
    start_symmetries: tuple[Symmetry, ...] = ()

    @property
    def is_known_orbit(self) -> bool:
        """Whether the run came to the orbit that was known before, so that nothing is left to compute."""
        return self.first_watch.settling_result.is_known_orbit

    @property
    def state(self) -> State:
        """State that the run may hand on to a motion at another speed: the last that was computed."""
        return self.first_watch.integrator.by_time(self.first_watch.state)

    @property
    def motion_symmetries(self) -> tuple[Symmetry, ...]:
        """Symmetries that map the motion the run hands on to itself; all of the system where it has not
        settled.
        """
        return held_after(self.first_watch, self.system)

    def follow(self) -> RunPlan[SteadyState]:
        """Watch the run until its class is known, and check the class from other starts.

        For a motion that has settled only after its first watch, the mirror image is chosen here.

        Returns
        -------
        RunPlan of SteadyState
            Generator for requests.alone() or side_by_side(), which returns the response.
        """
        with _naming(self.speed_rpm):
            response = yield from _steady(self.system, self.first_watch)
            late = self.first_watch.watch_result is None and self.start_symmetries
            image = start_on_image(response, self.start_symmetries) if late else None
            if image is None:
                return response
            integrator = self.first_watch.integrator
            next_watch = yield from begin(integrator, integrator.by_phase(image), self.first_watch.settings)
            again = yield from _steady(self.system, next_watch)
        run = response.periods_run + again.periods_run
        return replace(again, periods_run=run) if again.label == response.label else response


def start_run(
    model: Model | Machine,
    speed_rpm: float,
    settings: Settings | None = None,
    start: State | None = None,
    guide: Guide | None = None,
    known_orbit: KnownOrbit | None = None,
    start_symmetries: Sequence[Symmetry] | None = None,
) -> RunPlan[StartedRun]:
    """Return the run plan of the first part of simulate(): a run until it settles, or is first taken not
    to settle.

    The rest is StartedRun.follow(). A run that comes to `known_orbit` ends there.

    Where the run breaks a symmetry of its start, a rule decides which of the mirror images is taken. A guide
    leads to the image next to it.

    Parameters
    ----------
    model : Model or Machine
        Machine, reduced or not.
    speed_rpm : float
        Pinion speed, rpm.
    settings : Settings, optional
        Settings of the run.
    start : State, optional
        Start; the static equilibrium if None.
    guide : Guide, optional
        Orbit of a similar machine, see simulate().
    known_orbit : KnownOrbit, optional
        Orbit of the model at which the run ends.
    start_symmetries : sequence of Symmetry, optional
        Symmetries of the motion to which the start belongs; by default those of the start itself.

    Returns
    -------
    RunPlan of StartedRun
        Generator for requests.alone() or side_by_side(), which returns the run after its first watch.
    """
    model = build_model(model) if isinstance(model, Machine) else model
    frequency = TAU * mesh_frequency(model.machine.layout, speed_rpm)
    start = static_start(model) if start is None else start
    with _naming(speed_rpm):
        first_watch = yield from _begin_watch(
            model.system, frequency, settings or Settings(), start, guide, known_orbit
        )
        if guide is None and not first_watch.settling_result.is_known_orbit:
            start_symmetries = (
                symmetries_of_start(model.system, start) if start_symmetries is None else start_symmetries
            )
            first_watch = yield from with_chosen_image(first_watch, model.system, start_symmetries)
    return StartedRun(model.system, first_watch, speed_rpm, tuple(start_symmetries or ()))


@contextmanager
def _naming(speed_rpm: float) -> Iterator[None]:
    """Context in which a NotConverged is raised again with the speed as its place."""
    try:
        yield
    except NotConverged as error:
        raise NotConverged(error.stage, f"{speed_rpm:g} rpm", error.attempts) from None


def steady_state(
    system: System, frequency: float, settings: Settings, start: State, guide: Guide | None = None
) -> SteadyState:
    """Compute the steady state of any system: run it until it settles, else classify its motion.

    If a class of motion does not come out again from starts a little aside, it is withdrawn. Then the motion
    is not settled, and `looks` says why.

    Parameters
    ----------
    system : System
        Equations of motion.
    frequency : float
        Angular mesh frequency, rad/s.
    settings : Settings
        Settings of the run.
    start : State
        Displacement and velocity at the start.
    guide : Guide, optional
        Orbit of a similar system, see simulate().

    Returns
    -------
    SteadyState
        Response.
    """

    def run_plan() -> RunPlan[SteadyState]:
        return (
            yield from _steady(system, (yield from _begin_watch(system, frequency, settings, start, guide)))
        )

    return alone(run_plan())


def _begin_watch(
    system: System,
    frequency: float,
    settings: Settings,
    start: State,
    guide: Guide | None,
    known_orbit: KnownOrbit | None = None,
) -> RunPlan[FirstWatch]:
    """Run plan of the first watch of a system from a start; a guide that does not serve the system is
    left out.
    """
    guide = guide if guide is not None and settings.refine and guide.serves(system) else None
    like = None if guide is None else guide.integrator
    integrator = Integrator(system, frequency, settings.tolerance, settings.order, like)
    return begin(integrator, integrator.by_phase(start), settings, guide, known_orbit)


def _steady(system: System, first_watch: FirstWatch) -> RunPlan[SteadyState]:
    """Run plan of the steady state of a run after its first watch, and of the check whether it holds from
    other starts.
    """
    integrator, settings = first_watch.integrator, first_watch.settings
    watch_result = yield from watch(first_watch)
    disagreement = yield from find_disagreement(integrator, first_watch.start, settings, watch_result)
    looks = None
    if disagreement is not None:
        other_result, other_look = disagreement
        looks = (Look(watch_result.settling_result.period, watch_result.motion), other_look)
        watch_result = yield from withdraw_class(integrator, watch_result, other_result, settings)
    return response_of(system, integrator, watch_result, looks)
