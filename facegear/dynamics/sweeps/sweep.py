"""Speed sweeps: steady states at many speeds, each started from the one before."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from facegear.arrays import Array, Integers, Mask
from facegear.dynamics.courses import Course, alone, side_by_side
from facegear.dynamics.motion import Settings, State
from facegear.dynamics.steady_state.mirror_images import symmetry_broken
from facegear.dynamics.steady_state.response import SteadyState
from facegear.dynamics.steady_state.simulate import Model, StartedRun, start_run, static_start
from facegear.dynamics.steady_state.spectra import order_spectrum, spectrum
from facegear.dynamics.sweeps.plan import SweepPlan
from facegear.dynamics.symmetries import Symmetry
from facegear.transmission.loaded_modes import loaded_modes

T = TypeVar("T")
DEFLECTION = ("mean", "rms", "ac_rms", "minimum", "maximum", "rms_interval", "ac_rms_interval")
TRANSLATION = ("rms", "ac_rms", "ac_rms_interval")
TOGETHER = 64
"""Speeds whose motions are watched on side by side."""


@dataclass(frozen=True, eq=False)
class Piece:
    """Results of one chunk in the order of running; P speeds, M meshes, B bodies, n coordinates.

    motion (P,): class of motion, period (P,) its mesh periods where it is periodic, else 0. deflection_*
    (P, M): moments of the mesh deflections, m. mean_force, mean_force_magnitude (P, M) of the elastic mesh
    forces, without the damper's part, N; largest_force (P, M): their largest magnitude.
    largest_pull (P, M): largest force by which the damper of a contact pulls its flanks together, N.
    open_fraction, drive_fraction, back_fraction (P, M) of the time; past_law_fraction (P, M) of the samples,
    at which a mesh is pressed past the last level of its law. translation_* (P, B, 3): moments of x, y, z, m.
    residual, periods_run (P,); leading_multiplier, exponent_per_period, exponent_interval (P,): NaN where
    there is none. first_look_period, second_look_period (P,): mesh periods of the motions that two starts
    came to (0: not periodic) where the motion is not settled because they differ, else NaN. symmetry_broken
    (P,): whether the motion is periodic and has mirror images that are other motions. spectrum (P, M,
    orders), m. modal (P, modes): RMS velocity scale omega * coordinate of every natural mode without mean,
    sqrt(J). modal_order (P,): where in multiples of the mesh frequency the
    strongest mode moves most. displacement, velocity (P, n).
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
        """`period-n` or the class of motion at each speed."""
        return [
            f"period-{period}" if period else str(motion)
            for motion, period in zip(self.motion, self.period, strict=True)
        ]

    def part(self, speeds: slice) -> "Piece":
        """Some of the speeds."""
        return Piece(**{name: getattr(self, name)[speeds] for name in self.__dataclass_fields__})

    def tail(self, start: int) -> "Piece":
        """The speeds from position `start` on."""
        return self.part(slice(start, None))

    def state(self, index: int) -> State:
        """State at the end of one speed."""
        return State(self.displacement[index], self.velocity[index])


def joined(pieces: list[Piece]) -> Piece:
    """Pieces one after another."""
    names = Piece.__dataclass_fields__
    return Piece(**{name: np.concatenate([getattr(piece, name) for piece in pieces]) for name in names})


def run_chunk(
    model: Model, plan: SweepPlan, direction: str, number: int, step: Callable[[], None] = lambda: None
) -> tuple[Piece, Piece]:
    """Overlap and own speeds of a chunk, the first speed started from static equilibrium."""
    before, own = plan.chunk(direction, number)
    responses = run_speeds(model, np.concatenate([before, own]), plan.settings, None, step)
    piece = collect(model, responses)
    return piece.part(slice(len(before))), piece.tail(len(before))


def run_speeds(
    model: Model,
    speeds: Array,
    settings: Settings,
    start: State | None,
    step: Callable[[], None] = lambda: None,
    held: Sequence[Symmetry] | None = None,
) -> Iterator[tuple[float, SteadyState]]:
    """Steady states at speeds in the given order, the state carried over.

    held: symmetries of what the start belongs to, by default of the start itself.
    """
    responses = carried_over(model, speeds, settings, start, StartedRun.follow, step, held)
    return zip(speeds.tolist(), responses, strict=True)


def carried_over(
    model: Model,
    speeds: Array,
    settings: Settings,
    start: State | None,
    follow: Callable[[StartedRun], Course[T]],
    step: Callable[[], None] = lambda: None,
    held: Sequence[Symmetry] | None = None,
) -> Iterator[T]:
    """What comes of the motions at speeds in the given order, the state carried over.

    What a motion hands on is known after its first watch: where it has settled that is a state of the motion
    it has settled on, else the last one seen, as good as any other of an irregular motion. What is left to
    see of TOGETHER speeds runs side by side. held: as in run_speeds().
    """
    state = static_start(model) if start is None else start
    for first in range(0, len(speeds), TOGETHER):
        motions = []
        for speed in speeds[first : first + TOGETHER]:
            motions.append(alone(start_run(model, float(speed), settings, state, start_symmetries=held)))
            state, held = motions[-1].state, motions[-1].motion_symmetries
            step()
        yield from side_by_side([follow(motion) for motion in motions])


def collect(model: Model, responses: Iterator[tuple[float, SteadyState]]) -> Piece:
    """Reduce responses to the numbers that a sweep keeps."""
    machine = model.machine
    modes = loaded_modes(machine)
    to_modal = machine.linear.momentum(modes.shapes) * (2.0 * np.pi * modes.frequencies)
    basis = model.reduced.basis
    translations = basis[machine.linear.translations.ravel()].T
    views = np.hstack([translations, basis.T @ to_modal])
    rows = [_row(views, translations.shape[1], speed, response) for speed, response in responses]
    return Piece(**{name: np.array([row[name] for row in rows]) for name in Piece.__dataclass_fields__})


def _row(
    views: Array, directions: int, speed: float, response: SteadyState
) -> dict[str, Array | float | str]:
    """Numbers of one response; views (n, directions + modes) takes coordinates to translations and modes."""
    periodic = response.period > 0
    meshes = response.moments
    rms, ac_rms, interval = response.averages.views(views, periodic)
    modal = ac_rms[directions:]
    by_period = response.coordinates.reshape(response.periods, response.per_period, -1)
    strongest = (by_period @ views[:, directions + modal.argmax()]).reshape(-1, 1)
    orders, lines = spectrum(strongest - strongest.mean(), response.per_period, periodic)
    exponent, half = response.exponent or (np.nan, np.nan)
    first_look, second_look = response.looks or (np.nan, np.nan)
    leading = np.nan if response.multipliers is None else abs(response.multipliers[0])
    moved = (values[:directions].reshape(-1, 3) for values in (rms, ac_rms, interval))
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
        **dict(zip((f"translation_{name}" for name in TRANSLATION), moved, strict=True)),
        "residual": response.residual,
        "leading_multiplier": leading,
        "exponent_per_period": exponent,
        "exponent_interval": half,
        "periods_run": float(response.periods_run),
        "first_look_period": float(first_look),
        "second_look_period": float(second_look),
        "symmetry_broken": symmetry_broken(response),
        "spectrum": order_spectrum(response.deflections, response.per_period, response.period),
        "modal": modal,
        "modal_order": orders[lines[1:, 0].argmax() + 1],
        "displacement": response.state.displacement,
        "velocity": response.state.velocity,
    }


def tighter(settings: Settings) -> Settings:
    """Half the tolerance and twice the dwell, to show what a sweep's numbers are worth."""
    return replace(
        settings,
        tolerance=0.5 * settings.tolerance,
        order=settings.taylor_order,
        dwell=2 * settings.dwell,
        settle=2 * settings.settle,
        window=2 * settings.window,
    )
