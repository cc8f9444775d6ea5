"""Random oscillators with backlash: does a label survive, and is the orbit the one that the run reaches?

x'' + 2 z x' + f(x) = Fm + Fa W^2 cos(W t), f the dead zone of half-width one. What settling says of each is
held against plain running: 20 000 further periods by our own integrator, and the undisturbed run from the
start by closed-form pieces that share nothing with it.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
import pandas as pd
from numba import njit

from facegear.arrays import Array
from facegear.dynamics.integrator.integrator import Integrator
from facegear.dynamics.integrator.system import System
from facegear.dynamics.motion import Motion, Settings, State
from facegear.dynamics.side_by_side import run_many
from facegear.dynamics.steady_state.response import SteadyState
from facegear.dynamics.steady_state.simulate import steady_state
from facegear.mesh_law.linear import LinearLaw

FURTHER = 20_000
LOOKED_AT = 2_048
"""Periods at the end of a plain run on which its class is read off."""
SAME = 1e-5
"""Distance over the length scale within which two states are one."""
TOGETHER = 50
"""Oscillators judged at a time."""
LONGEST = 512
PARTS = 64
"""Looks for a contact switch in each period of the closed-form run."""


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
        """What our integrator sees."""
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
        """Where it starts, at phase 0."""
        return State(np.array([self.displacement]), np.array([self.velocity]))


def random_oscillators(count: int, seed: int = 13) -> Iterator[Oscillator]:
    """Every other one from rest, the others from anywhere in a box that holds all motions."""
    random = np.random.default_rng(seed)
    for number in range(count):
        numbers = [
            random.uniform(*limits) for limits in ((0.002, 0.05), (0.05, 0.3), (0.02, 3.0), (0.3, 2.2))
        ]
        start = random.uniform(-2.0, 2.0, 2) if number % 2 else np.zeros(2)
        yield Oscillator(*numbers, *start.tolist())


def judge(oscillators: Sequence[Oscillator], settings: Settings) -> list[dict[str, object]]:
    """One row each: the label with and without refinement, and what plain running says of both.

    agrees: the motion after FURTHER periods is the one named, on the same orbit if it is periodic. reached:
    the undisturbed run from the start comes to that orbit. sensitive: that run's own end changes when its
    tolerance is ten times tighter, so that nobody's is the only right one. The plain runs of all oscillators
    go side by side.
    """
    tolerance, starts = settings.tolerance, [oscillator.start for oscillator in oscillators]
    responses = [_response(oscillator, settings) for oscillator in oscillators]
    plain = [_response(oscillator, replace(settings, refine=False)) for oscillator in oscillators]
    states = [response.state for response in responses]
    ends = (
        map(end_of, plain_runs(oscillators, states, FURTHER, tolerance)),
        map(end_of, plain_runs(oscillators, starts, FURTHER, tolerance)),
        map(end_of, plain_runs(oscillators, starts, FURTHER, 0.1 * tolerance)),
    )
    return [_row(*seen) for seen in zip(oscillators, responses, plain, *ends, strict=True)]


def _response(oscillator: Oscillator, settings: Settings) -> SteadyState:
    return steady_state(oscillator.system, oscillator.speed, settings, oscillator.start)


def _row(
    oscillator: Oscillator,
    response: SteadyState,
    plain: SteadyState,
    later: "OscillatorEnd",
    direct: "OscillatorEnd",
    tighter: "OscillatorEnd",
) -> dict[str, object]:
    closed = end_of(closed_form_run(oscillator, FURTHER))
    return {
        **vars(oscillator),
        "label": response.label,
        "label_without_refinement": plain.label,
        "periods_run": response.periods_run,
        "label_later": later.label,
        "agrees": _agrees(response, later),
        "reached": _agrees(response, direct),
        "reached_closed_form": _agrees(response, closed),
        "sensitive": not _same(direct, tighter),
        "refinement_agrees": response.label == plain.label,
    }


@dataclass(frozen=True, eq=False)
class OscillatorEnd:
    """Class that the end of a plain run shows, and its last states (periods, 2) by time."""

    label: str
    states: Array


def end_of(states: Array) -> OscillatorEnd:
    """period-n if the last states repeat after n periods, else irregular."""
    last = states[-LOOKED_AT:]
    for period in range(1, LONGEST + 1):
        if np.abs(last[-LONGEST:] - last[-LONGEST - period : -period]).max() <= SAME:
            return OscillatorEnd(f"period-{period}", last)
    return OscillatorEnd("irregular", last)


def _agrees(response: SteadyState, end: OscillatorEnd) -> bool:
    if response.motion is not Motion.PERIODIC:
        return response.motion is not Motion.NOT_SETTLED and end.label == "irregular"
    return end.label == response.label and _passes(end.states, response.state)


def _same(first: OscillatorEnd, second: OscillatorEnd) -> bool:
    state = State(second.states[-1, :1], second.states[-1, 1:])
    return first.label == second.label and (first.label == "irregular" or _passes(first.states, state))


def _passes(states: Array, state: State) -> bool:
    """Whether a run passed through a state at the start of one of its last periods."""
    here = np.concatenate([state.displacement, state.velocity])
    return bool(np.abs(states[-LONGEST:] - here).max(axis=1).min() <= 10.0 * SAME)


def plain_runs(
    oscillators: Sequence[Oscillator], starts: Sequence[State], periods: int, tolerance: float
) -> list[Array]:
    """States (LOOKED_AT, 2) by time at the ends of the last periods, by our integrator and nothing else."""
    integrators = [Integrator(each.system, each.speed, tolerance) for each in oscillators]
    by_phase = [each.by_phase(start) for each, start in zip(integrators, starts, strict=True)]
    runs = run_many(integrators, by_phase, periods, last_periods=LOOKED_AT)
    speeds = [oscillator.speed for oscillator in oscillators]
    return [run.ends[:, :, 0] * np.array([1.0, speed]) for run, speed in zip(runs, speeds, strict=True)]


def closed_form_run(oscillator: Oscillator, periods: int) -> Array:
    """The same by the closed form of each stretch between two switches, which bisection locates."""
    force = oscillator.amplitude * oscillator.speed**2
    terms = _Terms(oscillator.damping, oscillator.mean, force, oscillator.speed)
    states = np.empty((periods, 2))
    _closed_form(terms, oscillator.displacement, oscillator.velocity, states)
    return states


class _Terms(NamedTuple):
    """Damping ratio, mean force, alternating force and speed of the equation."""

    damping: float
    mean: float
    force: float
    speed: float


@njit(cache=True)
def _closed_form(terms: _Terms, x: float, v: float, states: Array) -> None:
    part = 2.0 * np.pi / terms.speed / PARTS
    for period in range(states.shape[0]):
        for look in range(PARTS):
            now, stop = look * part, (look + 1) * part
            while now < stop:
                side = 1.0 if x > 1.0 or (x == 1.0 and v > 0.0) else 0.0
                side = -1.0 if x < -1.0 or (x == -1.0 and v < 0.0) else side
                x, v, now = _until(terms, x, v, side, now, stop)
        states[period, 0], states[period, 1] = x, v


@njit(cache=True)
def _until(
    terms: _Terms, x: float, v: float, side: float, now: float, stop: float
) -> tuple[float, float, float]:
    """State and time at the next switch, or at `stop` if there is none before."""
    end, rate = _moved(terms, x, v, side, now, stop - now)
    if _inside(end, side):
        return end, rate, stop
    low, high = 0.0, stop - now
    for _ in range(60):
        middle = 0.5 * (low + high)
        if _inside(_moved(terms, x, v, side, now, middle)[0], side):
            low = middle
        else:
            high = middle
    end, rate = _moved(terms, x, v, side, now, high)
    edge = 1.0 if end > 0.0 else -1.0
    return edge, rate, now + high


@njit(cache=True)
def _inside(x: float, side: float) -> bool:
    return -1.0 <= x <= 1.0 if side == 0.0 else side * x >= 1.0


@njit(cache=True)
def _moved(terms: _Terms, x: float, v: float, side: float, now: float, ahead: float) -> tuple[float, float]:
    """The linear equation of one stretch: x'' + 2 z x' + k (x - side) = mean + force cos W t, k = 1 or 0."""
    damping, mean, force, speed = terms
    stiffness = 1.0 if side != 0.0 else 0.0
    gap, lag = stiffness - speed**2, 2.0 * damping * speed
    size = force / (gap**2 + lag**2)
    cosine, sine = size * gap, size * lag
    before = cosine * np.cos(speed * now) + sine * np.sin(speed * now)
    before_rate = speed * (sine * np.cos(speed * now) - cosine * np.sin(speed * now))
    then = speed * (now + ahead)
    after = cosine * np.cos(then) + sine * np.sin(then)
    after_rate = speed * (sine * np.cos(then) - cosine * np.sin(then))
    decay = np.exp(-damping * ahead)
    if side == 0.0:
        drift = mean / (2.0 * damping)
        free = v - before_rate - drift
        fade = decay**2
        moved = x - before + drift * ahead + free * (1.0 - fade) / (2.0 * damping)
        return moved + after, drift + free * fade + after_rate
    rest = side + mean
    natural = np.sqrt(1.0 - damping**2)
    a = x - before - rest
    b = (v - before_rate + damping * a) / natural
    c, s = np.cos(natural * ahead), np.sin(natural * ahead)
    free = decay * (a * c + b * s)
    free_rate = decay * (natural * (b * c - a * s) - damping * (a * c + b * s))
    return rest + free + after, free_rate + after_rate


def suite(count: int, settings: Settings, step: Callable[[], None] = lambda: None) -> pd.DataFrame:
    """judge() for `count` random oscillators, one row each."""
    rows: list[dict[str, object]] = []
    oscillators = list(random_oscillators(count))
    for begin in range(0, count, TOGETHER):
        of_turn = oscillators[begin : begin + TOGETHER]
        rows += judge(of_turn, settings)
        for _ in of_turn:
            step()
    return pd.DataFrame(rows)


def verdict(table: pd.DataFrame) -> str:
    """How many labels hold, are left open, or fail, and how many orbits the run itself reaches."""
    unsettled = table["label"] == Motion.NOT_SETTLED.value
    failed = ~table["agrees"] & ~unsettled
    reached = (table["reached"] | table["sensitive"]).sum()
    alone = (table["reached_closed_form"] | table["sensitive"]).sum()
    return (
        f"{table['agrees'].sum()} of {len(table)} labels hold, "
        f"{unsettled.sum()} not settled, {failed.sum()} fail; "
        f"the undisturbed run reaches {reached}, closed-form pieces {alone} (sensitive ones counted); "
        f"refinement changes {(~table['refinement_agrees']).sum()}"
    )
