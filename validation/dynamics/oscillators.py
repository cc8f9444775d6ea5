"""Random oscillators with backlash: does a label survive, and is the orbit the one that the run reaches?

x'' + 2 z x' + f(x) = Fm + Fa W^2 cos(W t), f the dead zone of half-width one. The result of settling is
compared with plain running: 20 000 further periods by our own integrator, and the undisturbed run from the
start by closed-form pieces that share nothing with it.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.meshing.linear import LinearLaw
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.integrator.system import System
from facegear.motion.plan import Motion, Settings, State
from facegear.motion.requests import run_many
from facegear.motion.steady_state.response import SteadyState
from facegear.motion.steady_state.simulate import steady_state
from validation.dynamics.closed_form import LONGEST, Oscillators, run_closed_form

FURTHER = 20_000
"""Periods of a plain run."""
LOOKED_AT = 2_048
"""Periods at the end of a plain run on which its class is read off."""
EQUAL_STATES = 1e-5
"""Distance over the length scale within which two states are one."""
TOGETHER = 50
"""Oscillators judged at a time."""


@dataclass(frozen=True)
class Oscillator:
    """Damping ratio, mean and alternating force, speed, and the start."""

    damping: float
    mean: float
    amplitude: float
    speed: float
    displacement: float
    velocity: float

    @property
    def system(self) -> System:
        """Equations for our integrator."""
        load = np.zeros((1, 2, 2))
        load[0, 1] = self.mean, self.amplitude * self.speed**2
        return System(
            mesh_jacobian=np.ones((1, 1)),
            omega_squared=np.zeros(1),
            damping=np.array([2.0 * self.damping]),
            mesh_damping=np.zeros(1),
            lower=np.array([-1.0]),
            upper=np.array([1.0]),
            law=LinearLaw(np.array([[[0.0], [1.0]]]), np.zeros(1, dtype=np.int64)),
            error=np.zeros((1, 2, 1)),
            error_kind=np.zeros(1, dtype=np.int64),
            load=load,
            damping_when_open=True,
            scale=1.0,
        )

    @property
    def start(self) -> State:
        """Start at phase 0."""
        return State(np.array([self.displacement]), np.array([self.velocity]))


def random_oscillators(count: int, seed: int = 13) -> Iterator[Oscillator]:
    """Draw oscillators: every other one from rest, the others from anywhere in a box that holds all motions.

    Parameters
    ----------
    count : int
        Number of oscillators.
    seed : int
        Seed of the random numbers.

    Yields
    ------
    Oscillator
        One oscillator.
    """
    random = np.random.default_rng(seed)
    for number in range(count):
        numbers = [
            random.uniform(*limits) for limits in ((0.002, 0.05), (0.05, 0.3), (0.02, 3.0), (0.3, 2.2))
        ]
        start = random.uniform(-2.0, 2.0, 2) if number % 2 else np.zeros(2)
        yield Oscillator(*numbers, *start.tolist())


def judge(
    oscillators: Sequence[Oscillator], settings: Settings, closed_states: Array | None = None
) -> list[dict[str, object]]:
    """Compare the label with and without refinement with plain running, one row an oscillator.

    agrees: the motion after FURTHER periods is the one named, on the same orbit if it is periodic. reached:
    the undisturbed run from the start comes to that orbit. sensitive: that run's own end changes when its
    tolerance is ten times tighter, so that no label is the only right one. The plain runs of all oscillators
    go side by side.

    Parameters
    ----------
    oscillators : Sequence[Oscillator]
        Oscillators (n,).
    settings : Settings
        Settings of settling.
    closed_states : (n, periods, 2) array or None
        Dimensionless states by closed_form_runs, which are computed if it is None.

    Returns
    -------
    list[dict[str, object]]
        Values by column.
    """
    closed_states = closed_form_runs(oscillators, FURTHER) if closed_states is None else closed_states
    tolerance, starts = settings.tolerance, [oscillator.start for oscillator in oscillators]
    responses = [_response(oscillator, settings) for oscillator in oscillators]
    plain = [_response(oscillator, replace(settings, refine=False)) for oscillator in oscillators]
    states = [response.state for response in responses]
    ends = (
        map(end_of, plain_runs(oscillators, states, FURTHER, tolerance)),
        map(end_of, plain_runs(oscillators, starts, FURTHER, tolerance)),
        map(end_of, plain_runs(oscillators, starts, FURTHER, 0.1 * tolerance)),
        map(end_of, closed_states),
    )
    return [_row(*results) for results in zip(oscillators, responses, plain, *ends, strict=True)]


def _response(oscillator: Oscillator, settings: Settings) -> SteadyState:
    return steady_state(oscillator.system, oscillator.speed, settings, oscillator.start)


def _row(
    oscillator: Oscillator,
    response: SteadyState,
    plain: SteadyState,
    later: "OscillatorEnd",
    direct: "OscillatorEnd",
    tighter: "OscillatorEnd",
    closed_states: "OscillatorEnd",
) -> dict[str, object]:
    return {
        **vars(oscillator),
        "label": response.label,
        "label_without_refinement": plain.label,
        "periods_run": response.periods_run,
        "label_later": later.label,
        "agrees": _agrees(response, later),
        "reached": _agrees(response, direct),
        "reached_closed_form": _agrees(response, closed_states),
        "sensitive": not _is_same_motion(direct, tighter),
        "refinement_agrees": response.label == plain.label,
    }


@dataclass(frozen=True, eq=False)
class OscillatorEnd:
    """Class at the end of a plain run, and its last states (periods, 2) by time."""

    label: str
    states: Array


def end_of(states: Array) -> OscillatorEnd:
    """Classify the end of a run: period-n if the last states repeat after n periods, else irregular.

    Parameters
    ----------
    states : (periods, 2) array
        Displacement and velocity, dimensionless.

    Returns
    -------
    OscillatorEnd
        Class and last states.
    """
    last = states[-LOOKED_AT:]
    for period in range(1, LONGEST + 1):
        if np.abs(last[-LONGEST:] - last[-LONGEST - period : -period]).max() <= EQUAL_STATES:
            return OscillatorEnd(f"period-{period}", last)
    return OscillatorEnd("irregular", last)


def _agrees(response: SteadyState, end: OscillatorEnd) -> bool:
    if response.motion is not Motion.PERIODIC:
        return response.motion is not Motion.NOT_SETTLED and end.label == "irregular"
    return end.label == response.label and _passes(end.states, response.state)


def _is_same_motion(first: OscillatorEnd, second: OscillatorEnd) -> bool:
    state = State(second.states[-1, :1], second.states[-1, 1:])
    return first.label == second.label and (first.label == "irregular" or _passes(first.states, state))


def _passes(states: Array, state: State) -> bool:
    """Whether a run passed through a state at the start of one of its last periods."""
    target = np.concatenate([state.displacement, state.velocity])
    return bool(np.abs(states[-LONGEST:] - target).max(axis=1).min() <= 10.0 * EQUAL_STATES)


def plain_runs(
    oscillators: Sequence[Oscillator], starts: Sequence[State], periods: int, tolerance: float
) -> list[Array]:
    """Return the states at the ends of the last periods, by our integrator and nothing else.

    Parameters
    ----------
    oscillators : Sequence[Oscillator]
        Oscillators to run.
    starts : Sequence[State]
        Start of each.
    periods : int
        Number of periods.
    tolerance : float
        Local tolerance, relative.

    Returns
    -------
    list of (LOOKED_AT, 2) array
        Displacement and velocity by time, dimensionless.
    """
    integrators = [Integrator(integrator.system, integrator.speed, tolerance) for integrator in oscillators]
    by_phase = [integrator.by_phase(start) for integrator, start in zip(integrators, starts, strict=True)]
    runs = run_many(integrators, by_phase, periods, last_periods=LOOKED_AT)
    speeds = [oscillator.speed for oscillator in oscillators]
    return [run.ends[:, :, 0] * np.array([1.0, speed]) for run, speed in zip(runs, speeds, strict=True)]


def closed_form_runs(oscillators: Sequence[Oscillator], periods: int) -> Array:
    """Return the states at the ends of the last periods, by the closed form of each stretch.

    Parameters
    ----------
    oscillators : Sequence[Oscillator]
        Oscillators (n,) with their starts, dimensionless.
    periods : int
        Length of the run, in periods of the load.

    Returns
    -------
    Array
        Displacement and velocity (n, min(periods, LOOKED_AT), 2), dimensionless.
    """
    rows = [(item.damping, item.mean, item.amplitude * item.speed**2, item.speed) for item in oscillators]
    starts = np.array([(item.displacement, item.velocity) for item in oscillators])
    return run_closed_form(Oscillators(*np.array(rows).T), starts, periods, LOOKED_AT)


def closed_form_run(oscillator: Oscillator, periods: int) -> Array:
    """Return the states of one oscillator at the ends of the last periods, see `closed_form_runs`.

    Parameters
    ----------
    oscillator : Oscillator
        The oscillator.
    periods : int
        Length of the run, in periods of the load.

    Returns
    -------
    (min(periods, LOOKED_AT), 2) array
        Displacement and velocity, dimensionless.
    """
    return closed_form_runs([oscillator], periods)[0]


def suite(count: int, settings: Settings, step: Callable[[], None] = lambda: None) -> pd.DataFrame:
    """Judge random oscillators, one row each.

    Parameters
    ----------
    count : int
        Number of oscillators.
    settings : Settings
        Settings of settling.
    step : Callable[[], None]
        Called for each oscillator.

    Returns
    -------
    DataFrame
        Columns as `judge` names them.
    """
    rows: list[dict[str, object]] = []
    oscillators = list(random_oscillators(count))
    closed_states = closed_form_runs(oscillators, FURTHER)
    for begin in range(0, count, TOGETHER):
        of_turn = oscillators[begin : begin + TOGETHER]
        rows += judge(of_turn, settings, closed_states[begin : begin + TOGETHER])
        for _ in of_turn:
            step()
    return pd.DataFrame(rows)


def verdict(table: pd.DataFrame) -> str:
    """Summarise how many labels hold, are left open, or fail, and how many orbits the run itself reaches.

    Parameters
    ----------
    table : DataFrame
        Table of `suite`.

    Returns
    -------
    str
        The text.
    """
    is_not_settled = table["label"] == Motion.NOT_SETTLED.value
    fails = ~table["agrees"] & ~is_not_settled
    orbits_reached = (table["reached"] | table["sensitive"]).sum()
    alone = (table["reached_closed_form"] | table["sensitive"]).sum()
    return (
        f"{table['agrees'].sum()} of {len(table)} labels hold, "
        f"{is_not_settled.sum()} not settled, {fails.sum()} fail; "
        f"the undisturbed run reaches {orbits_reached}, closed-form pieces {alone} (sensitive ones counted); "
        f"refinement changes {(~table['refinement_agrees']).sum()}"
    )
