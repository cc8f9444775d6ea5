"""Element sides of the faces of a named group, in the names of Abaqus and CalculiX."""

import numpy as np

from facegear.mesh.orderings import FACES
from facegear.mesh.sector import SectorMesh


def element_faces(sector: SectorMesh, name: str) -> list[tuple[int, str]]:
    """Return the element and its side of every face of a group.

    Parameters
    ----------
    sector : SectorMesh
        Mesh of the teeth.
    name : str
        Name of the group.

    Returns
    -------
    list[tuple[int, str]]
        Index of the element and side S1..S6.

    Raises
    ------
    KeyError
        For an unknown group.
    """
    middle = sector.faces(name)[:, 4]
    sides = sector.hexes[:, list(FACES.values())]
    order = np.argsort(sides.ravel(), kind="stable")
    index = order[np.searchsorted(sides.ravel(), middle, sorter=order)]
    labels = list(FACES)
    return [(int(at // 6), labels[at % 6]) for at in index]
