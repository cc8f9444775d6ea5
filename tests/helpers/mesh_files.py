"""Mesh files as meshio reads them."""

import meshio

from facegear.io.atomic import verify


def read_msh(path):
    """Nodes (N, 3), hexahedra (M, 27) in VTK's order, and the faces (F, 9) of every named group."""
    verify(path)
    mesh = meshio.read(path, file_format="gmsh")
    faces, group = mesh.cells_dict["quad9"], mesh.cell_data_dict["gmsh:physical"]["quad9"]
    names = {int(tag): name for name, (tag, dimension) in mesh.field_data.items() if dimension == 2}
    groups = {name: faces[group == tag] for tag, name in names.items()}
    return mesh.points, mesh.cells_dict["hexahedron27"], groups
