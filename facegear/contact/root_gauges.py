"""Gauges on both fillets of a tooth."""

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from facegear.arrays import Array
from facegear.contact.bodies.gauges import Gauges, gauges_on
from facegear.contact.section_error import SectionErrors
from facegear.contact.teeth import LOADED_SIDE
from facegear.geometry.design import Material
from facegear.mesh.hexahedra import hex_mesh
from facegear.mesh.tooth import FeTooth


@dataclass(frozen=True, eq=False)
class RootGauges:
    """Gauges (2, a, b) on the fillets of a tooth: below the loaded flank, then below the other one.

    a down the fillet, b along the face. `position` (2, a, b, 3) m and unit vectors `across` (2, a, b, 3) down
    the fillet, in the body frame with the tooth in the middle. `error` (b,): relative error of the largest
    stress at each place along the face that the mesh is measured to make (`contact.section_error`).
    """

    position: Array
    across: Array
    error: Array

    def along(self, body: str) -> Array:
        """Return the position of the gauges along the face.

        Parameters
        ----------
        body : str
            `pinion` or `face_gear`.

        Returns
        -------
        (b,) array
            m: y along the pinion's axis, or radius of the gear.
        """
        x, y = self.position[..., 0], self.position[..., 1]
        return np.asarray((y if body == "pinion" else np.hypot(x, y)).mean(axis=(0, 1)))

    @property
    def tangent_angle(self) -> Array:
        """Angle (rad), (2, a, b), between the fillet's tangent and the tooth's middle plane."""
        return np.arctan2(np.abs(self.across[..., 0]), np.abs(self.across[..., 2]))


def fillet_sides(body: str) -> tuple[str, str]:
    """Return the sides of a tooth's fillets: below the flank loaded when the pinion drives, then below the
    other.

    Parameters
    ----------
    body : str
        `pinion` or `face_gear`.

    Returns
    -------
    tuple[str, str]
        `left` and `right` in this order.
    """
    return (LOADED_SIDE[body], "left" if LOADED_SIDE[body] == "right" else "right")


def root_gauges(
    tooth: FeTooth, material: Material, errors: SectionErrors | None = None
) -> tuple[RootGauges, sp.csr_matrix]:
    """Place gauges on a tooth, and compute their readings from displacements.

    A gauge reads the normal stress (Pa) down the fillet, across its lines, with the surface in plane
    stress.

    Parameters
    ----------
    tooth : FeTooth
        Mesh of the tooth.
    material : Material
        Of the tooth.
    errors : SectionErrors, optional
        Errors of its mesh; None where they are not measured, which gives nan.

    Returns
    -------
    tuple[RootGauges, sp.csr_matrix]
        Gauges, and their readings (g, 3 n) by the displacements of the elastic body's n nodes, Pa/m.
    """
    mesh, number = hex_mesh(tooth.nodes, tooth.hexes)
    fillets: list[Gauges] = [
        gauges_on(mesh.doflocs.T, number[tooth.surfaces[f"fillet_{side}"].nodes], material)
        for side in fillet_sides(tooth.body)
    ]
    position = np.stack([fillet.position for fillet in fillets])
    gauges = RootGauges(
        position=position,
        across=np.stack([fillet.across for fillet in fillets]),
        error=np.full(position.shape[2], np.nan),
    )
    if errors is not None:
        gauges = replace(gauges, error=errors.at(gauges.along(tooth.body)))
    return gauges, sp.vstack([fillet.normal for fillet in fillets], format="csr")
