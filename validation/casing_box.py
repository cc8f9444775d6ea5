"""Make the casing of config/casing.yaml: a box meshed by gmsh, matrices by CalculiX, reduced by facegear.

`python -m validation.casing_box FOLDER` needs gmsh and meshio (extra `fe`) and the program `ccx`. It writes
the mesh, the input of CalculiX, its matrices (files of the kinds .sti, .mas and .dof), the list of nodes with
the patches of seats and feet, and an npz file: both matrices reduced to these patches and 30 modes, in mm, t
and s.
"""

import itertools
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np

from facegear.arrays import Array, Integers
from facegear.casing.files import read_casing
from facegear.casing.reduction import Interface, reduce_casing
from facegear.errors import FacegearError, extras_named

CUBES = (15, 13, 9)
"""Elements along x, y and z; the walls are one element thick."""
SIZE = 20.0
"""Edge of an element, mm."""
SEATS = {"p0": 101, "p1": 102, "p2": 103, "lower gear": 104, "upper gear": 105, "base": 301}
"""Numbers of the interfaces in the reduced casing."""
MODES = 30
"""Modes beside the motions of the interfaces."""
DECK = """*INCLUDE, INPUT={mesh}
*MATERIAL, NAME=ALUMINIUM
*ELASTIC
70000., 0.33
*DENSITY
2.7e-9
*SOLID SECTION, ELSET=EALL, MATERIAL=ALUMINIUM
*STEP
*FREQUENCY, SOLVER=MATRIXSTORAGE
10
*END STEP
"""
"""Input of CalculiX: it stores the matrices of all rows in place of a solution."""


def mesh_box(path: Path) -> None:
    """Write the mesh of the box: 20-node bricks by gmsh.

    Parameters
    ----------
    path : Path
        The file, `.msh`.
    """
    with extras_named():
        import gmsh
    gmsh.initialize()
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        half = 0.5 * SIZE * np.array(CUBES)
        edges = [(-h, -h + SIZE, h - SIZE, h) for h in half.tolist()]
        blocks = []
        for x, y, z in itertools.product(range(3), repeat=3):
            if (x, y, z) != (1, 1, 1):
                low = [edge[k] for edge, k in zip(edges, (x, y, z), strict=True)]
                high = [edge[k + 1] for edge, k in zip(edges, (x, y, z), strict=True)]
                sizes = [b - a for a, b in zip(low, high, strict=True)]
                blocks.append((3, gmsh.model.occ.addBox(*low, *sizes)))
        gmsh.model.occ.fragment(blocks[:1], blocks[1:])
        gmsh.model.occ.synchronize()
        for _, curve in gmsh.model.getEntities(1):
            length = gmsh.model.occ.getMass(1, curve)
            gmsh.model.mesh.setTransfiniteCurve(curve, round(length / SIZE) + 1)
        for _, surface in gmsh.model.getEntities(2):
            gmsh.model.mesh.setTransfiniteSurface(surface)
            gmsh.model.mesh.setRecombine(2, surface)
        for _, volume in gmsh.model.getEntities(3):
            gmsh.model.mesh.setTransfiniteVolume(volume)
        gmsh.model.addPhysicalGroup(3, [volume for _, volume in gmsh.model.getEntities(3)])
        gmsh.option.setNumber("Mesh.SecondOrderIncomplete", 1)
        gmsh.model.mesh.generate(3)
        gmsh.model.mesh.setOrder(2)
        gmsh.write(str(path))
    finally:
        gmsh.finalize()


def write_elements(mesh_path: Path, path: Path) -> tuple[Integers, Array]:
    """Write nodes and elements for CalculiX, and return the nodes.

    Parameters
    ----------
    mesh_path : Path
        The mesh, `.msh`.
    path : Path
        The file, `.inp`.

    Returns
    -------
    tuple of (nodes,) array of int and (nodes, 3) array
        Numbers, and coordinates in mm.
    """
    with extras_named():
        import meshio
    mesh = meshio.read(mesh_path)
    elements = np.concatenate([block.data for block in mesh.cells if block.type == "hexahedron20"])
    nodes, order = np.unique(elements, return_inverse=True)
    rows = np.add(order.reshape(elements.shape), 1)
    lines = ["*NODE, NSET=NALL"]
    lines += [f"{k}, {x:.12g}, {y:.12g}, {z:.12g}" for k, (x, y, z) in enumerate(mesh.points[nodes], start=1)]
    lines.append("*ELEMENT, TYPE=C3D20, ELSET=EALL")
    for number, element in enumerate(rows.tolist(), start=1):
        row = [number, *element]
        lines += [", ".join(map(str, row[:11])) + ",", ", ".join(map(str, row[11:]))]
    path.write_text("\n".join(lines) + "\n")
    return np.arange(1, nodes.size + 1), mesh.points[nodes]


def patches(coordinates: Array) -> dict[str, tuple[Array, Array]]:
    """Return the nodes of seats and base, with the point that each moves as.

    Parameters
    ----------
    coordinates : (nodes, 3) array
        mm.

    Returns
    -------
    dict of tuple of (nodes,) array of bool and (3,) array
        Mask and point (mm) by name. Seats are 80 x 80 mm through the walls, the base four corners of 40 x 40
        mm, the sensor a square of 20 mm near a corner of the cover.
    """
    half = 0.5 * SIZE * np.array(CUBES)
    patch_nodes = {}
    walls = {"p0": (0, 1), "p1": (1, 1), "p2": (0, -1), "lower gear": (2, -1), "upper gear": (2, 1)}
    for name, (axis, sign) in walls.items():
        across = np.delete(np.abs(coordinates), axis, axis=1).max(axis=1) <= 40.0 + 1e-6
        through = sign * coordinates[:, axis] >= half[axis] - SIZE - 1e-6
        point = np.zeros(3)
        point[axis] = sign * (half[axis] - 0.5 * SIZE)
        patch_nodes[name] = (across & through, point)
    outside = np.abs(coordinates[:, :2]) >= half[:2] - 40.0 - 1e-6
    is_base = outside.all(axis=1) & (coordinates[:, 2] <= -half[2] + 1e-6)
    patch_nodes["base"] = (is_base, np.array([0.0, 0.0, -half[2]]))
    return patch_nodes


def make_box(folder: Path) -> None:
    """Make all files of the box.

    Parameters
    ----------
    folder : Path
        Folder, made where it is not there.

    Raises
    ------
    FacegearError
        Without CalculiX, or if it fails.
    """
    if shutil.which("ccx") is None:
        raise FacegearError(
            "ccx: the program CalculiX is needed to make this casing (apt-get install calculix-ccx)"
        )
    folder.mkdir(parents=True, exist_ok=True)
    mesh_box(folder / "box.msh")
    numbers, coordinates = write_elements(folder / "box.msh", folder / "mesh.inp")
    (folder / "box.inp").write_text(DECK.format(mesh="mesh.inp"))
    run = subprocess.run(["ccx", "box"], cwd=folder, capture_output=True, text=True, check=False)
    if not (folder / "box.sti").is_file():
        raise FacegearError(f"ccx: {run.stdout[-200:]}")
    patch_nodes = patches(coordinates)
    names = np.full(numbers.size, "", dtype=object)
    for name, (mask, _) in patch_nodes.items():
        names[mask] = name
    rows = [
        f"{k},{x:.12g},{y:.12g},{z:.12g},{name}"
        for k, (x, y, z), name in zip(numbers, coordinates, names, strict=True)
    ]
    (folder / "nodes.csv").write_text("\n".join(["node,x_mm,y_mm,z_mm,patch", *rows]) + "\n")
    reduce_box(folder)


def reduce_box(folder: Path) -> None:
    """Reduce the matrices of the box, and write them with their rows and nodes as `box.npz`.

    Parameters
    ----------
    folder : Path
        Folder of `make_box`.
    """
    whole = read_casing({"stiffness": str(folder / "box.sti"), "nodes": str(folder / "nodes.csv")}, "mm_t_s")
    patch_nodes = patches(1e3 * whole.positions)
    interfaces = [
        Interface(name, tuple(whole.numbers[mask].tolist()), 1e-3 * point)
        for name, (mask, point) in patch_nodes.items()
    ]
    reduction = reduce_casing(whole, interfaces, MODES)
    per_metre = np.append(
        np.tile(np.repeat([1e3, 1.0], 3), len(interfaces)), np.ones(reduction.frequencies.size)
    )
    dofs = [(SEATS[name], direction) for name in patch_nodes for direction in range(1, 7)]
    dofs += [(0, number) for number in range(1, reduction.frequencies.size + 1)]
    np.savez_compressed(
        folder / "box.npz",
        stiffness=1e3 * reduction.stiffness / np.outer(per_metre, per_metre),
        mass=1e3 * reduction.mass / np.outer(per_metre, per_metre),
        dofs=np.array(dofs),
        nodes=np.array([(SEATS[name], *point) for name, (_, point) in patch_nodes.items()]),
    )


if __name__ == "__main__":
    make_box(Path(sys.argv[1]))
