"""Forces and moment of a mesh on its bodies, from the touching loads, averaged over the mesh cycle.

They are the sum of f . gap_p over all loads, gap_p the derivative of their gaps by a motion p of the
pinion: each load acts along the normal of the pinion where it is. The derivative of the whole energy of
the contact has f . C_p f / 2 as well, as other parts of the teeth give way differently.
"""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.contact.flanks import PinionSurface
from facegear.contact.position import LoadedPosition, Spot
from facegear.geometry.placement import body_rotation, pinion_angle, rotation

REACTION_COLUMNS = ("torque_n_m", "tangential_n", "axial_n", "overturning_n_m")


def touching_reactions(surface: PinionSurface, results: Sequence[LoadedPosition]) -> pd.DataFrame:
    """Tabulate the reactions, one row a torque.

    They are the force on the gear along the pinion's tangent, the force on either body along the gear's
    axis, and the moment about the line through the gear's centre along the pinion's tangent.

    Parameters
    ----------
    surface : PinionSurface
        Contact surface of the pinion.
    results : Sequence[LoadedPosition]
        Contact by position and torque.

    Returns
    -------
    pd.DataFrame
        Columns REACTION_COLUMNS.
    """
    rows = [(result.torque, *_reactions(surface, result)) for result in results]
    table = pd.DataFrame(rows, columns=list(REACTION_COLUMNS))
    return table.groupby("torque_n_m", as_index=False).mean()


def _reactions(surface: PinionSurface, result: LoadedPosition) -> Array:
    parts = [_of_spot(surface, result.position, spot) for spot in result.spots]
    return np.sum(parts, axis=0) if parts else np.zeros(3)


def _of_spot(surface: PinionSurface, position: float, spot: Spot) -> Array:
    """Return the reactions (3,) of the loads of one pair of teeth."""
    design = surface.design
    points = surface.exact(np.stack(np.divmod(spot.hats, surface.shape[1]), axis=-1).astype(float))
    angle = pinion_angle(design, position) + (spot.tooth - 0.5) * 2.0 * np.pi / design.pinion.teeth
    matrix = body_rotation("pinion", angle)
    tilt = rotation(np.array([1.0, 0.0, 0.0]), design.assembly.shaft_angle_error)
    middle = np.array([0.0, design.mean_radius, 0.0])
    force = (spot.force[:, None] * points.normal) @ (tilt @ matrix).T
    from_middle = (points.position @ matrix.T - middle) @ tilt.T
    about = from_middle[:, 1] * force[:, 2] - from_middle[:, 2] * force[:, 1]
    axial = -force[:, 2].sum()
    return np.array([force[:, 0].sum(), axial, design.mean_radius * axial - about.sum()])
