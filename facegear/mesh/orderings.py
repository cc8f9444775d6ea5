"""Node orders of the 27-node hexahedron and its faces in other programs, from i + 3 j + 9 k."""

import numpy as np

_CORNERS = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)]
_RING = [(1, 0, 0), (2, 1, 0), (1, 2, 0), (0, 1, 0), (1, 0, 2), (2, 1, 2), (1, 2, 2), (0, 1, 2)]
_UPRIGHT = [(0, 0, 1), (2, 0, 1), (2, 2, 1), (0, 2, 1)]
_GMSH_EDGES = [
    *[(1, 0, 0), (0, 1, 0), (0, 0, 1), (2, 1, 0), (2, 0, 1), (1, 2, 0)],
    *[(2, 2, 1), (0, 2, 1), (1, 0, 2), (0, 1, 2), (2, 1, 2), (1, 2, 2)],
]
_GMSH_FACES = [(1, 1, 0), (1, 0, 1), (0, 1, 1), (2, 1, 1), (1, 2, 1), (1, 1, 2)]
_VTK_FACES = [(0, 1, 1), (2, 1, 1), (1, 0, 1), (1, 2, 1), (1, 1, 0), (1, 1, 2)]


def _index(positions: list[tuple[int, int, int]]) -> np.ndarray:
    return np.array([i + 3 * j + 9 * k for i, j, k in positions])


GMSH27 = _index([*_CORNERS, *_GMSH_EDGES, *_GMSH_FACES, (1, 1, 1)])
VTK27 = _index([*_CORNERS, *_RING, *_UPRIGHT, *_VTK_FACES, (1, 1, 1)])
SERENDIPITY20 = _index([*_CORNERS, *_RING, *_UPRIGHT])
"""The 20 nodes of VTK's quadratic hexahedron and of C3D20 in Abaqus and CalculiX."""
QUAD9 = np.array([0, 2, 8, 6, 1, 5, 7, 3, 4])
"""Quadrilateral of nine nodes of gmsh and VTK, from i + 3 j."""

FACES = {
    "S1": _index([(1, 1, 0)])[0],
    "S2": _index([(1, 1, 2)])[0],
    "S3": _index([(1, 0, 1)])[0],
    "S4": _index([(2, 1, 1)])[0],
    "S5": _index([(1, 2, 1)])[0],
    "S6": _index([(0, 1, 1)])[0],
}
"""Abaqus names of the faces, by the lexicographic index of the face's middle node."""
