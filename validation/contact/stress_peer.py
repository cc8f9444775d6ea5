"""Fillet stress beside CalculiX's own: the same sector, mesh and nodal forces, C3D20 elements, no contact.

Two comparisons: its displacements read by our gauges (two solutions, one way on from there), and
its own stresses at the nodes of the surface, brought there from the integration points of its elements and
averaged (two ways to a stress as well).
"""

import re
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd

from facegear.arrays import Array, Integers
from facegear.contact.bodies.surface import gauges_on
from facegear.contact.root_gauges import fillet_sides
from facegear.errors import FacegearError
from facegear.io import meshes
from facegear.strength.root_stress import down_the_fillet
from facegear.teeth.design import Material, PairDesign
from facegear.teeth.mesh_files import SERENDIPITY20
from facegear.teeth.mesh_sizes import MeshSizes, named_sizes, thin_fillet
from facegear.teeth.tooth_mesh import SectorMesh, sector
from validation.contact.calculix import run_program
from validation.contact.line_load import LoadedTooth, loaded_tooth

LEVELS = ("coarse", "medium")
"""Levels of the whole face."""
END = 2.1
"""Outer part of the face, in modules, where the gear's fillet is sharpest: small enough for finer meshes."""
END_LEVELS = {"medium": (0.10, 0.40, 0.40), "fine": (0.05, 0.27, 0.32), "finer": (0.035, 0.27, 0.32)}
"""Sizes of the outer part's meshes, as in `facegear.teeth.mesh_sizes.RESOLUTIONS`."""

TEETH = 3
"""Number of teeth of the sector, its cut faces free; the middle one is loaded."""

ENDS = 0.1
"""Part of the face at each end that is left out: an edge's stress is no element's to give."""


def stress_peer_tables(
    design: PairDesign, materials: tuple[Material, Material], folder: Path, threads: int
) -> pd.DataFrame:
    """Compare the whole face, then its outer end on finer meshes, by `stress_peer_study`.

    Parameters
    ----------
    design : PairDesign
        The pair.
    materials : tuple[Material, Material]
        Materials of pinion and gear.
    folder : Path
        Folder for CalculiX's files.
    threads : int
        Number of threads of CalculiX.

    Returns
    -------
    DataFrame
        Rows of both parts.
    """
    m = design.module
    whole = {name: thin_fillet(named_sizes(name, m), name) for name in LEVELS}
    end = {name: thin_fillet(MeshSizes(*(m * size for size in sizes))) for name, sizes in END_LEVELS.items()}
    parts = (design, whole), (outer_end(design), end)
    return pd.concat(
        [stress_peer_study(part, levels, materials, folder, threads) for part, levels in parts],
        ignore_index=True,
    )


def outer_end(design: PairDesign) -> PairDesign:
    """Return the outer end of the pair's face alone.

    Parameters
    ----------
    design : PairDesign
        The pair.

    Returns
    -------
    PairDesign
        The cut pair.
    """
    face = END * design.module
    gear = replace(design.face_gear, inner_radius=design.face_gear.outer_radius - face)
    return replace(design, face_gear=gear, pinion=replace(design.pinion, width=0.75 * face))


def stress_peer_study(
    design: PairDesign,
    levels: Mapping[str, MeshSizes],
    materials: tuple[Material, Material],
    folder: Path,
    threads: int,
) -> pd.DataFrame:
    """Compare the largest tension (MPa) below an even line load of 1 kN, one row a level and body.

    `stress_mpa` ours, `calculix_gauge_mpa` of CalculiX's displacements, `calculix_nodal_mpa` its own; ours
    against both in percent, and against the gauge's in the plane across the face where they differ most.

    Parameters
    ----------
    design : PairDesign
        The pair.
    levels : Mapping[str, MeshSizes]
        Sizes of the meshes by level.
    materials : tuple[Material, Material]
        Materials of pinion and gear.
    folder : Path
        Folder for CalculiX's files.
    threads : int
        Number of threads of CalculiX.

    Returns
    -------
    DataFrame
        One row for each level and body.

    Raises
    ------
    FacegearError
        If ccx is not installed or fails.
    """
    rows, face = [], design.face_gear.outer_radius - design.face_gear.inner_radius
    for level, sizes in levels.items():
        for body, material in zip(("pinion", "face_gear"), materials, strict=True):
            tooth = loaded_tooth(design, body, sizes, material, TEETH, on_corners=True)
            deck = folder / f"stress_{1e3 * face:.3g}_mm_{level}_{body}.inp"
            dof = write_stress_deck(deck, tooth, material)
            run = run_program(deck, threads)
            our_stress, read, nodal = along_the_face(tooth, deck.with_suffix(".frd"), material)
            rows.append(
                {
                    "face_mm": 1e3 * face,
                    "level": level,
                    "body": body,
                    "dof": dof,
                    "stress_mpa": 1e-3 * our_stress.max(),
                    "calculix_gauge_mpa": 1e-3 * read.max(),
                    "calculix_nodal_mpa": 1e-3 * nodal.max(),
                    "difference_percent": 100.0 * (our_stress.max() / read.max() - 1.0),
                    "largest_difference_percent": 100.0 * np.abs(our_stress / read - 1.0).max(),
                    "nodal_difference_percent": 100.0 * (our_stress.max() / nodal.max() - 1.0),
                    "calculix_seconds": run.seconds,
                    "calculix_memory_gb": run.gigabytes,
                    "calculix_version": run.version,
                }
            )
    return pd.DataFrame(rows)


def write_stress_deck(path: Path, tooth: LoadedTooth, material: Material) -> int:
    """Write the deck of a loaded tooth in the middle of its sector; lengths in m, stresses in Pa.

    Parameters
    ----------
    path : Path
        Path of the deck.
    tooth : LoadedTooth
        The loaded tooth.
    material : Material
        Its material.

    Returns
    -------
    int
        Number of dof.
    """
    mesh = _sector(tooth)
    fixed_group = "bore" if tooth.mesh.body == "pinion" else "rim_back"
    hexes = mesh.hexes[:, SERENDIPITY20]
    title = f"{tooth.mesh.body}: 1 N along a line of the flank"
    meshes.write_inp(path, title, mesh.nodes, hexes, {fixed_group: np.unique(mesh.faces(fixed_group))}, {})
    labels = mesh.tooth_nodes[TEETH // 2][tooth.side.nodes.ravel()] + 1
    forces = tooth.load.reshape(-1, 3)
    on = np.flatnonzero(forces.any(axis=1))
    with open(path, "a", encoding="ascii") as deck:
        deck.write(f"*MATERIAL, NAME=STEEL\n*ELASTIC\n{material.young_modulus:.10g}, ")
        deck.write(f"{material.poisson_ratio:.10g}\n*SOLID SECTION, ELSET=BODY, MATERIAL=STEEL\n")
        deck.write(f"*BOUNDARY\n{fixed_group.upper()}, 1, 3\n*STEP\n*STATIC\n*CLOAD\n")
        for node in on:
            deck.writelines(f"{labels[node]}, {axis + 1}, {forces[node, axis]:.12e}\n" for axis in range(3))
        deck.write("*NODE FILE\nU\n*EL FILE\nS\n*END STEP\n")
    return 3 * np.unique(hexes).size


def read_nodes(path: Path, name: str, parts: int) -> dict[int, Array]:
    """Read the first values by node label of a block (DISP, STRESS) of CalculiX's result file.

    Displacements x, y, z; stresses xx, yy, zz, xy, yz, zx.

    Parameters
    ----------
    path : Path
        Path of the file.
    name : str
        Name of the block.
    parts : int
        Number of values of each node.

    Returns
    -------
    dict of (parts,) array
        Values by node label, in the unit of the deck.

    Raises
    ------
    FacegearError
        If the file holds none.
    """
    block = re.search(rf"^ -4  {name} .*?^ -3", path.read_text(encoding="ascii"), re.M | re.S)
    if block is None:
        raise FacegearError(f"no {name} in {path}")
    lines = [line for line in block.group().splitlines() if line.startswith(" -1")]
    columns = [slice(13 + 12 * part, 25 + 12 * part) for part in range(parts)]
    return {int(line[3:13]): np.array([float(line[column]) for column in columns]) for line in lines}


def along_the_face(tooth: LoadedTooth, results: Path, material: Material) -> tuple[Array, Array, Array]:
    """Return the largest tension down the loaded fillet on planes across the face.

    Parameters
    ----------
    tooth : LoadedTooth
        The loaded tooth.
    results : Path
        Path of CalculiX's result file.
    material : Material
        Material of the tooth.

    Returns
    -------
    (b,) array, (b,) array, (b,) array
        Stress, Pa: ours, of CalculiX's displacements, and of its nodal stresses.
    """
    grid = tooth.mesh.surfaces[f"fillet_{fillet_sides(tooth.mesh.body)[0]}"].nodes
    labels = _sector(tooth).tooth_nodes[TEETH // 2][grid] + 1
    grid_displacement = on_grid(read_nodes(results, "DISP", 3), labels)
    displacement = np.zeros_like(tooth.mesh.nodes)
    displacement[grid] = grid_displacement
    read = gauges_on(tooth.mesh.nodes, grid, material).normal @ displacement.ravel()
    nodal = _down(read_nodes(results, "STRESS", 6), labels[:, ::2], tooth.mesh.nodes[grid[:, ::2]])
    position_grids = tooth.mesh.nodes[grid[:, ::2]], tooth.gauges.position[0]
    at, gauge_positions = (_along(tooth.mesh.body, position).mean(axis=0) for position in position_grids)
    inside = np.abs(gauge_positions - gauge_positions.mean()) < (0.5 - ENDS) * np.ptp(gauge_positions)
    stresses = tooth.stress[0], read.reshape(tooth.stress[0].shape)
    our_stress, calculix_stress = (down_the_fillet(values).max(axis=0)[inside] for values in stresses)
    return (
        our_stress,
        calculix_stress,
        np.interp(gauge_positions[inside], at, down_the_fillet(nodal).max(axis=0)),
    )


def on_grid(values: Mapping[int, Array], labels: Integers) -> Array:
    """Return the displacements of a surface, in the middle of each face by the functions of its 8 nodes.

    Parameters
    ----------
    values : Mapping[int, array]
        Displacements (3,) by node label, any unit.
    labels : (nu, nv) array of int
        Labels of the nodes.

    Returns
    -------
    (nu, nv, 3) array
        Displacements, in the same unit.
    """
    zero = np.zeros(3)
    grid = np.array([[values.get(label, zero) for label in row] for row in labels])
    sides = grid[1::2, :-1:2] + grid[1::2, 2::2] + grid[:-1:2, 1::2] + grid[2::2, 1::2]
    corners = grid[:-1:2, :-1:2] + grid[2::2, :-1:2] + grid[:-1:2, 2::2] + grid[2::2, 2::2]
    grid[1::2, 1::2] = sides / 2.0 - corners / 4.0
    return grid


def _down(stress: Mapping[int, Array], labels: Integers, points: Array) -> Array:
    """Normal stress (nu, nv) down a surface with `points` (nu, nv, 3)."""
    tensor = np.array([[stress[label] for label in row] for row in labels])
    tangent = np.gradient(points, axis=0)
    tangent /= np.linalg.norm(tangent, axis=-1)[..., None]
    x, y, z = np.moveaxis(tangent, -1, 0)
    parts = np.stack([x * x, y * y, z * z, 2 * x * y, 2 * y * z, 2 * z * x], axis=-1)
    return np.asarray(np.sum(parts * tensor, axis=-1))


def _along(body: str, points: Array) -> Array:
    return points[..., 1] if body == "pinion" else np.hypot(points[..., 0], points[..., 1])


def _sector(tooth: LoadedTooth) -> SectorMesh:
    return sector(tooth.mesh, TEETH, -(TEETH // 2))
