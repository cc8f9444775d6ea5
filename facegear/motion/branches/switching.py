"""From one branch onto another: mirror images, doubled periods, broken symmetry, found motions.

The new branch is sought beside the special point, along the null vector of M + I or M - I (Doedel et al.
1991), with M the matrix of the period map.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from facegear.arrays import Array
from facegear.errors import NotConverged
from facegear.motion.branches.continuation import Branch, BranchEnd, ContinuationSettings, follow
from facegear.motion.branches.locate import locate, locate_grazes
from facegear.motion.branches.period_map import PeriodMap
from facegear.motion.branches.points import BranchPoint, at_parameter, solve_point
from facegear.motion.branches.segment import SMALL, Segment
from facegear.motion.branches.special import Special
from facegear.motion.integrator.kernel_system import TAU
from facegear.motion.plan import State
from facegear.motion.symmetries import Symmetry

WORST = 100.0
"""An image whose change over its period exceeds this, in tolerances of the map, is no motion of the
system.
"""


def image_state(period_map: PeriodMap, z: Array, u: float, symmetry: Symmetry) -> Array:
    """Return the weighted state, at the start of a mesh period, of the image of the motion through a state.

    Parameters
    ----------
    period_map : PeriodMap
        Map of the system, which has the symmetry.
    z : (2 n,) array
        Weighted state at the start of a mesh period, dimensionless.
    u : float
        Logarithm of the parameter, dimensionless.
    symmetry : Symmetry
        Maps motions to motions.

    Returns
    -------
    (2 n,) array
        Weighted state of the image, dimensionless.
    """
    integrator = period_map.integrator(u)
    weights = period_map.weights(integrator)
    state = (z / weights).reshape(2, -1) @ symmetry.matrix.T
    if symmetry.shift > 0.0:
        # The image is where the motion was a shift before: what the motion is at the start of a period the
        # image is a shift before the start of its next one.
        state = integrator.steps(state, 1, 0, TAU * (1.0 - symmetry.shift))[0]
    return np.asarray(weights * state.ravel())


def image_branch(branch: Branch, symmetry: Symmetry) -> Branch:
    """Return the image of a branch under a symmetry of its system.

    Its speeds, stability and special points are those of the branch itself; no continuation is needed.

    Parameters
    ----------
    branch : Branch
        Branch to map.
    symmetry : Symmetry
        Symmetry of its system.

    Returns
    -------
    Branch
        Image with the same number of points; its `image_of` is still that of the branch.

    Raises
    ------
    NotConverged
        If a point of the image is no periodic motion.
    """
    period_map = branch.period_map
    return replace(
        branch,
        points=[image_point(period_map, point, symmetry) for point in branch.points],
        specials=[_image_special(period_map, special, symmetry) for special in branch.specials],
    )


def image_point(period_map: PeriodMap, point: BranchPoint, symmetry: Symmetry) -> BranchPoint:
    """Return the image of a periodic motion under a symmetry of its system.

    Parameters
    ----------
    period_map : PeriodMap
        Map over whole mesh periods.
    point : BranchPoint
        The motion.
    symmetry : Symmetry
        Symmetry of its system.

    Returns
    -------
    BranchPoint
        The image; its tangent is a difference over SMALL along the original's, and its matrix is computed
        anew.

    Raises
    ------
    NotConverged
        If the image is no periodic motion.
    """
    z, u = image_state(period_map, point.z, point.u, symmetry), point.u
    ahead = point.x + SMALL * point.tangent
    image_ahead = np.append(image_state(period_map, ahead[:-1], ahead[-1], symmetry), ahead[-1])
    tangent = image_ahead - np.append(z, u)
    linear = period_map.linear(z, u)
    off = float(np.abs(linear.gap).max())
    if off > WORST * period_map.tolerance + 2.0 * float(np.abs(point.linear.gap).max()):
        location = f"{period_map.family.name} = {point.value:.9g}"
        raise NotConverged(
            "branches", location, f"the image changes by {off:.1e} length scales over a period"
        )
    return BranchPoint(
        x=np.append(z, u),
        tangent=tangent / np.linalg.norm(tangent),
        parity=point.parity,
        linear=linear,
        extrema=period_map.extrema(z, u),
    )


def _image_special(period_map: PeriodMap, special: Special, symmetry: Symmetry) -> Special:
    """Return the image of a special point: its point mapped, and the meshes and edge of a graze exchanged
    by the symmetry.
    """
    count = symmetry.contacts.size
    sources = symmetry.contacts.tolist()
    meshes = tuple(sources.index(mesh) if mesh < count else mesh for mesh in special.meshes)
    signs = [symmetry.signs[mesh] for mesh in meshes if mesh < count]
    return replace(
        special,
        point=image_point(period_map, special.point, symmetry),
        meshes=meshes,
        edge=int(special.edge * signs[0]) if signs else special.edge,
    )


ASIDE = (0.02, 0.005, 0.06, 0.15, 0.4, 1e-3)
"""Distances from a special point, in length scales, at which another branch is sought."""
NEAR_ROOT = 0.1
"""Part of the way to that orbit from which special points are looked for by multipliers: at the special point
itself one of them lies on the unit circle."""
LEFT = 0.3
"""Smallest fraction of the distance that must remain along the new direction."""


def doubled_branch(period_map: PeriodMap, special: Special, run: ContinuationSettings) -> Branch:
    """Follow the branch of twice the period that leaves a period doubling, until it meets itself shifted.

    Parameters
    ----------
    period_map : PeriodMap
        Map over whole mesh periods.
    special : Special
        The period doubling.
    run : ContinuationSettings
        Range of the parameter and step lengths.

    Returns
    -------
    Branch
        Branch that begins at the special point.

    Raises
    ------
    NotConverged
        If none is found near the point.
    """
    twice = period_map.over(2 * period_map.period)
    direction = _direction(special.point.linear.matrix, -1.0)

    def is_doubled(point: BranchPoint) -> bool:
        """Whether an orbit changes over the single period: it does not on the branch that doubles."""
        change = np.linalg.norm(period_map.gap(point.z, point.u))
        return bool(change > LEFT * np.linalg.norm(point.x - special.point.x))

    start = _aside(twice, special, direction, is_doubled)
    return _from(twice, special, start, run, BranchEnd.DOUBLING)


def symmetry_broken_branch(period_map: PeriodMap, special: Special, run: ContinuationSettings) -> Branch:
    """Follow the branch that leaves a branch point across the one on which it was found.

    Parameters
    ----------
    period_map : PeriodMap
        Map over whole mesh periods.
    special : Special
        The branch point.
    run : ContinuationSettings
        Range of the parameter and step lengths.

    Returns
    -------
    Branch
        Branch that begins at the special point.

    Raises
    ------
    NotConverged
        If none is found near the point.
    """
    direction = _direction(special.point.linear.matrix, 1.0)
    across = np.append(direction, 0.0)
    across -= special.point.tangent * (special.point.tangent @ across)
    start = _aside(period_map, special, across[:-1] / np.linalg.norm(across[:-1]))
    return _from(period_map, special, start, run, BranchEnd.SYMMETRY)


def _from(
    period_map: PeriodMap, special: Special, start: BranchPoint, run: ContinuationSettings, end: BranchEnd
) -> Branch:
    """Follow the branch through `start` away from a special point, which becomes its first point, and end
    it with `end`.

    `end` says why the branch ends at the special point. Grazes and special points between it and `start`
    are located, too.
    """
    child = follow(period_map, start, run, both_ways=False)
    origin = special.point
    away = start.x - origin.x
    linear = period_map.linear(origin.z, origin.u)
    extrema = period_map.extrema(origin.z, origin.u)
    root = replace(origin, tangent=away / np.linalg.norm(away), linear=linear, extrema=extrema)
    try:
        first, special_points = _first_stretch(period_map, root, start)
    except (NotConverged, np.linalg.LinAlgError) as error:
        failure = f"grazes before {start.value:.9g} were not looked for: {error}"
        first, special_points, child = (
            [root],
            [],
            replace(child, failed_attempts="; ".join(filter(None, [failure, child.failed_attempts]))),
        )
    behind = [replace(later, after=later.after + len(first)) for later in child.specials]
    points = [*first, *child.points]
    return replace(child, points=points, specials=[*special_points, *behind], ends=(end, child.ends[1]))


def _first_stretch(
    period_map: PeriodMap, root: BranchPoint, start: BranchPoint
) -> tuple[list[BranchPoint], list[Special]]:
    """Return the points from a special point `root` to the orbit `start` beside it, without that one, and
    the specials between.

    A point at NEAR_ROOT of the way divides the stretch: between it and the root only grazes are looked
    for.
    """
    near = Segment(period_map, replace(root, linear=start.linear), start).at(NEAR_ROOT)
    division = locate(period_map, near, start)
    behind = [replace(special, after=special.after + 1.0) for special in division.specials]
    return [root, near, *division.inner], [*locate_grazes(period_map, root, near, near.linear), *behind]


def through(period_map: PeriodMap, state: State, value: float, run: ContinuationSettings) -> Branch:
    """Find the orbit next to a state at a value of the parameter by Newton's method, and follow its
    branch both ways.

    Parameters
    ----------
    period_map : PeriodMap
        Map over the orbit's own number of mesh periods.
    state : State
        Displacement and velocity by time.
    value : float
        The parameter, in its unit.
    run : ContinuationSettings
        Range of the parameter and step lengths.

    Returns
    -------
    Branch
        Branch through the orbit.

    Raises
    ------
    NotConverged
        If Newton's method finds no orbit.
    """
    u = float(np.log(value))
    return follow(period_map, at_parameter(period_map, period_map.to_weighted(state, u), u), run)


def _direction(matrix: Array, goal: float) -> Array:
    """Return the real part, of unit length (2 n,), of the eigenvector whose multiplier is nearest to a
    goal (1 or -1).
    """
    values, vectors = np.linalg.eig(matrix)
    vector = vectors[:, np.argmin(np.abs(values - goal))].real
    return vector / np.linalg.norm(vector)


def _aside(
    period_map: PeriodMap,
    special: Special,
    direction: Array,
    is_new: Callable[[BranchPoint], bool] = lambda point: True,
) -> BranchPoint:
    """Find an orbit at a distance (one of ASIDE) from a special point along a direction (2 n,) of the
    weighted states.

    The parameter is free. The first orbit counts that lies along the direction and for which `is_new` is
    true: it lies on another branch than the special point. Its tangent points away from the special
    point. Raises NotConverged.
    """
    row = np.append(direction, 0.0)
    origin = special.point.x
    for distance in ASIDE:
        try:
            point = solve_point(period_map, origin + distance * row, row, row)
        except (NotConverged, np.linalg.LinAlgError):
            continue
        away = point.x - origin
        near = np.linalg.norm(away) < 4.0 * distance
        if near and row @ away > LEFT * np.linalg.norm(away) and is_new(point):
            return point
    raise NotConverged(
        "branches",
        f"{special.kind} at {period_map.family.name} = {special.point.value:.9g}",
        f"another branch at distances {', '.join(f'{d:g}' for d in ASIDE)}",
    )
