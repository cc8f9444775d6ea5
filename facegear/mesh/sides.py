"""Which side of which element each face of a named group is, in the names of Abaqus and CalculiX."""

import numpy as np

from facegear.mesh.orderings import FACES
from facegear.mesh.sector import SectorMesh


def element_faces(sector: SectorMesh, name: str) -> list[tuple[int, str]]:
    """Element index and side S1..S6 of every face of a group. Raises KeyError for an unknown group."""
    middle = sector.faces(name)[:, 4]
    sides = sector.hexes[:, list(FACES.values())]
    order = np.argsort(sides.ravel(), kind="stable")
    index = order[np.searchsorted(sides.ravel(), middle, sorter=order)]
    labels = list(FACES)
    return [(int(at // 6), labels[at % 6]) for at in index]
