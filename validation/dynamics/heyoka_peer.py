"""heyoka.py on the same equations: Taylor steps compiled by LLVM, contact switches as terminal events.

Set up as its tutorials do: the contact state of a mesh is a pair of runtime parameters that the callbacks of
two terminal events change, time is mesh phase, coordinates are scaled so that deflections are near one, which
is what its absolute tolerance means. The callback judges all meshes at once, since those of a mirrored pair
switch at the same instant, of which the second event would be lost to rounding. heyoka.py is imported by the
caller: it is a dependency of the benchmark alone.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.integrator.compiled import MIN_CLEARANCE, TAU
from facegear.dynamics.integrator.system import System
from validation.dynamics.problems import SAMPLES, Problem
from validation.dynamics.right_side import linear

EDGE = 1e-13
"""A deflection this close to an edge, in length scales, stands on it, and its rate decides."""
NEGLIGIBLE = 1e-13
MAX_STEPS = 1_000_000
APART = 1e-3
"""Relative distance of the starts of a batch, so that its lanes do not step alike."""


@dataclass(frozen=True, eq=False)
class Scaled:
    """A system in deflections over the length scale and derivatives by mesh phase.

    unit (n,): one of a coordinate, y = unit u. jacobian (m, n): deflections of u; spread (m, n): minus the
    accelerations of u by the mesh forces. error (m, 2, harmonics + 1) sine part first, edges (m,).
    """

    unit: Array
    jacobian: Array
    spread: Array
    error: Array
    lower: Array
    upper: Array


def scaled(system: System) -> Scaled:
    """Scale a system. Raises ValueError for what the comparison has no use for."""
    if linear(system).pieces or not system.damping_when_open:
        raise ValueError("neither stiffness in pieces nor damping in contact only is set up here")
    unit = system.scale / np.abs(system.mesh_jacobian).max(axis=0)
    kept = np.where(
        np.abs(system.mesh_jacobian) > NEGLIGIBLE * np.abs(system.mesh_jacobian).max(),
        system.mesh_jacobian,
        0.0,
    )
    closed = system.upper - system.lower <= MIN_CLEARANCE * system.scale
    return Scaled(
        unit=unit,
        jacobian=kept * unit / system.scale,
        spread=kept * system.scale / unit,
        error=system.error[system.error_kind] / system.scale,
        lower=np.where(closed, system.upper, system.lower) / system.scale,
        upper=system.upper / system.scale,
    )


@dataclass(frozen=True, eq=False)
class Expressions:
    """Right-hand sides (variable, derivative) and deflections (m,) in heyoka's expression system."""

    equations: list[tuple[Any, Any]]
    deflections: list[Any]


def expressions(heyoka: Any, problem: Problem, units: Scaled) -> Expressions:
    """The equations of motion; parameters 2 m and 2 m + 1 of mesh m: 1 in contact, and the edge then."""
    system, w = problem.system, problem.frequency
    meshes, n = units.jacobian.shape
    places = [heyoka.make_vars(f"u{k}") for k in range(n)]
    rates = [heyoka.make_vars(f"v{k}") for k in range(n)]
    law = linear(system)
    stiffness = [_series(heyoka, row / w**2) for row in law.fourier]
    deflections, forces = [], []
    for m in range(meshes):
        error = _series(heyoka, -units.error[m])
        error_rate = _series(heyoka, -_rate(units.error[m]))
        deflections.append(_weighted(heyoka, units.jacobian[m], places, error))
        beyond = deflections[m] - units.upper[m]
        if units.lower[m] < units.upper[m]:
            beyond = heyoka.par[2 * m] * deflections[m] - heyoka.par[2 * m + 1]
        rate = _weighted(heyoka, units.jacobian[m], rates, error_rate)
        forces.append(stiffness[law.kind[m]] * beyond + system.mesh_damping[m] / w * rate)
    equations = list(zip(places, rates, strict=True))
    for k in range(n):
        own = _series(heyoka, system.load[k] / (w**2 * units.unit[k]))
        own = own - system.damping[k] / w * rates[k] - system.omega_squared[k] / w**2 * places[k]
        equations.append((rates[k], _weighted(heyoka, -units.spread[:, k], forces, own)))
    return Expressions(equations, deflections)


def _weighted(heyoka: Any, weights: Array, values: list[Any], constant: Any) -> Any:
    used = [float(weights[i]) * values[i] for i in np.flatnonzero(weights)]
    return heyoka.sum([*used, constant])


def _series(heyoka: Any, row: Array) -> Any:
    """A Fourier row (2, harmonics + 1) as an expression of the phase."""
    terms = [heyoka.expression(float(row[1, 0]))]
    for j in range(1, row.shape[1]):
        angle = float(j) * heyoka.time
        terms += [float(row[0, j]) * heyoka.sin(angle)] if row[0, j] else []
        terms += [float(row[1, j]) * heyoka.cos(angle)] if row[1, j] else []
    return heyoka.sum(terms)


def _rate(row: Array) -> Array:
    """Fourier row of the derivative by phase."""
    j = np.arange(row.shape[1])
    return np.array([-j * row[1], j * row[0]])


def contact_parameters(
    jacobian: Array, error: Array, lower: Array, upper: Array, phase: float, state: Array, parameters: Array
) -> None:
    """Write the parameters (2 meshes,) that belong to a state (at least 2 n,) at a phase."""
    n, order = jacobian.shape[1], np.arange(error.shape[2])
    sine, cosine = np.sin(order * phase), np.cos(order * phase)
    deflection = jacobian @ state[:n] - error[:, 0] @ sine - error[:, 1] @ cosine
    rate = jacobian @ state[n : 2 * n] - error[:, 0] @ (order * cosine) + error[:, 1] @ (order * sine)
    drive = (deflection > upper + EDGE) | ((np.abs(deflection - upper) <= EDGE) & (rate > 0.0))
    back = (deflection < lower - EDGE) | ((np.abs(deflection - lower) <= EDGE) & (rate < 0.0))
    parameters[::2] = drive | back
    parameters[1::2] = np.where(drive, upper, np.where(back, lower, 0.0))


@dataclass(frozen=True, eq=False)
class Switch:
    """Callback of every event: all contact states from the state there, in its lane of a batch."""

    units: Scaled

    def __call__(self, integrator: Any, sign: int, lane: int | None = None) -> bool:
        """Set the parameters and go on."""
        time, state, parameters = integrator.time, integrator.state, integrator.pars
        if lane is not None:
            time, state, parameters = float(time[lane]), state[:, lane], parameters[:, lane]
        u = self.units
        contact_parameters(u.jacobian, u.error, u.lower, u.upper, time, state, parameters)
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
    units: Scaled
    lanes: int

    def reset(self) -> None:
        """Back to the start at phase zero."""
        if self.lanes:
            self.adaptive.set_time(0.0)
        else:
            self.adaptive.time = 0.0
        self.adaptive.state[:] = self.start
        if self.switch:
            self.adaptive.reset_cooldowns()
            for lane in range(self.lanes) if self.lanes else [None]:
                self.switch(self.adaptive, 0, lane)


def compiled(
    heyoka: Any, problem: Problem, tolerance: float, tangents: bool = False, lanes: int = 0
) -> Integrator:
    """Compile for a problem and tolerance, nothing taken from the caches of earlier runs.

    Tangents (`var_ode_sys` in the 2 n coordinates and rates) are compiled in compact mode, as the tutorial
    advises: unrolled they take minutes. The lanes of a batch start a little apart.
    """
    units = scaled(problem.system)
    expressions_of_problem = expressions(heyoka, problem, units)
    opening = np.flatnonzero(units.lower < units.upper)
    switch = Switch(units) if opening.size else None
    event = heyoka.t_event_batch if lanes else heyoka.t_event
    events = [
        event(expressions_of_problem.deflections[m] - float(edge[m]), callback=switch)
        for m in opening
        for edge in (units.upper, units.lower)
    ]
    heyoka.llvm_state.clear_memcache()
    heyoka.llvm_state.set_diskcache_enabled(False)
    start = np.r_[problem.start.displacement, problem.start.velocity / problem.frequency]
    start /= np.tile(units.unit, 2)
    parameters = np.zeros(2 * len(expressions_of_problem.deflections) if switch else 0)
    build = heyoka.taylor_adaptive_batch if lanes else heyoka.taylor_adaptive
    adaptive = build(
        heyoka.var_ode_sys(expressions_of_problem.equations, heyoka.var_args.vars)
        if tangents
        else expressions_of_problem.equations,
        start[:, None] * (1.0 + APART * np.arange(lanes)) if lanes else start,
        pars=np.tile(parameters[:, None], max(lanes, 1)) if lanes else parameters,
        t_events=events,
        tol=tolerance,
        fast_math=True,
        compact_mode=tangents,
    )
    return Integrator(adaptive, adaptive.state.copy(), switch, units, lanes)


def trajectory(heyoka: Any) -> Callable[[Problem, float], Callable[[], Array]]:
    """Coordinates (samples, n) from heyoka.py's dense output."""

    def prepare(problem: Problem, tolerance: float) -> Callable[[], Array]:
        integrator = compiled(heyoka, problem, tolerance)
        phases = TAU * np.arange(problem.periods * SAMPLES) / SAMPLES

        def run() -> Array:
            integrator.reset()
            outcome, *_, samples = integrator.adaptive.propagate_grid(phases, max_steps=MAX_STEPS)
            _require(heyoka, outcome)
            return samples[:, : problem.system.size] * integrator.units.unit

        return run

    return prepare


def batch(heyoka: Any, lanes: int) -> Callable[[Problem, float], Callable[[], Array]]:
    """Coordinates (samples, n) of the first of as many trajectories as a batch has lanes."""

    def prepare(problem: Problem, tolerance: float) -> Callable[[], Array]:
        integrator = compiled(heyoka, problem, tolerance, lanes=lanes)
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
    """Derivatives (2 n, 2 n) of coordinates and rates by phase after the periods by those at the start."""

    def prepare(problem: Problem, tolerance: float) -> Callable[[], Array]:
        integrator = compiled(heyoka, problem, tolerance, tangents=True)
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
