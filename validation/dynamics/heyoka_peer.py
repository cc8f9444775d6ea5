"""heyoka.py on the same equations: Taylor steps compiled by LLVM, contact switches as terminal events.

Set up as its tutorials do: the contact state of a mesh, and the piece of the load-dependent law that it is
in, are runtime parameters that the callbacks of terminal events change, one event for each edge and level.
Time is mesh phase, coordinates are scaled so that deflections are near one, which is what its absolute
tolerance means. The callback judges all meshes at once, by a function that heyoka.py compiles, since those of
a mirrored pair switch at the same instant, of which the second event would be lost to rounding. heyoka.py is
imported by the caller: it is a dependency of the benchmark alone.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from facegear.arrays import Array
from facegear.meshing.linear import LinearLaw
from facegear.meshing.load_dependent import LoadDependentLaw
from facegear.motion.integrator.kernel_system import MIN_CLEARANCE, TAU
from facegear.motion.integrator.system import System
from validation.dynamics.problems import SAMPLES, Problem

EDGE = 1e-13
"""A deflection this close to an edge, in length scales, stands on it, and its rate decides."""
NEGLIGIBLE = 1e-13
"""Entries of the Jacobian below this share of its largest count as 0."""
MAX_STEPS = 1_000_000
"""Largest number of steps of a run."""
APART = 1e-3
"""Relative distance of the starts of a batch, so that its lanes do not step alike."""


@dataclass(frozen=True, eq=False)
class ScaledSystem:
    """System in deflections over the length scale and derivatives by mesh phase.

    unit (n,): unit of each coordinate, y = unit u. jacobian (m, n): deflections of u; spread (m, n): minus
    the accelerations of u by the mesh forces. error (m, 2, harmonics + 1) sine part first, edges (m,). levels
    (m, L): amounts beyond the edge at which the pieces of the law begin; pieces (m, L, 4, 2, harmonics + 1):
    series of the powers 0 to 3 of the amount since a piece began, forces over the length scale.
    """

    unit: Array
    jacobian: Array
    spread: Array
    error: Array
    lower: Array
    upper: Array
    levels: Array
    pieces: Array

    @property
    def is_linear(self) -> bool:
        """Whether the force of a contact is a stiffness times the amount."""
        return len(self.pieces[0]) == 1 and not self.pieces[:, :, [0, 2, 3]].any()


def scale_system(system: System) -> ScaledSystem:
    """Scale a system.

    Parameters
    ----------
    system : System
        The system.

    Returns
    -------
    ScaledSystem
        The scaled system.

    Raises
    ------
    ValueError
        For a system with features that the comparison does not set up.
    """
    lacking = {
        "stiffness in pieces of the phase": isinstance(system.law, LinearLaw) and bool(system.law.pieces),
        "flanks that only push": system.push_only,
        "bearing clearance": bool(system.ring_stiffness.size),
        "friction": system.rubbing is not None,
        "coupled coordinates": system.coupling is not None,
    }
    if any(lacking.values()):
        raise ValueError(
            f"not set up here: {', '.join(name for name, is_there in lacking.items() if is_there)}"
        )
    unit = system.scale / np.abs(system.mesh_jacobian).max(axis=0)
    jacobian = np.where(
        np.abs(system.mesh_jacobian) > NEGLIGIBLE * np.abs(system.mesh_jacobian).max(),
        system.mesh_jacobian,
        0.0,
    )
    has_no_gap = system.upper - system.lower <= MIN_CLEARANCE * system.scale
    levels, pieces = _pieces(system)
    return ScaledSystem(
        unit=unit,
        jacobian=jacobian * unit / system.scale,
        spread=jacobian * system.scale / unit,
        error=system.error[system.error_kind] / system.scale,
        lower=np.where(has_no_gap, system.upper, system.lower) / system.scale,
        upper=system.upper / system.scale,
        levels=levels / system.scale,
        pieces=pieces * system.scale ** np.arange(-1.0, 3.0)[:, None, None],
    )


def _pieces(system: System) -> tuple[Array, Array]:
    """Levels (m, L) in m and coefficients (m, L, 4, 2, harmonics + 1) of each contact in SI units.

    Raises ValueError for any but the linear and the load-dependent law.
    """
    law = system.law
    if isinstance(law, LinearLaw):
        pieces = np.zeros((law.contacts, 1, 4, *law.fourier.shape[1:]))
        pieces[:, 0, 1] = law.fourier[law.kind]
        return np.zeros((law.contacts, 1)), pieces
    if isinstance(law, LoadDependentLaw):
        coefficients = np.array([table.coefficients for table in law.tables])
        return law.levels.T, coefficients[law.kind]
    raise ValueError("only the linear and the load-dependent law are set up here")


@dataclass(frozen=True, eq=False)
class Expressions:
    """Right-hand sides (variable, derivative), deflections (m,) and their rates by phase, as expressions."""

    equations: list[tuple[Any, Any]]
    deflections: list[Any]
    rates: list[Any]


def expressions(heyoka: Any, problem: Problem, units: ScaledSystem) -> Expressions:
    """Build the equations of motion.

    Parameters of a contact that may open or has pieces, from `width` m on: 1 in contact, the deflection from
    which its amount counts, and the coefficients of its piece if it has any.

    Parameters
    ----------
    heyoka : module
        The library.
    problem : Problem
        The problem.
    units : ScaledSystem
        Its scaled system.

    Returns
    -------
    Expressions
        The equations.
    """
    system, w = problem.system, problem.frequency
    meshes, n = units.jacobian.shape
    coordinates = [heyoka.make_vars(f"u{k}") for k in range(n)]
    rates = [heyoka.make_vars(f"v{k}") for k in range(n)]
    width = parameters_of_a_contact(units)
    deflections, deflection_rates, forces = [], [], []
    for m in range(meshes):
        first = width * m
        error = _series(heyoka, -units.error[m])
        error_rate = _series(heyoka, -_rate(units.error[m]))
        deflections.append(_weighted_sum(heyoka, units.jacobian[m], coordinates, error))
        opens = units.lower[m] < units.upper[m]
        is_touching = heyoka.par[first] if opens else 1.0
        if units.is_linear:
            beyond = deflections[m] - units.upper[m]
            if opens:
                beyond = heyoka.par[first] * deflections[m] - heyoka.par[first + 1]
            force = _series(heyoka, units.pieces[m, 0, 1] / w**2) * beyond
        else:
            beyond = deflections[m] - heyoka.par[first + 1]
            cubic = [_series_of_parameters(heyoka, units, first + 2, power) for power in range(4)]
            force = ((cubic[3] * beyond + cubic[2]) * beyond + cubic[1]) * beyond + cubic[0]
            force = force / w**2
        rate = _weighted_sum(heyoka, units.jacobian[m], rates, error_rate)
        damper = 1.0 if system.damping_when_open else is_touching
        deflection_rates.append(rate)
        forces.append(force + damper * (system.mesh_damping[m] / w * rate))
    equations = list(zip(coordinates, rates, strict=True))
    for k in range(n):
        acceleration = _series(heyoka, system.load[k] / (w**2 * units.unit[k]))
        acceleration = (
            acceleration - system.damping[k] / w * rates[k] - system.omega_squared[k] / w**2 * coordinates[k]
        )
        equations.append((rates[k], _weighted_sum(heyoka, -units.spread[:, k], forces, acceleration)))
    return Expressions(equations, deflections, deflection_rates)


def parameters_of_a_contact(units: ScaledSystem) -> int:
    """Number of runtime parameters of each contact.

    Parameters
    ----------
    units : Scaled
        The system.

    Returns
    -------
    int
        Contact and edge, and with pieces a coefficient for each power, part and harmonic.
    """
    return 2 if units.is_linear else 2 + units.pieces[0, 0].size


def _series_of_parameters(heyoka: Any, units: ScaledSystem, first: int, power: int) -> Any:
    """Return a coefficient of the piece that a contact is in, a series of the phase whose numbers are
    parameters.
    """
    harmonics = units.pieces.shape[-1]
    sine, cosine = first + 2 * harmonics * power, first + 2 * harmonics * power + harmonics
    terms = [heyoka.par[cosine]]
    for j in range(1, harmonics):
        angle = float(j) * heyoka.time
        terms += [heyoka.par[sine + j] * heyoka.sin(angle), heyoka.par[cosine + j] * heyoka.cos(angle)]
    return heyoka.sum(terms)


def _weighted_sum(heyoka: Any, weights: Array, values: list[Any], constant: Any) -> Any:
    terms = [float(weights[i]) * values[i] for i in np.flatnonzero(weights)]
    return heyoka.sum([*terms, constant])


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


def contact_states(heyoka: Any, units: ScaledSystem, motion: Expressions) -> Callable[..., Array]:
    """Compile the state of each contact. On an edge or level the rate decides.

    On a linear law these are its two parameters, else the number of the piece that it is in: 0 open, p on its
    drive flank, -p on its back flank.

    Parameters
    ----------
    heyoka : module
        The library.
    units : Scaled
        The system.
    motion : Expressions
        Its equations.

    Returns
    -------
    callable
        From scaled coordinates and rates (2 n,) and the phase in rad to parameters (2 m,) or numbers (m,).
    """

    def has_begun(amount: Any, rate: Any, level: float) -> Any:
        over = amount - float(level)
        return heyoka.select(heyoka.gt(rate, 0.0), heyoka.gte(over, -EDGE), heyoka.gt(over, EDGE))

    states = []
    for m, (deflection, rate) in enumerate(zip(motion.deflections, motion.rates, strict=True)):
        upper, lower = float(units.upper[m]), float(units.lower[m])
        if lower >= upper:
            number = heyoka.expression(1.0)
            states += [number, heyoka.expression(upper)] if units.is_linear else [number]
            continue
        drive = [has_begun(deflection - upper, rate, level) for level in units.levels[m]]
        back = (
            [has_begun(lower - deflection, -rate, level) for level in units.levels[m]]
            if np.isfinite(lower)
            else []
        )
        if units.is_linear:
            parts = [(drive[0], upper), *((side, lower) for side in back)]
            states += [heyoka.sum([side for side, _ in parts]), heyoka.sum([side * at for side, at in parts])]
        else:
            states.append(heyoka.sum([*drive, *(-side for side in back)]))
    return heyoka.cfunc(states, vars=[variable for variable, _ in motion.equations])


def parameters_of_pieces(units: ScaledSystem) -> Array:
    """Parameters of every contact in every piece of a load-dependent law.

    Parameters
    ----------
    units : Scaled
        The system.

    Returns
    -------
    Array
        (m, 2 L + 1, parameters): of piece p at L + p, back flanks before, the open contact at L. Scaled.
    """
    meshes, count = units.levels.shape
    table = np.zeros((meshes, 2 * count + 1, parameters_of_a_contact(units)))
    for piece in range(count):
        begin = units.levels[:, piece]
        for sign, edge in ((1, units.upper + begin), (-1, units.lower - begin)):
            rows = table[:, count + sign * (piece + 1)]
            rows[:, 0], rows[:, 1] = 1.0, edge
            odd = float(sign) ** np.arange(1, 5)  # the law is odd: its even powers turn on a back flank
            rows[:, 2:] = (units.pieces[:, piece] * odd[:, None, None]).reshape(meshes, -1)
    return table


@dataclass(frozen=True, eq=False)
class Switch:
    """Callback of every event: all contact states from the state there, in its lane of a batch."""

    states: Callable[..., Array]
    table: Array | None
    variables: int

    def __call__(self, integrator: Any, sign: int, lane: int | None = None) -> bool:
        """Set the parameters and go on."""
        time, state, parameters = integrator.time, integrator.state, integrator.pars
        if lane is not None:
            time, state, parameters = float(time[lane]), state[:, lane].copy(), parameters[:, lane]
        states = self.states(state[: self.variables], time=time)
        if self.table is not None:
            meshes, pieces, _ = self.table.shape
            states = self.table[np.arange(meshes), states.astype(int) + pieces // 2].ravel()
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


def _switches(units: ScaledSystem) -> list[tuple[int, float]]:
    """Contacts and deflections at which a contact opens, closes or changes the piece of its law."""
    switches = []
    for m, levels in enumerate(units.levels):
        opens = units.lower[m] < units.upper[m]
        edges = [*(units.upper[m] + levels), *(units.lower[m] - levels)] if opens else []
        switches += [(m, float(edge)) for edge in edges if np.isfinite(edge)]
    return switches


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
    expressions_of_problem = expressions(heyoka, problem, units)
    switches = _switches(units)
    switch = None
    if switches or not units.is_linear:
        states = contact_states(heyoka, units, expressions_of_problem)
        table = None if units.is_linear else parameters_of_pieces(units)
        switch = Switch(states, table, len(expressions_of_problem.equations))
    event = heyoka.t_event_batch if lanes else heyoka.t_event
    events = [event(expressions_of_problem.deflections[m] - at, callback=switch) for m, at in switches]
    heyoka.llvm_state.clear_memcache()
    heyoka.llvm_state.set_diskcache_enabled(False)
    start = np.r_[problem.start.displacement, problem.start.velocity / problem.frequency]
    start /= np.tile(units.unit, 2)
    count = parameters_of_a_contact(units) * len(expressions_of_problem.deflections)
    parameters = np.zeros(count if switch else 0)
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
