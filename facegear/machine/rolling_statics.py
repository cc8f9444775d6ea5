"""Static equilibrium with rolling bearings: Newton's method over the whole convex energy.

The energy is that of flanks, springs, bent shafts and bearings less the work of the loads. All positions take
their steps together, each with its line search; inner coordinates of a shaft are eliminated by
themselves. A weak spring to ground, in the matrix alone, gives bodies that nothing holds a next position, and
fades.
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property

import numpy as np

from facegear.arrays import Array, Integers
from facegear.bearings.equilibrium import CLOSE, LINE_STEPS, NARROW
from facegear.bearings.shaft_element import ElementResponse, ShaftElement
from facegear.machine.linear_model import LinearModel
from facegear.meshing.law import MeshLaw

TOLERANCE = 1e-13
"""Largest force out of balance, over the largest force, at which a search ends; dimensionless."""
ROUNDINGS = 8.0
"""Roundings of the largest terms of a sum by which forces may be out of balance at the end."""
STEPS, STEPS_WITHOUT_GAIN = 120, 8
"""Newton steps after which a search is given up, and after which it ends near balance where none of them came
closer: rounding decides there, and the account of all forces afterwards."""
STARTS, STALL_LIMIT = 3, 1e-12
"""Searches at most, and force out of balance over the largest one, dimensionless, that asks for another."""
NEARLY = 1e-9
"""Force out of balance over the largest force, dimensionless, from which on rounding may decide."""
FIRST_TIE, TIE_FALL, LAST_TIE = 1e-4, 0.03, 1e-11
"""Spring to ground over the stiffest contact, dimensionless: at first, its factor from step to step, and at
last."""
TOGETHER = 256
"""Positions that are solved together, so that matrices stay within some megabytes."""


@dataclass(frozen=True, eq=False)
class RollingProblem:
    """Flanks, springs and shafts on rolling bearings at K positions.

    Attributes
    ----------
    linear : LinearModel
        The machine without its rolling bearings.
    law : MeshLaw
        Law of the F flanks.
    cycles : (K,)
        Positions at which the law is taken, mesh periods.
    gaps : (K, F)
        Deflections at which flanks touch, m.
    elements : tuple of ShaftElement
        Shafts on rolling bearings.
    """

    linear: LinearModel
    law: MeshLaw
    cycles: Array
    gaps: Array
    elements: tuple[ShaftElement, ...]

    @cached_property
    def stiffness(self) -> Array:
        """Springs of the machine, without bearings with clearance, (n, n), N/m."""
        return self.linear.stiffness_without_rings

    @cached_property
    def rows(self) -> Array:
        """Derivatives (F, n) of the flanks' deflections by the coordinates."""
        return self.linear.rows[: self.gaps.shape[1]]

    @cached_property
    def stiffest(self) -> float:
        """Stiffness of the stiffest flank, N/m."""
        return float(self.law.steepest.max())

    def part(self, at: slice) -> "RollingProblem":
        """Return the problem at some of the positions.

        Parameters
        ----------
        at : slice
            The positions.

        Returns
        -------
        RollingProblem
            With the same machine.
        """
        return replace(self, cycles=self.cycles[at], gaps=self.gaps[at])


@dataclass(eq=False)
class RollingStates:
    """K positions of a `RollingProblem`; arrays have one row a position.

    Attributes
    ----------
    coordinates : (K, n)
        m and rad.
    inner : list of (K, m)
        Inner coordinates of each shaft, rad and J^0.5.
    beyond, flanks : (K, F)
        Compression of the flanks, m, and their forces, N.
    gradient : (K, n)
        Forces out of balance, N and N m.
    responses : list of ElementResponse
        Answer of each shaft.
    size, rounding : (K,)
        Largest force, and the error of sums of forces by rounding, N.
    """

    coordinates: Array
    inner: list[Array]
    beyond: Array
    flanks: Array
    gradient: Array
    responses: list[ElementResponse]
    size: Array
    rounding: Array

    def put(self, at: Integers, new_states: "RollingStates") -> None:
        """Replace the positions `at` (k,) by those of another object, in place.

        Parameters
        ----------
        at : (k,) array of int
            Numbers of the positions.
        new_states : RollingStates
            k positions.
        """
        for name in ("coordinates", "beyond", "flanks", "gradient", "size", "rounding"):
            getattr(self, name)[at] = getattr(new_states, name)
        for inner_coordinates, new_coordinates in zip(self.inner, new_states.inner, strict=True):
            inner_coordinates[at] = new_coordinates
        for response, new_response in zip(self.responses, new_states.responses, strict=True):
            for part in fields(response):
                getattr(response, part.name)[at] = getattr(new_response, part.name)

    def select(self, at: Integers) -> "RollingStates":
        """Return copies of the positions `at`.

        Parameters
        ----------
        at : (k,) array of int
            Numbers of the positions.

        Returns
        -------
        RollingStates
            k positions.
        """
        arrays = {
            name: getattr(self, name)[at]
            for name in ("coordinates", "beyond", "flanks", "gradient", "size", "rounding")
        }
        responses = [
            ElementResponse(**{part.name: getattr(response, part.name)[at] for part in fields(response)})
            for response in self.responses
        ]
        return RollingStates(inner=[inner[at] for inner in self.inner], responses=responses, **arrays)


def evaluate(
    problem: RollingProblem, at: Integers, coordinates: Array, inner: Sequence[Array]
) -> RollingStates:
    """Compute all forces at given coordinates.

    Parameters
    ----------
    problem : RollingProblem
        The problem.
    at : (k,) array of int
        Numbers of the positions.
    coordinates : (k, n) array
        m and rad.
    inner : sequence of (k, m) arrays
        Inner coordinates of each shaft, rad and J^0.5.

    Returns
    -------
    RollingStates
        The k positions.
    """
    linear, rows, gaps = problem.linear, problem.rows, problem.gaps[at]
    beyond = np.maximum(coordinates @ rows.T - gaps, 0.0)
    flanks = problem.law.force(problem.cycles[at], beyond)
    gradient = coordinates @ problem.stiffness + flanks @ rows - linear.loads
    size = np.maximum(np.abs(linear.loads / linear.lengths).max(), np.abs(flanks).max(axis=1))
    motions = np.abs(coordinates)
    terms = motions @ np.abs(problem.stiffness)
    terms += problem.law.steepest * (motions @ np.abs(rows).T + np.abs(gaps)) @ np.abs(rows)
    rounding = ROUNDINGS * np.finfo(float).eps * (terms / linear.lengths).max(axis=1)
    rings = linear.rings
    for coordinate, stiffness, clearance in zip(
        linear.ring_coordinates, rings.stiffness, rings.clearance, strict=True
    ):
        motion = coordinates[:, coordinate]
        distance = np.maximum(np.hypot(motion[:, 0], motion[:, 1]), clearance)
        gradient[:, coordinate] += stiffness * (1.0 - clearance / distance)[:, None] * motion
    responses = []
    for element, inner_part in zip(problem.elements, inner, strict=True):
        response = element.respond(coordinates[:, element.at], inner_part)
        gradient[:, element.at] += response.gradient[:, : element.at.size]
        size, rounding = np.maximum(size, response.size), rounding + response.rounding
        responses.append(response)
    return RollingStates(coordinates, list(inner), beyond, flanks, gradient, responses, size, rounding)


def find_states(problem: RollingProblem, coordinates: Array, inner: Sequence[Array]) -> RollingStates:
    """Find the equilibria of a problem; whether forces balance is for the caller to check.

    Parameters
    ----------
    problem : RollingProblem
        The problem.
    coordinates : (K, n) array
        Where the searches begin, m and rad.
    inner : sequence of (K, m) arrays
        Inner coordinates of each shaft there, rad and J^0.5.

    Returns
    -------
    RollingStates
        The equilibria.

    Raises
    ------
    NotConverged
        If a rolling element under centrifugal force finds no position.
    """
    parts = []
    for first in range(0, len(coordinates), TOGETHER):
        at = slice(first, first + TOGETHER)
        parts.append(
            _find_together(problem.part(at), coordinates[at], [inner_part[at] for inner_part in inner])
        )
    states = parts[0]
    for part in parts[1:]:
        states = _join(states, part)
    return states


def _join(first: RollingStates, second: RollingStates) -> RollingStates:
    """Return the positions of both objects one after the new_states."""
    names = ("coordinates", "beyond", "flanks", "gradient", "size", "rounding")
    arrays = {name: np.concatenate([getattr(first, name), getattr(second, name)]) for name in names}
    responses = [
        ElementResponse(
            **{
                part.name: np.concatenate([getattr(a, part.name), getattr(b, part.name)])
                for part in fields(a)
            }
        )
        for a, b in zip(first.responses, second.responses, strict=True)
    ]
    inner = [np.concatenate(pair) for pair in zip(first.inner, second.inner, strict=True)]
    return RollingStates(inner=inner, responses=responses, **arrays)


def imbalance(problem: RollingProblem, states: RollingStates) -> Array:
    """Return the largest force out of balance at each position, inner coordinates included.

    Parameters
    ----------
    problem : RollingProblem
        The problem.
    states : RollingStates
        K positions.

    Returns
    -------
    (K,) array
        N, moments divided by their arms.
    """
    worst = np.abs(states.gradient / problem.linear.lengths).max(axis=1)
    for element, response in zip(problem.elements, states.responses, strict=True):
        inner_part = np.abs(response.gradient[:, element.at.size :] / element.inner_arms)
        worst = np.maximum(worst, inner_part.max(axis=1, initial=0.0))
    return np.asarray(worst)


def _find_together(problem: RollingProblem, coordinates: Array, inner: Sequence[Array]) -> RollingStates:
    """Return the equilibria of K positions; a search whose tie faded too soon begins again where it ended."""
    active = np.arange(len(coordinates))
    states = evaluate(problem, active, coordinates, inner)
    for _ in range(STARTS):
        _descend(problem, states, active)
        active = np.flatnonzero(imbalance(problem, states) > STALL_LIMIT * states.size + states.rounding)
        if not active.size:
            break
    return states


def _descend(problem: RollingProblem, states: RollingStates, active: Integers) -> None:
    """Take Newton steps from the positions `active` of some states, in place."""
    least, since = np.full(len(states.size), np.inf), np.zeros(len(states.size), int)
    tie = FIRST_TIE
    for _ in range(STEPS):
        worst = imbalance(problem, states)
        is_closer = worst < 0.5 * least
        least = np.minimum(least, worst)
        since = np.where(is_closer | (worst > NEARLY * states.size), 0, since + 1)
        is_open = (worst > TOLERANCE * states.size + states.rounding) & (since < STEPS_WITHOUT_GAIN)
        active = active[is_open[active]]
        if not active.size:
            break
        current = states.select(active)
        states.put(active, _search_line(problem, active, current, *_step(problem, active, current, tie)))
        tie = max(TIE_FALL * tie, LAST_TIE)


def _step(
    problem: RollingProblem, at: Integers, states: RollingStates, tie: float
) -> tuple[Array, list[Array]]:
    """Return the Newton step of all coordinates (k, n) and of the inner ones of each shaft (k, m); `tie` as
    FIRST_TIE.
    """
    linear, rows = problem.linear, problem.rows
    spring = tie * problem.stiffest
    slopes = problem.law.slope(problem.cycles[at], states.beyond)
    matrix = problem.stiffness + np.diag(spring * linear.lengths**2)
    matrix = matrix + (rows.T[None] * slopes[:, None, :]) @ rows
    _add_ring_tangents(linear, states.coordinates, matrix)
    gradient, eliminated = states.gradient.copy(), []
    for element, response in zip(problem.elements, states.responses, strict=True):
        first = element.at.size
        block = response.matrix[:, first:, first:] + np.diag(spring * element.inner_arms**2)
        columns = np.concatenate(
            [response.matrix[:, first:, :first], response.gradient[:, first:, None]], axis=2
        )
        solution = np.linalg.solve(block, columns)
        through = response.matrix[:, :first, first:] @ solution
        index = np.ix_(np.arange(len(matrix)), element.at, element.at)
        matrix[index] += response.matrix[:, :first, :first] - through[:, :, :first]
        gradient[:, element.at] -= through[:, :, first]
        eliminated.append(solution)
    step = -np.linalg.solve(matrix, gradient[..., None])[..., 0]
    inner = [
        -solution[:, :, -1] - (solution[:, :, :-1] @ step[:, element.at, None])[..., 0]
        for element, solution in zip(problem.elements, eliminated, strict=True)
    ]
    return np.asarray(step), inner


def _add_ring_tangents(linear: LinearModel, coordinates: Array, matrix: Array) -> None:
    """Add the tangents of bearings with clearance at coordinates (k, n) to matrices (k, n, n), in place."""
    rings = linear.rings
    for at, stiffness, clearance in zip(
        linear.ring_coordinates, rings.stiffness, rings.clearance, strict=True
    ):
        motion = coordinates[:, at]
        distance = np.hypot(motion[:, 0], motion[:, 1])
        is_pressed = distance > clearance
        along = motion / np.where(is_pressed, distance, 1.0)[:, None]
        across = stiffness * (1.0 - clearance / np.where(is_pressed, distance, np.inf))
        tangent = across[:, None, None] * np.eye(2)
        tangent = tangent + (stiffness - across)[:, None, None] * along[:, :, None] * along[:, None, :]
        tangent[~is_pressed] = 0.0
        matrix[np.ix_(np.arange(len(matrix)), at, at)] += tangent


def _search_line(
    problem: RollingProblem, at: Integers, states: RollingStates, step: Array, inner: list[Array]
) -> RollingStates:
    """Return the positions along steps (k, n) and (k, m) at which the slope of the energy nearly vanishes.

    CLOSE of the slope at the beginning may remain, or what TOLERANCE allows. Fractions of the step follow
    Newton's method along the line, or halve the bracket where that leaves it.
    """
    lengths = problem.linear.lengths
    start = _slope(states, step, inner, problem.elements)
    travel = np.abs(step * lengths).sum(axis=1)
    limit = np.full(at.size, np.inf)
    for element, inner_part in zip(problem.elements, inner, strict=True):
        limit = np.minimum(limit, element.longest_step(step[:, element.at], inner_part))
        travel += np.abs(inner_part * element.inner_arms).sum(axis=1)
    noise = (TOLERANCE * states.size + states.rounding) * travel
    fraction, low, high = np.minimum(1.0, limit), np.zeros(at.size), np.full(at.size, np.inf)
    best, left = states, np.arange(at.size)
    for _ in range(LINE_STEPS):
        motion = fraction[left, None]
        trial = evaluate(
            problem,
            at[left],
            states.coordinates[left] + motion * step[left],
            [
                begin[left] + motion * inner_part[left]
                for begin, inner_part in zip(states.inner, inner, strict=True)
            ],
        )
        slope = _slope(trial, step[left], [inner_part[left] for inner_part in inner], problem.elements)
        if left.size == at.size:
            best = trial
        else:
            best.put(left, trial)
        high[left] = np.where(slope > 0.0, fraction[left], high[left])
        low[left] = np.where(slope > 0.0, low[left], fraction[left])
        is_narrow = high[left] - low[left] <= NARROW * high[left]
        is_close = np.abs(slope) <= CLOSE * np.abs(start[left]) + noise[left]
        is_spent = (slope < 0.0) & (fraction[left] >= limit[left])
        is_open = ~(is_narrow | is_close | is_spent)
        if not is_open.any():
            break
        left, slope = left[is_open], slope[is_open]
        curvature = _line_curvature(
            problem, at[left], trial.select(np.flatnonzero(is_open)), step, inner, left
        )
        with np.errstate(divide="ignore", invalid="ignore"):
            ahead = fraction[left] - slope / curvature
        is_bracketed = np.isfinite(high[left])
        middle = np.where(is_bracketed, 0.5 * (low[left] + high[left]), 4.0 * fraction[left])
        is_inside = (ahead > low[left]) & (ahead < np.minimum(high[left], 10.0 * fraction[left] + 1e-300))
        is_inside |= is_bracketed & (ahead > low[left]) & (ahead < high[left])
        fraction[left] = np.minimum(np.where(is_inside, ahead, middle), limit[left])
    return best


def _slope(
    states: RollingStates, step: Array, inner: Sequence[Array], elements: Sequence[ShaftElement]
) -> Array:
    """Return the derivative (k,), J, of the energy along steps (k, n) and (k, m)."""
    slope = (states.gradient * step).sum(axis=1)
    for element, response, inner_part in zip(elements, states.responses, inner, strict=True):
        slope += (response.gradient[:, element.at.size :] * inner_part).sum(axis=1)
    return np.asarray(slope)


def _line_curvature(
    problem: RollingProblem,
    at: Integers,
    states: RollingStates,
    step: Array,
    inner: Sequence[Array],
    left: Integers,
) -> Array:
    """Return the second derivative (k,), J, of the energy along the steps of the positions `left` (k,)."""
    motion = step[left]
    slopes = problem.law.slope(problem.cycles[at], states.beyond)
    curvature = (motion @ problem.stiffness * motion).sum(axis=1)
    curvature += (slopes * (motion @ problem.rows.T) ** 2).sum(axis=1)
    rings = np.zeros((left.size, motion.shape[1], motion.shape[1]))
    if problem.linear.rings.body.size:
        _add_ring_tangents(problem.linear, states.coordinates, rings)
        curvature += np.einsum("ki,kij,kj->k", motion, rings, motion)
    for element, response, inner_part in zip(problem.elements, states.responses, inner, strict=True):
        whole = np.concatenate([motion[:, element.at], inner_part[left]], axis=1)
        curvature += np.einsum("ki,kij,kj->k", whole, response.matrix, whole)
    return np.asarray(curvature)
