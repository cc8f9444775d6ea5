"""Speed sweeps: steady states at many speeds, each started from the one before."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from facegear.arrays import Array, Integers, Mask
from facegear.machine.loaded_modes import loaded_modes
from facegear.motion.plan import Settings, State, SweepPlan
from facegear.motion.requests import RunPlan, alone, side_by_side
from facegear.motion.steady_state.mirror_images import symmetry_broken
from facegear.motion.steady_state.response import SteadyState
from facegear.motion.steady_state.simulate import Model, StartedRun, start_run, static_start
from facegear.motion.steady_state.statistics import order_spectrum, spectrum
from facegear.motion.symmetries import Symmetry

T = TypeVar("T")
DEFLECTION = ("mean", "rms", "ac_rms", "minimum", "maximum", "rms_interval", "ac_rms_interval")
"""Moments of the mesh deflections that a sweep stores."""
TRANSLATION = ("rms", "ac_rms", "ac_rms_interval")
"""Moments of the bodies' translations that a sweep stores."""
TOGETHER = 64
"""Number of speeds whose motions are watched side by side."""


@dataclass(frozen=True, eq=False)
class Piece:
    """Results of one chunk in the order of running; P speeds, M meshes, B bodies, n coordinates.

    Attributes
    ----------
    motion, period : (P,) array
        Class of motion, and its mesh periods where it is periodic, else 0.
    deflection_* : (P, M) array
        Moments of the mesh deflections, m.
    mean_force, mean_force_magnitude, largest_force : (P, M) array
        Mean, mean magnitude and largest magnitude of the elastic mesh forces, without the damper's part, N.
    largest_pull : (P, M) array
        Largest force by which the damper of a contact pulls its flanks together, N.
    open_fraction, drive_fraction, back_fraction : (P, M) array
        Fractions of the time that a mesh is open, on its drive flank, and on its back flank.
    past_law_fraction : (P, M) array
        Fraction of the samples at which a mesh is compressed beyond the last level of its law.
    translation_* : (P, B, 3) array
        Moments of x, y, z, m.
    residual, periods_run : (P,) array
        Change over the period over the length scale, and number of mesh periods run.
    leading_multiplier, exponent_per_period, exponent_interval : (P,) array
        Floquet multiplier, Lyapunov exponent and its half-width; NaN where there is none.
    first_look_period, second_look_period : (P,) array
        Mesh periods of the motions to which two starts came (0: not periodic; both 0: two irregular classes)
        where the motion is not settled because they differ, else NaN.
    symmetry_broken : (P,) array
        Whether the motion is periodic and has mirror images that are other motions.
    spectrum : (P, M, orders) array
        Amplitude spectra of the mesh deflections, m.
    modal : (P, modes) array
        RMS of omega times the coordinate of every natural mode, without mean: the root of twice its
        potential energy, sqrt(J).
    modal_order : (P,) array
        Multiple of the mesh frequency at which the strongest mode moves most.
    displacement, velocity : (P, n) array
        State at the end of the run at each speed, by time.
    """

    speeds: Array
    motion: NDArray[np.str_]
    period: Integers
    deflection_mean: Array
    deflection_rms: Array
    deflection_ac_rms: Array
    deflection_minimum: Array
    deflection_maximum: Array
    deflection_rms_interval: Array
    deflection_ac_rms_interval: Array
    mean_force: Array
    mean_force_magnitude: Array
    largest_force: Array
    largest_pull: Array
    open_fraction: Array
    drive_fraction: Array
    back_fraction: Array
    past_law_fraction: Array
    translation_rms: Array
    translation_ac_rms: Array
    translation_ac_rms_interval: Array
    residual: Array
    leading_multiplier: Array
    exponent_per_period: Array
    exponent_interval: Array
    periods_run: Array
    first_look_period: Array
    second_look_period: Array
    symmetry_broken: Mask
    spectrum: Array
    modal: Array
    modal_order: Array
    displacement: Array
    velocity: Array

    @property
    def periodic(self) -> Mask:
        """Whether the motion at each speed (P,) is periodic."""
        return self.period > 0

    @property
    def after_irregular(self) -> Mask:
        """Whether this motion or an earlier one of the run is not periodic, shape (P,).

        An irregular motion hands on any of its states, so that rounding can decide which of several stable
        motions is met from there on.
        """
        return np.logical_or.accumulate(~self.periodic)

    @property
    def labels(self) -> list[str]:
        """Label of the motion at each speed: `period-n`, or its class where it is not periodic, see
        Motion.
        """
        return [
            f"period-{period}" if period else str(motion)
            for motion, period in zip(self.motion, self.period, strict=True)
        ]

    def part(self, speeds: slice) -> "Piece":
        """Return the results at some of the speeds.

        Parameters
        ----------
        speeds : slice
            Positions of the speeds.

        Returns
        -------
        Piece
            Results at these speeds.
        """
        return Piece(**{name: getattr(self, name)[speeds] for name in self.__dataclass_fields__})

    def tail(self, start: int) -> "Piece":
        """Return the results from one speed of the piece on.

        Parameters
        ----------
        start : int
            Position of the first speed.

        Returns
        -------
        Piece
            Results at these speeds.
        """
        return self.part(slice(start, None))

    def state(self, index: int) -> State:
        """Return the state at the end of one speed.

        Parameters
        ----------
        index : int
            Position of the speed.

        Returns
        -------
        State
            Displacement and velocity.
        """
        return State(self.displacement[index], self.velocity[index])


def join_pieces(pieces: list[Piece]) -> Piece:
    """Join pieces one after another.

    Parameters
    ----------
    pieces : list of Piece
        Pieces in the order of running.

    Returns
    -------
    Piece
        Results at all speeds.
    """
    names = Piece.__dataclass_fields__
    return Piece(**{name: np.concatenate([getattr(piece, name) for piece in pieces]) for name in names})


def run_chunk(
    model: Model, plan: SweepPlan, direction: str, number: int, step: Callable[[], None] = lambda: None
) -> tuple[Piece, Piece]:
    """Run the overlap and the chunk's own speeds, see SweepPlan.chunk(); the first starts from static
    equilibrium.

    Parameters
    ----------
    model : Model
        Reduced machine.
    plan : SweepPlan
        Speeds and settings.
    direction : str
        "up" or "down".
    number : int
        Number of the chunk, from 0.
    step : callable
        Called without arguments after each speed.

    Returns
    -------
    tuple of Piece
        Results at the overlap and at the own speeds.
    """
    before, own_speeds = plan.chunk(direction, number)
    responses = run_speeds(model, np.concatenate([before, own_speeds]), plan.settings, None, step)
    piece = collect(model, responses)
    return piece.part(slice(len(before))), piece.tail(len(before))


def run_speeds(
    model: Model,
    speeds: Array,
    settings: Settings,
    start: State | None,
    step: Callable[[], None] = lambda: None,
    start_symmetries: Sequence[Symmetry] | None = None,
) -> Iterator[tuple[float, SteadyState]]:
    """Compute steady states at speeds in the given order, each started from the state of the one before.

    Parameters
    ----------
    model : Model
        Reduced machine.
    speeds : (P,) array
        Pinion speeds, rpm.
    settings : Settings
        Settings of the run.
    start : State or None
        Start at the first speed; the static equilibrium if None.
    step : callable
        Called without arguments after each speed.
    start_symmetries : sequence of Symmetry, optional
        Symmetries of the motion to which the start belongs; by default those of the start itself.

    Returns
    -------
    iterator of tuple
        Speed, rpm, and response, in the order of the speeds; computed as the iterator is read.
    """
    responses = carried_over(model, speeds, settings, start, StartedRun.follow, step, start_symmetries)
    return zip(speeds.tolist(), responses, strict=True)


def carried_over(
    model: Model,
    speeds: Array,
    settings: Settings,
    start: State | None,
    follow: Callable[[StartedRun], RunPlan[T]],
    step: Callable[[], None] = lambda: None,
    start_symmetries: Sequence[Symmetry] | None = None,
) -> Iterator[T]:
    """Run plans for the motions at speeds in the given order, each started from the state of the one
    before.

    The state that a motion hands on is known after its first watch. Where the motion has settled, this is a
    state of the motion on which it has settled. Else it is the last state, as good as any other of an
    irregular motion. The rest of TOGETHER speeds runs side by side.

    Parameters
    ----------
    model : Model
        Reduced machine.
    speeds : (P,) array
        Pinion speeds, rpm.
    settings : Settings
        Settings of the run.
    start : State or None
        Start at the first speed; the static equilibrium if None.
    follow : callable
        Makes of each StartedRun a run plan, which returns the value to yield.
    step : callable
        Called without arguments after each first watch.
    start_symmetries : sequence of Symmetry, optional
        Symmetries of the motion to which the start belongs; by default those of the start itself.

    Yields
    ------
    T
        Value that each plan returns.
    """
    state = static_start(model) if start is None else start
    for first in range(0, len(speeds), TOGETHER):
        motions = []
        for speed in speeds[first : first + TOGETHER]:
            motions.append(
                alone(start_run(model, float(speed), settings, state, start_symmetries=start_symmetries))
            )
            state, start_symmetries = motions[-1].state, motions[-1].motion_symmetries
            step()
        yield from side_by_side([follow(motion) for motion in motions])


def collect(model: Model, responses: Iterator[tuple[float, SteadyState]]) -> Piece:
    """Reduce responses at several speeds to the numbers that a sweep stores, an array a quantity.

    Parameters
    ----------
    model : Model
        Reduced machine.
    responses : iterator of tuple
        Speed, rpm, and response.

    Returns
    -------
    Piece
        Numbers at each speed.
    """
    machine = model.machine
    modes = loaded_modes(machine)
    to_modal = machine.linear.momentum(modes.shapes) * (2.0 * np.pi * modes.frequencies)
    basis = model.reduction.basis
    translations = basis[machine.linear.translations.ravel()].T
    views = np.hstack([translations, basis.T @ to_modal])
    rows = [_row(views, translations.shape[1], speed, response) for speed, response in responses]
    return Piece(**{name: np.array([row[name] for row in rows]) for name in Piece.__dataclass_fields__})


def _row(
    views: Array, directions: int, speed: float, response: SteadyState
) -> dict[str, Array | float | str]:
    """Return the numbers of one response that a sweep stores, by the names of Piece's fields.

    `views` (n, directions + modes) turns coordinates into the translations of all bodies along x, y, z,
    then into modes.
    """
    periodic = response.period > 0
    meshes = response.moments
    rms, ac_rms, interval = response.averages.views(views, periodic)
    modal = ac_rms[directions:]
    by_period = response.coordinates.reshape(response.periods, response.per_period, -1)
    strongest = (by_period @ views[:, directions + modal.argmax()]).reshape(-1, 1)
    orders, lines = spectrum(strongest - strongest.mean(), response.per_period, periodic)
    exponent, half = response.exponent or (np.nan, np.nan)
    looks = [np.nan] * 2 if response.looks is None else [look.period for look in response.looks]
    leading = np.nan if response.multipliers is None else abs(response.multipliers[0])
    translations = (values[:directions].reshape(-1, 3) for values in (rms, ac_rms, interval))
    return {
        "speeds": speed,
        "motion": response.motion.value,
        "period": response.period,
        **{f"deflection_{name}": getattr(meshes, name) for name in DEFLECTION},
        **dict(zip(("mean_force", "mean_force_magnitude"), response.mean_forces, strict=True)),
        "largest_force": response.largest_forces,
        "largest_pull": response.averages.pull,
        **dict(zip(("open_fraction", "drive_fraction", "back_fraction"), response.fractions, strict=True)),
        "past_law_fraction": response.past_law,
        **dict(zip((f"translation_{name}" for name in TRANSLATION), translations, strict=True)),
        "residual": response.residual,
        "leading_multiplier": leading,
        "exponent_per_period": exponent,
        "exponent_interval": half,
        "periods_run": float(response.periods_run),
        "first_look_period": float(looks[0]),
        "second_look_period": float(looks[1]),
        "symmetry_broken": symmetry_broken(response),
        "spectrum": order_spectrum(response.deflections, response.per_period, response.period),
        "modal": modal,
        "modal_order": orders[lines[1:, 0].argmax() + 1],
        "displacement": response.state.displacement,
        "velocity": response.state.velocity,
    }


def tighter(settings: Settings) -> Settings:
    """Return settings with half the tolerance and twice the dwell, to show the accuracy of a sweep's numbers.

    Parameters
    ----------
    settings : Settings
        Settings of the run.

    Returns
    -------
    Settings
        Settings of the same order of steps.
    """
    return replace(
        settings,
        tolerance=0.5 * settings.tolerance,
        order=settings.taylor_order,
        dwell=2 * settings.dwell,
        settle=2 * settings.settle,
        window=2 * settings.window,
    )
