"""Root stress under an even load along a line of the flank, by which meshes and solvers are compared."""

from dataclasses import dataclass, replace

import numpy as np

from facegear.arrays import Array
from facegear.contact.bodies.compliance import flank_compliance
from facegear.contact.bodies.surface import interpolation
from facegear.contact.gear_flank import BUILDERS
from facegear.contact.options import Ends, Refinement
from facegear.contact.root_gauges import RootGauges, root_gauges
from facegear.contact.teeth import ContactSide, elastic_tooth
from facegear.teeth.design import Material, PairDesign
from facegear.teeth.mesh_sizes import MeshSizes
from facegear.teeth.tooth_mesh import FeTooth

HEIGHT = 0.25
"""Position of the line on the flank, 0 at its tip end to 1 at its root end, evenly in the mesh's rows."""


@dataclass(frozen=True, eq=False)
class LoadedTooth:
    """A tooth under an even line load of 1 N in all: forces `load` (nu, nv, 3) N on its flank's nodes.

    `stress` (2, a, b) Pa at the gauges of its fillets.
    """

    mesh: FeTooth
    side: ContactSide
    load: Array
    gauges: RootGauges
    stress: Array


def loaded_tooth(
    design: PairDesign,
    body: str,
    sizes: MeshSizes,
    material: Material,
    teeth: int,
    ends: Ends = "free",
    on_corners: bool = False,
) -> LoadedTooth:
    """Compute the stress of the middle tooth of a sector; sizes as they are given.

    Parameters
    ----------
    design : PairDesign
        The pair.
    body : str
        `pinion` or `face_gear`.
    sizes : MeshSizes
        Mesh sizes.
    material : Material
        Material of the body.
    teeth : int
        Number of teeth of the sector.
    ends : Ends
        Support of its cut faces.
    on_corners : bool
        Whether the line moves to the nearest row of element corners, which 20-node elements share.

    Returns
    -------
    LoadedTooth
        The tooth with its stress.

    Raises
    ------
    FacegearError
        If the mesh cannot be factorised.
    """
    mesh = BUILDERS[body](design, sizes)
    elastic, side = elastic_tooth(design, mesh, material)
    gauges, rows = root_gauges(mesh, material)
    load = line_load(elastic.points[elastic.flank], side, on_corners)
    strip = _loaded_rows(load.reshape(side.shape))
    strip_tooth = replace(elastic, flank=elastic.flank[strip], normals=elastic.normals[strip])
    compliance = flank_compliance(strip_tooth, Refinement(), teeth, 0, ends, gauges=rows)
    stress = -(compliance.readings[0] @ load.reshape(side.shape)[strip].ravel())
    stress = stress.reshape(gauges.position.shape[:3])
    forces = -load.reshape(*side.shape, 1) * elastic.normals
    return LoadedTooth(mesh, side, forces, gauges, stress)


def _loaded_rows(load: Array) -> slice:
    """Rows of whole elements that carry a load (nu, nv): the rest of the flank need not be condensed."""
    rows = np.flatnonzero(load.any(axis=1))
    first, last = int(rows[0]) // 2, max(-(int(rows[-1]) // -2), int(rows[0]) // 2 + 1)
    return slice(2 * first, 2 * last + 1)


def line_load(points: Array, side: ContactSide, on_corners: bool) -> Array:
    """Return the forces on the nodes of a contact surface, 1 N in all.

    Parameters
    ----------
    points : (nu, nv, 3) array
        Nodes of the surface, m.
    side : ContactSide
        The surface.
    on_corners : bool
        Whether the line moves to the nearest row of element corners.

    Returns
    -------
    (n,) array
        Forces, N.
    """
    row = HEIGHT * (side.flank_rows - 1)
    row = 2.0 * round(row / 2.0) if on_corners else row
    columns = side.shape[1]
    at = np.stack([np.full(columns, row), np.arange(float(columns))], axis=1)
    along = interpolation(at, side.shape)
    line = along @ points.reshape(-1, 3)
    lengths = np.linalg.norm(line[2::2] - line[:-2:2], axis=1)
    weights = np.zeros(columns)
    for offset, part in ((0, 1.0), (1, 4.0), (2, 1.0)):
        weights[offset : columns - 2 + offset : 2] += part * lengths / 6.0
    return np.asarray(along.T @ (weights / weights.sum()))
