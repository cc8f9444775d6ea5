"""Images of a branch under the symmetries of its system, which are branches of the same system."""

from dataclasses import replace

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.branches.continuation import Branch
from facegear.dynamics.branches.period_map import PeriodMap
from facegear.dynamics.branches.points import BranchPoint
from facegear.dynamics.branches.segment import SMALL
from facegear.dynamics.branches.special import Special
from facegear.dynamics.integrator.kernel_system import TAU
from facegear.dynamics.symmetries import Symmetry
from facegear.errors import NotConverged

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
        Image with the same number of points.

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
        The image; its tangent is a difference over SMALL along the original's.

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
