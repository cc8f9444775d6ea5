"""Meshes of both bodies as files for gmsh, ParaView, Abaqus and CalculiX."""

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import pandas as pd

from facegear.config.mesh import Mesh, mesh_sizes
from facegear.config.tooth_pair import ToothPair, pair
from facegear.mesh.export import write_files
from facegear.mesh.sector import SectorMesh, sector
from facegear.mesh.tooth import gear_tooth, pinion_tooth
from facegear.stages.outcome import Outcome

KINDS = ("msh", "vtu", "inp")


def mesh(tooth_pair: ToothPair, mesh: Mesh) -> Outcome:
    """Write the finite element meshes of both bodies.

    Parameters
    ----------
    tooth_pair : ToothPair
        Section `tooth_pair` of the config.
    mesh : Mesh
        Section `mesh` of the config.

    Returns
    -------
    Outcome
        `<body>_<kind>` (bytes of a mesh file) for both bodies and KINDS, and table `quality`.
    """
    content: dict[str, Any] = {}
    quality = []
    with TemporaryDirectory() as folder:
        for body, tooth in meshes(tooth_pair, mesh).items():
            files = [Path(folder, f"{body}.{kind}") for kind in KINDS]
            quality.append(write_files(tooth, *files))
            content |= {f"{body}_{kind}": file.read_bytes() for kind, file in zip(KINDS, files, strict=True)}
    table = pd.concat(quality, ignore_index=True)
    worst = table.query("quantity == 'scaled_jacobian'")["value"].min()
    elements = int(table.query("quantity == 'elements'")["value"].sum())
    summary = f"{elements} hexahedra, smallest scaled Jacobian {worst:.3f}"
    return Outcome({**content, "quality": table}, summary)


def meshes(tooth_pair: ToothPair, mesh: Mesh) -> dict[str, SectorMesh]:
    """Build sectors of both bodies with the teeth that the config exports.

    Parameters
    ----------
    tooth_pair : ToothPair
        Section `tooth_pair` of the config.
    mesh : Mesh
        Section `mesh` of the config.

    Returns
    -------
    dict[str, SectorMesh]
        Sectors of `pinion` and `face_gear`.
    """
    design = pair(tooth_pair).design
    sizes = mesh_sizes(mesh, design.module)
    teeth = {"pinion": pinion_tooth(design, sizes), "face_gear": gear_tooth(design, sizes)}
    return {body: sector(tooth, min(mesh.exported_teeth, tooth.teeth)) for body, tooth in teeth.items()}
