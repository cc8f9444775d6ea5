"""The integrators that are compared; each gives coordinates (samples, n) at SAMPLES phases of every
period.
"""

import contextlib
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from facegear.dynamics.integrator.compiled import TAU, pack
from facegear.dynamics.integrator.periods import make_log, run_periods
from facegear.dynamics.integrator.work import make_work
from facegear.dynamics.motion import Settings
from facegear.dynamics.steady_state.orbits import require
from facegear.validation.dynamics.problems import SAMPLES, Problem
from facegear.validation.dynamics.right_side import compiled_right_side, fixed_rk4, plain_right_side

Array = NDArray[np.float64]
Runner = Callable[[Problem, float], Array]
TOLERANCES = tuple(10.0**-k for k in range(2, 13))
PATIENCE, PATIENCE_IRREGULAR = 2.0, 6.0
STEPS = (16, 32, 64, 128, 256, 512, 1024, 2048, 4096)


@dataclass(frozen=True)
class Method:
    """A name, how to run it, and its ladder of settings (tolerances, or steps a period)."""

    name: str
    run: Runner
    ladder: Sequence[float]


def start_of(problem: Problem) -> tuple[Array, int]:
    """Padded start (2 width,) by phase, and the width."""
    n = problem.system.size
    width = pack(problem.system, problem.frequency).omega_squared.size
    z = np.zeros(2 * width)
    z[:n] = problem.start.displacement
    z[width : width + n] = problem.start.velocity / problem.frequency
    return z, width


def limited(derivative: Callable[[float, Array], Array], problem: Problem) -> Callable[[float, Array], Array]:
    """The same right-hand side, which raises TimeoutError once the patience with a run is over."""
    patience = PATIENCE_IRREGULAR if problem.statistical else PATIENCE
    end = time.monotonic() + patience

    def checked(s: float, z: Array) -> Array:
        if time.monotonic() > end:
            raise TimeoutError(f"longer than {patience:g} s")
        return derivative(s, z)

    return checked


def ours(problem: Problem, tolerance: float) -> Array:
    """Taylor steps with located contact switches."""
    packed = pack(problem.system, problem.frequency)
    settings = Settings(tolerance=tolerance)
    z, width = start_of(problem)
    log = make_log(packed, problem.periods, SAMPLES)
    work = make_work(packed, settings.taylor_order)
    displacement, velocity = z[:width].copy(), z[width:].copy()
    none = np.zeros((0, 2, width))
    require(
        run_periods(packed, work, displacement, velocity, none, problem.periods, SAMPLES, tolerance, log, TAU)
    )
    return log.samples[:, : packed.n]


def rk4(problem: Problem, steps: float) -> Array:
    """Fixed steps, all compiled, no event location."""
    packed = pack(problem.system, problem.frequency)
    z, _ = start_of(problem)
    out = np.empty((problem.periods * SAMPLES, z.size))
    per_sample = round(steps) // SAMPLES
    fixed_rk4(packed, make_work(packed, 2), z, np.empty((5, z.size)), per_sample, TAU / steps, out)
    return out[:, : packed.n]


def scipy_method(name: str, plain: bool = False) -> Runner:
    """SciPy's solve_ivp on the compiled right-hand side, or on plain NumPy."""

    def run(problem: Problem, tolerance: float) -> Array:
        z, width = start_of(problem)
        if plain:
            derivative = plain_right_side(problem.system, problem.frequency, width)
        else:
            derivative = compiled_right_side(pack(problem.system, problem.frequency))
        derivative = limited(derivative, problem)
        times = TAU * np.arange(problem.periods * SAMPLES) / SAMPLES
        absolute = tolerance * np.abs(z).max()
        solution = solve_ivp(
            derivative,
            (0.0, TAU * problem.periods),
            z,
            name,
            t_eval=times,
            rtol=max(tolerance, 3e-14),
            atol=absolute,
        )
        if not solution.success:
            raise RuntimeError(solution.message)
        return solution.y[: problem.system.size].T

    return run


def cvode(method: str) -> Runner:
    """SUNDIALS CVODE through scikit-sundae. Raises ImportError where it is not installed."""
    from sksundae.cvode import CVODE

    def run(problem: Problem, tolerance: float) -> Array:
        z, _ = start_of(problem)
        compiled = limited(compiled_right_side(pack(problem.system, problem.frequency)), problem)

        def derivative(s: float, y: Array, out: Array) -> None:
            out[:] = compiled(s, np.array(y))

        times = TAU * np.arange(problem.periods * SAMPLES) / SAMPLES
        solver = CVODE(
            derivative,
            method=method,
            rtol=max(tolerance, 1e-14),
            atol=tolerance * np.abs(z).max(),
            max_num_steps=100_000,
        )
        solution = solver.solve(times, z)
        if not solution.success:
            raise RuntimeError(str(solution.message))
        return solution.y[:, : problem.system.size]

    return run


def all_methods() -> list[Method]:
    """Ours first. CVODE is left out where scikit-sundae is not installed (no wheel for the platform)."""
    methods = [Method("facegear", ours, TOLERANCES), Method("RK4 fixed", rk4, STEPS)]
    for name in ("RK45", "DOP853", "LSODA", "Radau"):
        methods.append(Method(f"SciPy {name}", scipy_method(name), TOLERANCES))
    methods.append(Method("SciPy RK45, NumPy", scipy_method("RK45", plain=True), TOLERANCES))
    with contextlib.suppress(ImportError):
        methods += [Method(f"CVODE {name}", cvode(name), TOLERANCES) for name in ("BDF", "Adams")]
    return methods
