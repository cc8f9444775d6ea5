"""A system at one mesh frequency, ready to be run: what the kernels need stays inside."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.integrator.compiled import TAU, Packed, pack
from facegear.dynamics.integrator.dense import (
    NO_STEPS,
    NO_TURNING_POINTS,
    Extrema,
    Steps,
    make_extrema,
    make_steps,
)
from facegear.dynamics.integrator.periods import (
    DONE,
    MAX_STEPS,
    NOT_FINITE,
    TOO_MANY_STEPS,
    Log,
    disturbance_step,
    run_periods,
)
from facegear.dynamics.integrator.sums import Sums, make_sums
from facegear.dynamics.integrator.system import System
from facegear.dynamics.integrator.work import Work, make_work, sizes
from facegear.dynamics.motion import Settings, State
from facegear.errors import NotConverged


@dataclass(frozen=True, eq=False)
class RunResult:
    """What a run over whole mesh periods has left. n coordinates, m rows of meshes, flanks and rings.

    Attributes
    ----------
    state : (2, n)
        At the end.
    ends : (periods, 2, n)
        At the end of each period.
    tangents : (columns, 2, n)
        Disturbances at the end.
    samples : (periods * samples, n)
        Coordinates at evenly spaced phases, from the start of each period.
    fractions : (3, m)
        Of time open, on the drive and on the back flank; only with samples, batches or tangents.
    divergence
        Integral of the trace of the equations' matrix; only with tangents.
    growth : (periods,)
        Logarithm of the growth of the one tangent in each period, if it was asked for.
    steps
        Their number.
    sums
        Integrals and extremes over batches of periods.
    """

    state: Array
    ends: Array
    tangents: Array
    samples: Array
    fractions: Array
    divergence: float
    growth: Array
    steps: int
    sums: Sums


class Integrator:
    """Runs a system at an angular mesh frequency (rad/s) from states (2, n): coordinates and their
    derivatives by mesh phase, in rad.

    tolerance: local error of a step over the length scale; order: of the steps, None: from the tolerance.
    `like`: an integrator whose scratch space is used where it is that of a system of the same sizes. Of two
    integrators that share theirs only one may run at a time.
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
        self.packed: Packed = pack(system, frequency)
        if order is None:
            order = Settings(tolerance=tolerance).taylor_order
        self._sizes = (order, *sizes(system, self.packed))
        shares = like is not None and like._sizes == self._sizes
        self.work: Work = like.work if like is not None and shares else make_work(system, self.packed, order)
        self._empty = np.zeros((0, 2, self.packed.omega_squared.size))

    @property
    def size(self) -> int:
        """Number of coordinates n."""
        return self.packed.n

    @property
    def rows(self) -> int:
        """Number m of meshes or flanks, and three for each bearing with clearance."""
        return self.packed.m

    @property
    def contacts(self) -> int:
        """Number of meshes or flanks."""
        return self.packed.contacts

    @property
    def meshes(self) -> int:
        """Number of meshes; of all rows where a mesh is one contact."""
        return self.packed.pairs or self.packed.m

    @property
    def order(self) -> int:
        """Order of the steps."""
        return self.work.order

    @property
    def scale(self) -> float:
        """Length that the tolerance means, m."""
        return self.packed.scale

    @property
    def weights(self) -> Array:
        """Largest deflection that one unit of each coordinate makes, (n,)."""
        return self.packed.weights[: self.packed.n]

    @property
    def damping(self) -> Array:
        """Damping of each coordinate per rad, (n,)."""
        return self.packed.damping[: self.packed.n]

    @property
    def omega_squared(self) -> Array:
        """Square of the bearing frequency of each coordinate over that of the mesh frequency, (n,)."""
        return self.packed.omega_squared[: self.packed.n]

    @property
    def mesh_jacobian(self) -> Array:
        """Deflections by coordinates, (m, n)."""
        return self.packed.transposed[: self.packed.m, : self.packed.n]

    @property
    def edges(self) -> tuple[Array, Array]:
        """Lower and upper edge of each row, (m,), m; of a mesh that never opens lower >= upper."""
        return self.packed.lower[: self.packed.m], self.packed.upper[: self.packed.m]

    @property
    def fastest(self) -> float:
        """Frequency of the fastest motion that the system answers with, over the mesh frequency."""
        return self.packed.fastest

    def by_phase(self, state: State) -> Array:
        """A state (2, n) by phase."""
        return np.array([state.displacement, state.velocity / self.frequency])

    def by_time(self, state: Array) -> State:
        """A state by time."""
        return State(state[0].copy(), state[1] * self.frequency)

    @cached_property
    def longest_step(self) -> float:
        """Longest step, rad, that disturbances of the motion may be moved over, whatever the motion does."""
        return disturbance_step(self.packed.fastest, self.order, self.tolerance)

    def padded(self, states: Array) -> Array:
        """States (..., n) as the kernels hold them; a copy."""
        padded = np.zeros((*states.shape[:-1], self.packed.omega_squared.size))
        padded[..., : self.packed.n] = states
        return padded

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
        """Run whole mesh periods from a state (2, n), which is left alone. Raises NotConverged.

        tangents (columns, 2, n): disturbances to be moved along; with `growth` the one is brought back to
        length one after every period. samples: of the coordinates in each period; batches: of the sums.
        fine: steps as short as tangents need, which they are with any. drift (terms, m): what is added to the
        error in every period, by powers of the phase.
        """
        moved = self._empty if tangents is None else self.padded(tangents)
        log = self._log(periods, samples, growth, batches)
        padded = self.padded(state)
        packed = self.packed if drift is None else self.packed._replace(drift=self._drift(drift))
        longest = self.longest_step if fine or len(moved) else np.inf
        status = run_periods(
            packed,
            self.work,
            padded[0],
            padded[1],
            moved,
            periods,
            samples,
            self.tolerance,
            log,
            longest,
            0.0,
        )
        require(status)
        n, m = self.packed.n, self.packed.m
        return RunResult(
            state=padded[:, :n],
            ends=log.ends[:, :, :n],
            tangents=moved[:, :, :n],
            samples=log.samples[:, :n],
            fractions=log.fractions[:, :m] / (TAU * periods),
            divergence=float(log.divergence[0]),
            growth=log.growth,
            steps=int(log.steps[0]),
            sums=log.sums,
        )

    def returned(self, state: Array) -> Array:
        """Where a state (2, n) is a mesh period later, by steps as short as tangents need. Raises
        NotConverged.
        """
        return self._run_alone(state, 1, self._period, self.longest_step)[:, : self.packed.n]

    @cached_property
    def _period(self) -> Log:
        """What returned() has written and nobody reads."""
        return self._log(1)

    def steps(self, state: Array, periods: int, count: int, begin: float = 0.0) -> tuple[Array, int, Steps]:
        """Run whole mesh periods from a state (2, n) at a phase `begin`, in rad, of the first one.

        Returns the state at the end, the number of steps and the first `count` of them. Raises NotConverged.
        """
        log = self._log(periods)._replace(kept=make_steps(self.packed, self.order, count))
        padded = self._run_alone(state, periods, log, np.inf, begin)
        return padded[:, : self.packed.n], int(log.steps[0]), log.kept

    def extrema(self, state: Array, periods: int, count: int) -> Extrema:
        """The first `count` maxima and minima of each deflection in a run from a state (2, n).

        Runs whole mesh periods; the steps are no longer than disturbances need. Raises NotConverged.
        """
        log = self._log(periods)._replace(extrema=make_extrema(self.packed, count))
        self._run_alone(state, periods, log, self.longest_step)
        return log.extrema

    def _run_alone(self, state: Array, periods: int, log: Log, longest: float, begin: float = 0.0) -> Array:
        """The padded state at the end of a run without tangents and samples."""
        padded = self.padded(state)
        moved = (padded[0], padded[1], self._empty)
        require(run_periods(self.packed, self.work, *moved, periods, 0, self.tolerance, log, longest, begin))
        return padded

    def _log(self, periods: int, samples: int = 0, growth: bool = False, batches: int = 0) -> Log:
        n = self.packed.omega_squared.size
        return Log(
            samples=np.zeros((periods * samples, n)),
            ends=np.zeros((periods, 2, n)),
            fractions=np.zeros((3, self.packed.lower.size)),
            divergence=np.zeros(1),
            growth=np.zeros(periods if growth else 0),
            steps=np.zeros(1, dtype=np.int64),
            sums=make_sums(self.packed, batches),
            kept=NO_STEPS,
            extrema=NO_TURNING_POINTS,
        )

    def _drift(self, drift: Array) -> Array:
        padded = np.zeros((len(drift), self.packed.lower.size))
        padded[:, : drift.shape[1]] = drift
        return padded


def require(status: int) -> None:
    """Raise NotConverged unless the status of a run is good."""
    reported = {
        TOO_MANY_STEPS: f"a mesh period took more than {MAX_STEPS} steps",
        NOT_FINITE: "the motion grew beyond all bounds",
    }
    if status != DONE:
        raise NotConverged("dynamics", "time integration", reported[status])
