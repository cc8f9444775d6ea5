"""Several teeth in a row, or the whole ring, merged from copies of one tooth."""

from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array, Integers
from facegear.errors import GeometryError
from facegear.mesh.tooth import FeTooth


@dataclass(frozen=True)
class SectorMesh:
    """Merged copies of one tooth in the body frame.

    nodes: (N, 3) m; hexes: (M, 27) ordered as in `FeTooth`, tooth after tooth.
    tooth_nodes: (n_teeth, nodes of one tooth) global node of each copy's node; tooth j stands at j pitches.
    first: index j of the first tooth; closed: whether the sector is the full ring.
    """

    tooth: FeTooth
    nodes: Array
    hexes: Integers
    tooth_nodes: Integers
    first: int
    is_closed: bool

    def faces(self, name: str) -> Integers:
        """Return the faces of a group over all teeth; cut faces only where the sector ends.

        Parameters
        ----------
        name : str
            Name of the group.

        Returns
        -------
        (F, 9) array of int
            Nodes of each face.

        Raises
        ------
        KeyError
            For a group that the tooth does not have.
        """
        if name in ("cut_left", "cut_right"):
            if self.is_closed:
                return np.empty((0, 9), dtype=np.int64)
            return self.tooth_nodes[0 if name == "cut_left" else -1][self.tooth.faces[name]]
        return self.tooth_nodes[:, self.tooth.faces[name]].reshape(-1, 9)


def sector(tooth: FeTooth, n_teeth: int, first: int = 0) -> SectorMesh:
    """Join teeth first .. first + n_teeth - 1 with shared nodes on the cuts; the full ring closes on itself.

    Parameters
    ----------
    tooth : FeTooth
        Mesh of a tooth.
    n_teeth : int
        Number of teeth.
    first : int
        Index of the first tooth.

    Returns
    -------
    SectorMesh
        Joined teeth.

    Raises
    ------
    GeometryError
        When n_teeth is not within 1 .. number of teeth.
    """
    if not 1 <= n_teeth <= tooth.teeth:
        raise GeometryError("teeth in the sector", n_teeth, f"between 1 and {tooth.teeth}")
    is_closed = n_teeth == tooth.teeth
    count = len(tooth.nodes)
    is_new_node = np.ones(count, dtype=bool)
    is_new_node[tooth.cut_left] = False
    new = int(np.count_nonzero(is_new_node))

    tooth_nodes = np.empty((n_teeth, count), dtype=np.int64)
    tooth_nodes[0] = np.arange(count)
    for j in range(1, n_teeth):
        tooth_nodes[j, is_new_node] = count + (j - 1) * new + np.arange(new)
        tooth_nodes[j, tooth.cut_left] = tooth_nodes[j - 1, tooth.cut_right]
    total = count + (n_teeth - 1) * new
    if is_closed and n_teeth > 1:
        renumber = np.arange(total)
        renumber[tooth_nodes[-1, tooth.cut_right]] = tooth_nodes[0, tooth.cut_left]
        kept_nodes = np.unique(renumber)
        tooth_nodes = np.searchsorted(kept_nodes, renumber[tooth_nodes])
        total = len(kept_nodes)

    nodes = np.empty((total, 3))
    for j in range(n_teeth - 1, -1, -1):
        nodes[tooth_nodes[j]] = tooth.rotated(tooth.nodes, (first + j) * tooth.pitch)
    return SectorMesh(
        tooth=tooth,
        nodes=nodes,
        hexes=tooth_nodes[:, tooth.hexes].reshape(-1, 27),
        tooth_nodes=tooth_nodes,
        first=first,
        is_closed=is_closed,
    )
