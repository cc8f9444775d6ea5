"""One repeating part of a gear (a tooth with its share of the rim), or any body with one contact surface."""

from dataclasses import dataclass, field

import numpy as np
from skfem import MeshHex2

from facegear.arrays import Array, Integers, Mask
from facegear.geometry.design import Material

ROUNDING = 1e-12
"""Rounding error of positions over the largest, and of unit vectors."""


@dataclass(frozen=True, eq=False)
class ElasticBody:
    """Mesh of 27-node hexahedra with its contact surface, supports and cut faces.

    Nodes are those of the mesh in scikit-fem's numbering: displacement i of node k is dof 3 k + i of
    `ElementVector(ElementHex2())`.

    Attributes
    ----------
    mesh, material
        Elements and their elasticity.
    flank : (2 a + 1, 2 b + 1)
        Nodes of the contact surface, axis 0 across the profile and axis 1 along the width.
    normals : (2 a + 1, 2 b + 1, 3)
        Out of the body there.
    is_held : (n, 3)
        Marks dof kept at zero.
    left, right : (s,)
        Nodes of the two cut faces, in corresponding order; both empty for a body that does not repeat.
    turn : (3, 3)
        Rotation by one pitch about the gear's axis, which takes the left nodes to the right ones.
    mirror : (n,)
        Node behind the middle plane across the y axis of each node; empty for a body that is not its own
        mirror image.
    """

    mesh: MeshHex2
    material: Material
    flank: Integers
    normals: Array
    is_held: Mask
    left: Integers = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    right: Integers = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    turn: Array = field(default_factory=lambda: np.eye(3))
    mirror: Integers = field(default_factory=lambda: np.zeros(0, dtype=np.int64))

    def __post_init__(self) -> None:
        if self.flank.shape[0] % 2 == 0 or self.flank.shape[1] % 2 == 0:
            raise ValueError("the flank grid of quadratic elements has an odd number of nodes both ways")
        if self.left.size:
            gap = np.abs(self.points[self.left] @ self.turn.T - self.points[self.right]).max()
            if gap > 1e-9 * np.abs(self.points).max():
                raise ValueError(f"the cut faces do not match after one pitch: {gap:.1e} m apart")
        if self.mirror.size and not self._is_symmetric():
            raise ValueError("the body is not its own mirror image")

    def _is_symmetric(self) -> bool:
        """Whether nodes, held dof and the flank are the same behind the middle plane as before it."""
        image = self.points * np.array([1.0, -1.0, 1.0])
        image[:, 1] += self.points[:, 1].min() + self.points[:, 1].max()
        apart = np.abs(self.points[self.mirror] - image).max()
        return bool(
            apart <= ROUNDING * np.abs(self.points).max()
            and (self.is_held[self.mirror] == self.is_held).all()
            and (self.mirror[self.flank] == self.flank[:, ::-1]).all()
            and np.abs(self.normals[:, ::-1] * np.array([1.0, -1.0, 1.0]) - self.normals).max() <= ROUNDING
        )

    @property
    def points(self) -> Array:
        """Positions (n, 3) of the nodes, m."""
        return self.mesh.doflocs.T
