"""Structured meshes of both bodies, for gmsh, ParaView, Abaqus and CalculiX."""

from collections.abc import Mapping
from typing import Any

from facegear.config.base import parse
from facegear.config.mesh import Mesh, mesh_sizes
from facegear.config.tooth_pair import pair
from facegear.mesh.sector import SectorMesh, sector
from facegear.mesh.tooth import gear_tooth, pinion_tooth


def meshes(tooth_pair: Mapping[str, Any], mesh: Mapping[str, Any]) -> dict[str, SectorMesh]:
    """Sectors of `pinion` and `face_gear` with the teeth that the config exports."""
    design, section = pair(tooth_pair).design, parse(Mesh, mesh)
    sizes = mesh_sizes(section, design.module)
    teeth = {"pinion": pinion_tooth(design, sizes), "face_gear": gear_tooth(design, sizes)}
    return {body: sector(tooth, min(section.exported_teeth, tooth.teeth)) for body, tooth in teeth.items()}
