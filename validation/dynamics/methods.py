"""Integrators that are compared. Each gives coordinates (samples, n) at SAMPLES phases of every period, or
the tangents' matrix.

Each is prepared first (memory, compiling for this problem), then run as often as its time is taken.
"""

import contextlib
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.integrate import solve_ivp

from facegear.arrays import Array
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.integrator.kernel_system import TAU
from facegear.motion.requests import WIDTH, run_many
from facegear.motion.steady_state.orbits import monodromy
from validation.dynamics import heyoka_peer
from validation.dynamics.problems import SAMPLES, ComparedResult, Problem
from validation.dynamics.right_side import compiled_right_side, fixed_rk4, plain_right_side

Solve = Callable[[], Array]
Prepare = Callable[[Problem, float], Solve]
"""Function of problem and tolerance (or steps a period) that returns a run."""
TOLERANCES = tuple(10.0**-k for k in range(2, 13))
"""Tolerances that are compared, relative."""
LAW_TOLERANCES = TOLERANCES[1::2]
"""Tolerances for other laws, relative: heyoka.py compiles for 3 to 15 s for each of them."""
PATIENCE, PATIENCE_IRREGULAR = 2.0, 6.0
"""Largest CPU time of a run of a regular and of an irregular motion, s."""
STEPS = (16, 32, 64, 128, 256, 512, 1024, 2048, 4096)
"""Steps a period of the method with fixed steps."""


@dataclass(frozen=True)
class Method:
    """A name, how to prepare a run of it, and its settings: tolerances, or steps a period.

    A run integrates `together` trajectories at once, of which the first is returned.
    """

    name: str
    prepare: Prepare
    settings: Sequence[float]
    together: int = 1


def make_integrator(problem: Problem, tolerance: float = 1e-2) -> tuple[Integrator, Array]:
    """Return our integrator and the start.

    Parameters
    ----------
    problem : Problem
        The problem.
    tolerance : float
        Local tolerance, relative.

    Returns
    -------
    Integrator, (2, n) array
        Integrator; coordinates, and rates by phase, in the problem's unit.
    """
    integrator = Integrator(problem.system, problem.frequency, tolerance)
    return integrator, integrator.by_phase(problem.start)


def limit_time(
    derivative: Callable[[float, Array], Array], problem: Problem
) -> Callable[[float, Array], Array]:
    """Return a right-hand side that raises TimeoutError once the patience with a run is over.

    Parameters
    ----------
    derivative : callable
        Right-hand side: derivative (2 n,) at a phase in rad and a state (2 n,), in the problem's unit.
    problem : Problem
        The problem, which decides the patience.

    Returns
    -------
    callable
        The same function of phase and state (2 n,), in the problem's unit.
    """
    patience = PATIENCE_IRREGULAR if problem.compared_result is ComparedResult.RMS else PATIENCE
    end = time.process_time() + patience

    def timed_derivative(s: float, z: Array) -> Array:
        if time.process_time() > end:
            raise TimeoutError(f"longer than {patience:g} s of CPU time")
        return derivative(s, z)

    return timed_derivative


def run_ours(problem: Problem, tolerance: float) -> Array:
    """Prepare and run Taylor steps with located contact switches.

    Parameters
    ----------
    problem : Problem
        The problem.
    tolerance : float
        Local tolerance, relative.

    Returns
    -------
    (samples, n) array
        Coordinates, in the problem's unit.
    """
    return prepare_ours(problem, tolerance)()


def prepare_ours(problem: Problem, tolerance: float) -> Solve:
    """Prepare Taylor steps with located contact switches.

    Parameters
    ----------
    problem : Problem
        The problem.
    tolerance : float
        Local tolerance, relative.

    Returns
    -------
    Solve
        The run.
    """
    integrator, start = make_integrator(problem, tolerance)

    def run() -> Array:
        return integrator.run(start, problem.periods, samples=SAMPLES).samples

    return run


def beside_others(problem: Problem, tolerance: float) -> Solve:
    """Prepare the first of as many trajectories as run side by side, which start as those of heyoka.py's
    batch.

    Parameters
    ----------
    problem : Problem
        The problem.
    tolerance : float
        Local tolerance, relative.

    Returns
    -------
    Solve
        The run.
    """
    integrator, start = make_integrator(problem, tolerance)
    starts = [start * (1.0 + heyoka_peer.APART * i) for i in range(WIDTH)]

    def run() -> Array:
        return run_many([integrator] * WIDTH, starts, problem.periods, samples=SAMPLES)[0].samples

    return run


def our_tangents(problem: Problem, tolerance: float) -> Solve:
    """Prepare our tangents: derivatives (2 n, 2 n) of coordinates and rates after the periods by the first
    ones.

    Parameters
    ----------
    problem : Problem
        The problem.
    tolerance : float
        Local tolerance, relative.

    Returns
    -------
    Solve
        The run.
    """
    integrator, start = make_integrator(problem, tolerance)

    def run() -> Array:
        return monodromy(integrator, start, problem.periods)[0]

    return run


def rk4(problem: Problem, steps: float) -> Solve:
    """Prepare fixed steps with compiled accelerations, no event location.

    Parameters
    ----------
    problem : Problem
        The problem.
    steps : float
        Number of steps a period.

    Returns
    -------
    Solve
        The run.
    """
    integrator, start = make_integrator(problem)
    per_sample = round(steps) // SAMPLES

    def run() -> Array:
        count = problem.periods * SAMPLES
        return fixed_rk4(integrator, start, per_sample, TAU / steps, count)[:, : integrator.size]

    return run


def scipy_method(name: str, plain: bool = False) -> Prepare:
    """Return SciPy's solve_ivp on the compiled right-hand side, or on plain NumPy.

    Parameters
    ----------
    name : str
        Name of SciPy's method.
    plain : bool
        Whether the right-hand side is plain NumPy.

    Returns
    -------
    Prepare
        The method.
    """

    def prepare(problem: Problem, tolerance: float) -> Solve:
        integrator, state = make_integrator(problem)
        start = state.ravel()
        derivative = compiled_right_side(integrator)
        if plain:
            derivative = plain_right_side(problem.system, problem.frequency)
        times = TAU * np.arange(problem.periods * SAMPLES) / SAMPLES

        def run() -> Array:
            solution = solve_ivp(
                limit_time(derivative, problem),
                (0.0, TAU * problem.periods),
                start,
                name,
                t_eval=times,
                rtol=max(tolerance, 3e-14),
                atol=tolerance * np.abs(start).max(),
            )
            if not solution.success:
                raise RuntimeError(solution.message)
            return solution.y[: problem.system.size].T

        return run

    return prepare


def cvode(method: str) -> Prepare:
    """Return SUNDIALS CVODE through scikit-sundae.

    Parameters
    ----------
    method : str
        `BDF` or `Adams`.

    Returns
    -------
    Prepare
        The method.

    Raises
    ------
    ImportError
        If scikit-sundae is not installed.
    """
    from sksundae.cvode import CVODE

    def prepare(problem: Problem, tolerance: float) -> Solve:
        integrator, state = make_integrator(problem)
        start = state.ravel()
        right_side = compiled_right_side(integrator)
        times = TAU * np.arange(problem.periods * SAMPLES) / SAMPLES

        def run() -> Array:
            inside = limit_time(right_side, problem)

            def derivative(s: float, y: Array, out: Array) -> None:
                out[:] = inside(s, np.array(y))

            solver = CVODE(
                derivative,
                method=method,
                rtol=max(tolerance, 1e-14),
                atol=tolerance * np.abs(start).max(),
                max_num_steps=100_000,
            )
            solution = solver.solve(times, start)
            if not solution.success:
                raise RuntimeError(str(solution.message))
            return solution.y[:, : problem.system.size]

        return run

    return prepare


def heyoka_methods() -> list[Method]:
    """Return heyoka.py with its own event handling, alone and in a batch as wide as ours.

    Returns
    -------
    list[Method]
        Both methods.

    Raises
    ------
    ImportError
        If heyoka.py is not installed.
    """
    import heyoka

    return [
        Method("heyoka.py", heyoka_peer.trajectory(heyoka), TOLERANCES),
        Method(f"heyoka.py, each of {WIDTH}", heyoka_peer.batch(heyoka, WIDTH), TOLERANCES, WIDTH),
    ]


def heyoka_tangents() -> Method:
    """Return heyoka.py's variational equations.

    Returns
    -------
    Method
        The method.

    Raises
    ------
    ImportError
        If heyoka.py is not installed.
    """
    import heyoka

    return Method("heyoka.py", heyoka_peer.tangents(heyoka), TOLERANCES)


def all_methods() -> list[Method]:
    """List all methods, ours first.

    CVODE and heyoka.py are left out where they are not installed (no wheel for a platform).

    Returns
    -------
    list[Method]
        The methods.
    """
    methods = [
        Method("facegear", prepare_ours, TOLERANCES),
        Method(f"facegear, each of {WIDTH}", beside_others, TOLERANCES, WIDTH),
    ]
    with contextlib.suppress(ImportError):
        methods += heyoka_methods()
    methods.append(Method("RK4 fixed", rk4, STEPS))
    for name in ("RK45", "DOP853", "LSODA", "Radau"):
        methods.append(Method(f"SciPy {name}", scipy_method(name), TOLERANCES))
    methods.append(Method("SciPy RK45, NumPy", scipy_method("RK45", plain=True), TOLERANCES))
    with contextlib.suppress(ImportError):
        methods += [Method(f"CVODE {name}", cvode(name), TOLERANCES) for name in ("BDF", "Adams")]
    return methods


def law_methods() -> list[Method]:
    """List the methods for other laws, ours first: both layouts of each Taylor method, and SciPy's DOP853.

    Returns
    -------
    list[Method]
        The methods.
    """
    methods = [
        Method("facegear", prepare_ours, LAW_TOLERANCES),
        Method(f"facegear, each of {WIDTH}", beside_others, LAW_TOLERANCES, WIDTH),
    ]
    with contextlib.suppress(ImportError):
        methods += [replace(method, settings=LAW_TOLERANCES) for method in heyoka_methods()]
    return [*methods, Method("SciPy DOP853", scipy_method("DOP853"), LAW_TOLERANCES)]


def tangent_methods() -> list[Method]:
    """List the methods that carry tangents, ours first.

    Returns
    -------
    list[Method]
        The methods.
    """
    methods = [Method("facegear", our_tangents, TOLERANCES)]
    with contextlib.suppress(ImportError):
        methods.append(heyoka_tangents())
    return methods
