"""A system at one mesh frequency, ready to be integrated; the kernels' data stays inside."""

from collections.abc import Sequence
from functools import cached_property
from typing import Any

import numpy as np

from facegear._kernels import motion
from facegear.arrays import Array
from facegear.motion.integrator.kernel_system import (
    TAU,
    fastest,
    lower_edges,
    make_runner,
    pack,
    packed_system,
    shift_count,
    weights_of,
)
from facegear.motion.integrator.records import (
    Extrema,
    RunResult,
    Steps,
    disturbance_step,
    extrema_of,
    require,
    steps_of,
    sums_of,
)
from facegear.motion.integrator.system import System
from facegear.motion.plan import Settings, State


class Integrator:
    """Integrator of a system at one mesh frequency.

    A state by phase (2, n) holds the coordinates y, then dy/ds by the mesh phase s = frequency * t in
    rad. The coordinates of a machine are mass-normalised: m kg^0.5, which is written as m here.

    Parameters
    ----------
    system : System
        Equations of motion.
    frequency : float
        Angular mesh frequency, rad/s.
    tolerance : float
        Local error of a step over the length scale.
    order : int, optional
        Order of the Taylor polynomials; Settings.taylor_order of the tolerance if None.
    like : Integrator, optional
        Integrator whose scratch space is used if its system has the same sizes. Of two integrators that share
        their scratch space only one may run at a time.
    """

    def __init__(
        self,
        system: System,
        frequency: float,
        tolerance: float = Settings.tolerance,
        order: int | None = None,
        like: "Integrator | None" = None,
    ) -> None:
        self.system, self.frequency, self.tolerance = system, frequency, tolerance
        self.machine: motion.Machine = pack(system, frequency, tolerance)
        if order is None:
            order = Settings(tolerance=tolerance).taylor_order
        kernel_system = packed_system(system)
        shares = like is not None and like.order == order and packed_system(like.system).fits(kernel_system)
        self.work: motion.Runner = like.work if like is not None and shares else make_runner(system, order)

    @property
    def size(self) -> int:
        """Number of coordinates n."""
        return self.system.size

    @property
    def rows(self) -> int:
        """Number m of rows: meshes or flanks, then three for each bearing with clearance."""
        return len(self.system.mesh_jacobian)

    @property
    def contacts(self) -> int:
        """Number of contacts: of flanks (two a mesh) where the system has two flanks, else of meshes."""
        return self.system.contacts

    @property
    def meshes(self) -> int:
        """Number of meshes (pairs of flanks); with one contact a mesh all m rows, those of rings
        included.
        """
        return self.system.pairs or self.rows

    @property
    def order(self) -> int:
        """Order of the Taylor polynomials of the steps."""
        return int(self.work.order)

    @property
    def scale(self) -> float:
        """Length scale of the system, m: the tolerance is a fraction of it."""
        return self.system.scale

    @property
    def weights(self) -> Array:
        """Largest deflection of a mesh or friction direction by one unit of each coordinate, (n,)."""
        return weights_of(self.system)

    @property
    def damping(self) -> Array:
        """Damping of each coordinate in the equation by phase, (n,), 1/rad: by time over the frequency."""
        return self.system.damping / self.frequency

    @property
    def omega_squared(self) -> Array:
        """Squared bearing frequency of each coordinate over the squared mesh frequency, (n,)."""
        return self.system.omega_squared / self.frequency**2

    @property
    def mesh_jacobian(self) -> Array:
        """Matrix (m, n) that turns coordinates y into deflections, before the errors are subtracted."""
        return self.system.mesh_jacobian

    @property
    def edges(self) -> tuple[Array, Array]:
        """Lower and upper edge (m,) of each row, m: open between them, never open if lower >= upper."""
        return lower_edges(self.system), self.system.upper

    @property
    def fastest(self) -> float:
        """Bound of the angular frequencies in the system's response, over the mesh frequency."""
        return fastest(self.system, self.frequency)

    def by_phase(self, state: State) -> Array:
        """Convert a state by time to a state by phase.

        Parameters
        ----------
        state : State
            Displacement and velocity by time.

        Returns
        -------
        (2, n) array
            Coordinates and their derivatives by phase, m and m/rad.
        """
        return np.array([state.displacement, state.velocity / self.frequency])

    def by_time(self, state: Array) -> State:
        """Convert a state by phase to a state by time.

        Parameters
        ----------
        state : (2, n) array
            Coordinates and their derivatives by phase, m and m/rad.

        Returns
        -------
        State
            Displacement and velocity by time.
        """
        return State(state[0].copy(), state[1] * self.frequency)

    @cached_property
    def longest_step(self) -> float:
        """Longest step, rad of mesh phase, of runs that are `fine` or have tangents; see
        disturbance_step().
        """
        return disturbance_step(self.fastest, self.order, self.tolerance)

    def run(
        self,
        state: Array,
        periods: int,
        tangents: Array | None = None,
        samples: int = 0,
        batches: int = 0,
        growth: bool = False,
        fine: bool = False,
        drift: Array | None = None,
    ) -> RunResult:
        """Run whole mesh periods from a state, which is not changed.

        Parameters
        ----------
        state : (2, n) array
            State by phase at the start, m and m/rad.
        periods : int
            Number of mesh periods.
        tangents : (columns, 2, n) array, optional
            Disturbances that are integrated along, any unit.
        samples : int
            Number of evenly spaced samples of the coordinates in each period; 0 for none.
        batches : int
            Number of batches of whole periods over which integrals are summed up, see Sums; 0 for none.
        growth : bool
            Whether the one tangent is scaled back to length one after every period.
        fine : bool
            Whether steps are as short as tangents need; with tangents they always are.
        drift : (terms, up to m) array, optional
            Polynomial that is added to the error e of each row in every period: coefficients by ascending
            powers of the phase since the start of the period, m/rad^power.

        Returns
        -------
        RunResult
            State at the end and all that was requested.

        Raises
        ------
        NotConverged
            If a step fails.
        """
        log = self._run(
            state,
            periods,
            tangents=tangents,
            samples=samples,
            batches=batches,
            growth=growth,
            fine=fine or tangents is not None,
            drift=drift,
        )
        return result_of(log, 0, self, periods)

    def advance_period(self, state: Array) -> Array:
        """Advance a state by one mesh period, with steps as short as tangents need.

        Parameters
        ----------
        state : (2, n) array
            State by phase at the start of a mesh period, m and m/rad.

        Returns
        -------
        (2, n) array
            State one period later, m and m/rad.

        Raises
        ------
        NotConverged
            If a step fails.
        """
        return self._run(state, 1, fine=True).ends[0, 0]

    def steps(self, state: Array, periods: int, count: int, begin: float = 0.0) -> tuple[Array, int, Steps]:
        """Run whole mesh periods from a state and store the first steps.

        Parameters
        ----------
        state : (2, n) array
            State by phase at the start, m and m/rad.
        periods : int
            Number of mesh periods.
        count : int
            Number of first steps to store.
        begin : float
            Mesh phase at the start of the first period, rad: that period is cut to the rest of it.

        Returns
        -------
        (2, n) array
            State at the end, m and m/rad.
        int
            Number of steps of the whole run, also of those that are not stored.
        Steps
            The first `count` of them.

        Raises
        ------
        NotConverged
            If a step fails.
        """
        log = self._run(state, periods, begin=begin, steps=count)
        return log.ends[0, -1], int(log.steps[0]), steps_of(log)

    def extrema(self, state: Array, periods: int, count: int) -> Extrema:
        """Find the first maxima and minima of each deflection in a run.

        The steps are no longer than disturbances need.

        Parameters
        ----------
        state : (2, n) array
            State by phase at the start, m and m/rad.
        periods : int
            Number of mesh periods.
        count : int
            Number of maxima, and of minima, to store.

        Returns
        -------
        Extrema
            Extrema of each deflection.

        Raises
        ------
        NotConverged
            If a step fails.
        """
        log = self._run(state, periods, longest=self.longest_step, turns=count)
        return extrema_of(log, self.rows)

    def accelerations(self, phase: float, state: Array) -> Array:
        """Return the second derivatives of the coordinates by phase.

        Parameters
        ----------
        phase : float
            Mesh phase, rad.
        state : Array
            Coordinates and their derivatives by phase, (2, n), m and m/rad.

        Returns
        -------
        Array
            Second derivatives (n,), m/rad^2.
        """
        return motion.accelerations(self.work, self.machine, phase, np.ascontiguousarray(state))

    def _run(self, state: Array, periods: int, **options: Any) -> motion.Log:
        """Run this machine alone and return its log, see run_machines() for the options. Raises
        NotConverged.
        """
        log = run_machines(self.work, [self], [state], [periods], last_periods=periods, **options)
        require(int(log.status[0]))
        return log


def run_machines(
    runner: motion.Runner,
    integrators: Sequence[Integrator],
    states: Sequence[Array],
    periods: Sequence[int],
    last_periods: int,
    tangents: Array | None = None,
    samples: int = 0,
    batches: int = 0,
    growth: bool = False,
    fine: bool = False,
    longest: float = np.inf,
    begin: float = 0.0,
    drift: Array | None = None,
    steps: int = 0,
    turns: int = 0,
) -> motion.Log:
    """Run machines of one structure over whole mesh periods. Failures are in the log's `status`.

    Parameters
    ----------
    runner : motion.Runner
        Scratch space for their structure and order, from make_runner().
    integrators : sequence of Integrator
        The machines; all have n coordinates and m rows of meshes, flanks and rings.
    states : sequence of Array
        Start of each machine: coordinates and their derivatives by phase, (2, n), m and m/rad.
    periods : sequence of int
        Number of mesh periods of each machine.
    last_periods : int
        Number of last periods whose end states are stored in the log's `ends`.
    tangents : Array, optional
        Disturbances that are moved along, (columns, 2, n) of one machine or (machines, columns, 2, n), any
        unit.
    samples : int
        Number of samples of the coordinates in each period.
    batches : int
        Number of batches of the sums.
    growth : bool
        Whether the one tangent is brought back to length one after every period.
    fine : bool
        Whether steps are as short as tangents need.
    longest : float
        Longest step where `fine` is false, rad.
    begin : float
        Mesh phase at the start, rad.
    drift : Array, optional
        Addition (terms, up to m) to the error in every period by powers of the phase, m/rad^power.
    steps : int
        Number of first steps that are stored.
    turns : int
        Number of first maxima, and of first minima, that are stored of each deflection.

    Returns
    -------
    motion.Log
        Results of all machines; result_of(), steps_of() and extrema_of() read it.
    """
    first, count = integrators[0], len(integrators)
    n, m = first.size, first.rows + shift_count(first.system)
    columns = np.zeros((count, 0, 2, n)) if tangents is None else tangents.reshape(count, -1, 2, n)
    steps_up_to = [integrator.longest_step if fine else longest for integrator in integrators]
    polynomial = np.zeros((0, m))
    if drift is not None:
        polynomial = np.zeros((len(drift), m))
        polynomial[:, : drift.shape[1]] = drift
    return motion.run(
        runner,
        [integrator.machine for integrator in integrators],
        starts=np.array(states, dtype=float),
        periods=np.array(periods, dtype=np.int64),
        tangents=np.ascontiguousarray(columns),
        longest=np.array(steps_up_to, dtype=float),
        begin=begin,
        drift=polynomial,
        samples=samples,
        batches=batches,
        growth=growth,
        fine=fine,
        kept=last_periods,
        steps=steps,
        turns=turns,
    )


def result_of(log: motion.Log, number: int, integrator: Integrator, periods: int) -> RunResult:
    """Return the result of one machine from the log of a run of several. Raises NotConverged if its run
    failed.

    Parameters
    ----------
    log : motion.Log
        Log of the run.
    number : int
        Index of the machine in the run.
    integrator : Integrator
        The machine.
    periods : int
        Number of mesh periods that it has run.

    Returns
    -------
    RunResult
        State at the end and all that the run was asked for.
    """
    require(int(log.status[number]))
    ends = log.ends[number, :periods]
    has_fractions = len(log.fractions) > 0
    return RunResult(
        state=ends[-1],
        ends=ends,
        tangents=log.tangents[number],
        samples=log.samples[number, : periods * (log.samples.shape[1] // log.periods)],
        fractions=log.fractions[number, :, : integrator.rows] / (TAU * periods)
        if has_fractions
        else np.zeros((3, integrator.rows)),
        divergence=float(log.divergence[number]),
        growth=log.growth[number, :periods] if len(log.growth) else np.zeros(0),
        steps=int(log.steps[number]),
        sums=sums_of(log, number, integrator.size, integrator.rows),
    )
