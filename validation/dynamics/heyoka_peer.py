"""heyoka.py on the same equations: Taylor steps compiled by LLVM, contact switches as terminal events.

Set up as its tutorials do: what switches (contact, the piece of a law, a damper that would pull, a bearing
with clearance) is a runtime parameter that the callbacks of terminal events change, one event for each edge,
level and rim. The callback judges all contacts at once, by a function that heyoka.py compiles, since those of
a mirrored pair switch at the same instant, of which the second event would be lost to rounding. heyoka.py is
imported by the caller: it is a dependency of the benchmark alone.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from facegear.arrays import Array
from facegear.motion.integrator.kernel_system import TAU
from validation.dynamics.heyoka_equations import Expressions, ScaledSystem, expressions, scale_system
from validation.dynamics.problems import SAMPLES, Problem

EDGE, EDGE_TOLERANCE = 1e-13, 10.0
"""A deflection this close to an edge, in length scales or in tolerances, stands on it, and its rate decides:
an event lies on the Taylor polynomial of a deflection, in which the series of the error are cut, too. The
same holds for spring and damper together, whose stiffness over the square of the frequency is near one.
"""
MAX_STEPS = 1_000_000
"""Largest number of steps of a run."""
APART = 1e-3
"""Relative distance of the starts of a batch, so that its lanes do not step alike."""


def contact_states(heyoka: Any, units: ScaledSystem, motion: Expressions, tolerance: float) -> Any:
    """Compile the state of all contacts and rings. On an edge or level the rate decides.

    Parameters
    ----------
    heyoka : module
        The library.
    units : ScaledSystem
        The system.
    motion : Expressions
        Its equations.
    tolerance : float
        Absolute tolerance of the integrator, relative to the length scale.

    Returns
    -------
    heyoka.cfunc
        From scaled coordinates and rates (2 n,), parameters, and the phase in rad to the states of the law
        and the flags.
    """

    margin = max(EDGE, EDGE_TOLERANCE * tolerance)

    def has_begun(over: Any, rate: Any) -> Any:
        on_it = heyoka.select(heyoka.gt(rate, 0.0), heyoka.gte(over, -margin), heyoka.gt(over, margin))
        return on_it + 0.0

    states, flags = [], []
    levels = motion.law.levels
    for m, (deflection, rate) in enumerate(zip(motion.deflections, motion.rates, strict=True)):
        upper, lower = float(units.upper[m]), float(units.lower[m])
        if not units.opens[m]:
            always = [heyoka.expression(1.0), *(len(levels[m]) - 1) * [heyoka.expression(0.0)]]
            states += motion.law.state(m, always, [])
            flags.append(heyoka.expression(1.0))
            continue
        drive = [has_begun(deflection - upper - float(level), rate) for level in levels[m]]
        back = [has_begun(lower - deflection - float(level), -rate) for level in levels[m]]
        back = back if np.isfinite(lower) else []
        states += motion.law.state(m, drive, back)
        if units.only_pushes:
            flags.append(_pushes(heyoka, motion, m, drive[0], back[0] if back else None, has_begun))
    flags = flags if units.only_pushes else []
    flags += [has_begun(*rim) for rim in zip(motion.rims, motion.rim_rates, strict=True)]
    return heyoka.cfunc([*states, *flags], vars=[variable for variable, _ in motion.equations])


def _pushes(
    heyoka: Any, motion: Expressions, m: int, drive: Any, back: Any, has_begun: Callable[..., Any]
) -> Any:
    """1 where spring and damper of a contact together push, 0 where they would pull."""
    phase = heyoka.make_vars("phase")
    push = heyoka.subs(motion.pushes[m], {heyoka.time: phase})
    growth = heyoka.diff(push, phase)
    for variable, derivative in motion.equations:
        growth = growth + heyoka.diff(push, variable) * derivative
    growth = heyoka.subs(growth, {phase: heyoka.time})
    on_drive = drive * has_begun(motion.pushes[m], growth)
    return on_drive if back is None else on_drive + back * has_begun(-motion.pushes[m], -growth)


@dataclass(frozen=True, eq=False)
class Switch:
    """Callback of every event: all parameters from the state there, in its lane of a batch.

    Attributes
    ----------
    states
        Function of `contact_states`.
    table
        Parameters of each piece of a law whose states are numbers of pieces, or None.
    variables
        Number of coordinates and rates.
    """

    states: Any
    table: Array | None
    variables: int

    def __call__(self, integrator: Any, sign: int, lane: int | None = None) -> bool:
        """Set the parameters and go on."""
        time, state, parameters = integrator.time, integrator.state, integrator.pars
        if lane is not None:
            time, state, parameters = float(time[lane]), state[:, lane].copy(), parameters[:, lane]
        earlier_parameters = parameters[: self.states.nparams].copy()
        states = self.states(state[: self.variables], pars=earlier_parameters, time=time)
        if self.table is not None:
            contacts, pieces, _ = self.table.shape
            rows = self.table[np.arange(contacts), states[:contacts].astype(int) + pieces // 2]
            states = np.append(rows, states[contacts:])
        parameters[:] = states
        return True

    def __deepcopy__(self, memo: dict[int, Any]) -> "Switch":
        """Itself: it holds nothing that changes, and heyoka.py copies callbacks deeply."""
        return self


@dataclass(frozen=True, eq=False)
class Integrator:
    """A compiled integrator, the state it starts from, and its switches, None where no mesh can open.

    lanes: of a batch, 0 for a single trajectory.
    """

    adaptive: Any
    start: Array
    switch: Switch | None
    units: ScaledSystem
    lanes: int

    def reset(self) -> None:
        """Return to the start at phase zero."""
        if self.lanes:
            self.adaptive.set_time(0.0)
        else:
            self.adaptive.time = 0.0
        self.adaptive.state[:] = self.start
        if self.switch:
            self.adaptive.reset_cooldowns()
            for lane in range(self.lanes) if self.lanes else [None]:
                self.switch(self.adaptive, 0, lane)
                self.switch(self.adaptive, 0, lane)  # what springs push needs the pieces that they are in


def _switches(heyoka: Any, units: ScaledSystem, motion: Expressions) -> list[Any]:
    """Expressions whose zeros are the switches: edges and levels, dampers about to pull, and rims."""
    switches = []
    for m, levels in enumerate(motion.law.levels):
        edges = [*(units.upper[m] + levels), *(units.lower[m] - levels)] if units.opens[m] else []
        switches += [motion.deflections[m] - float(edge) for edge in edges if np.isfinite(edge)]
        if units.only_pushes and units.opens[m]:
            # Of an open contact the damper alone would have zeros: 1 is added there.
            switches.append(motion.pushes[m] + (1.0 - motion.law.is_touching(m)) * (1.0 - motion.pushes[m]))
    return switches + motion.rims


def compile_integrator(
    heyoka: Any, problem: Problem, tolerance: float, tangents: bool = False, lanes: int = 0
) -> Integrator:
    """Compile for a problem and tolerance, nothing taken from the caches of earlier runs.

    Tangents (`var_ode_sys` in the 2 n coordinates and rates) are compiled in compact mode, as the tutorial
    advises: unrolled they take minutes. The lanes of a batch start a little apart.

    Parameters
    ----------
    heyoka : module
        The library.
    problem : Problem
        The problem.
    tolerance : float
        Absolute tolerance, relative to the length scale.
    tangents : bool
        Whether to integrate the tangents, too.
    lanes : int
        Number of trajectories of a batch, 0 for a single trajectory.

    Returns
    -------
    Integrator
        The integrator at its start.
    """
    units = scale_system(problem.system)
    motion = expressions(heyoka, problem, units)
    switches = _switches(heyoka, units, motion)
    switch = None
    if motion.parameters and (switches or motion.law.table is not None):
        states = contact_states(heyoka, units, motion, tolerance)
        switch = Switch(states, motion.law.table, len(motion.equations))
    event = heyoka.t_event_batch if lanes else heyoka.t_event
    events = [event(expression, callback=switch) for expression in switches]
    heyoka.llvm_state.clear_memcache()
    heyoka.llvm_state.set_diskcache_enabled(False)
    start = np.r_[problem.start.displacement, problem.start.velocity / problem.frequency]
    start /= np.tile(units.unit, 2)
    parameters = np.zeros(motion.parameters if switch else 0)
    build = heyoka.taylor_adaptive_batch if lanes else heyoka.taylor_adaptive
    adaptive = build(
        heyoka.var_ode_sys(motion.equations, heyoka.var_args.vars) if tangents else motion.equations,
        start[:, None] * (1.0 + APART * np.arange(lanes)) if lanes else start,
        pars=np.tile(parameters[:, None], max(lanes, 1)) if lanes else parameters,
        t_events=events,
        tol=tolerance,
        fast_math=True,
        compact_mode=tangents,
    )
    return Integrator(adaptive, adaptive.state.copy(), switch, units, lanes)


def trajectory(heyoka: Any) -> Callable[[Problem, float], Callable[[], Array]]:
    """Return a method that gives coordinates (samples, n) from heyoka.py's dense output.

    Parameters
    ----------
    heyoka : module
        The library.

    Returns
    -------
    callable
        From problem and relative tolerance to a run, whose array (samples, n) is in the problem's unit.
    """

    def prepare(problem: Problem, tolerance: float) -> Callable[[], Array]:
        integrator = compile_integrator(heyoka, problem, tolerance)
        phases = TAU * np.arange(problem.periods * SAMPLES) / SAMPLES

        def run() -> Array:
            integrator.reset()
            outcome, *_, samples = integrator.adaptive.propagate_grid(phases, max_steps=MAX_STEPS)
            _require(heyoka, outcome)
            return samples[:, : problem.system.size] * integrator.units.unit

        return run

    return prepare


def batch(heyoka: Any, lanes: int) -> Callable[[Problem, float], Callable[[], Array]]:
    """Return a method that gives coordinates of the first of as many trajectories as a batch has lanes.

    Parameters
    ----------
    heyoka : module
        The library.
    lanes : int
        Number of trajectories.

    Returns
    -------
    callable
        From problem and relative tolerance to a run, whose array (samples, n) is in the problem's unit.
    """

    def prepare(problem: Problem, tolerance: float) -> Callable[[], Array]:
        integrator = compile_integrator(heyoka, problem, tolerance, lanes=lanes)
        phases = TAU * np.arange(problem.periods * SAMPLES) / SAMPLES
        grid = np.tile(phases[:, None], lanes)

        def run() -> Array:
            integrator.reset()
            _, samples = integrator.adaptive.propagate_grid(grid, max_steps=MAX_STEPS)
            for outcome, *_ in integrator.adaptive.propagate_res:
                _require(heyoka, outcome)
            return np.ascontiguousarray(samples[:, : problem.system.size, 0]) * integrator.units.unit

        return run

    return prepare


def tangents(heyoka: Any) -> Callable[[Problem, float], Callable[[], Array]]:
    """Return a method that gives derivatives of coordinates and rates by phase after the periods by those at
    the start.

    Parameters
    ----------
    heyoka : module
        The library.

    Returns
    -------
    callable
        From problem and relative tolerance to a run, whose array (2 n, 2 n) is in the problem's unit.
    """

    def prepare(problem: Problem, tolerance: float) -> Callable[[], Array]:
        integrator = compile_integrator(heyoka, problem, tolerance, tangents=True)
        size = 2 * problem.system.size
        unit = np.tile(integrator.units.unit, 2)

        def run() -> Array:
            integrator.reset()
            outcome = integrator.adaptive.propagate_until(TAU * problem.periods, max_steps=MAX_STEPS)[0]
            _require(heyoka, outcome)
            matrix = integrator.adaptive.state[size:].reshape(size, size)
            return matrix * unit[:, None] / unit

        return run

    return prepare


def _require(heyoka: Any, outcome: Any) -> None:
    if outcome != heyoka.taylor_outcome.time_limit:
        raise RuntimeError(f"heyoka.py stopped: {outcome}")
