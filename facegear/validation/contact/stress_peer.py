"""Fillet stress beside CalculiX's own: the same sector, mesh and nodal forces, C3D20 elements, no contact.

CalculiX brings the stresses at the integration points of its elements to their nodes and averages there; ours
come from strain gauges on the surface. So two paths from the mesh to a stress are compared, not only two
solutions of one system.
"""

import re
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from facegear.contact.root_gauges import fillet_sides
from facegear.errors import FacegearError
from facegear.geometry.design import Material, PairDesign
from facegear.io import abaqus
from facegear.mesh.orderings import SERENDIPITY20
from facegear.mesh.sector import SectorMesh, sector
from facegear.mesh.sizes import MeshSizes
from facegear.strength.root_stress import down_the_fillet
from facegear.validation.contact.calculix import run_program
from facegear.validation.contact.line_load import LoadedTooth, loaded_tooth

Array = NDArray[np.float64]

TEETH = 3
"""Of the sector, its cut faces free; the middle one is loaded."""

ENDS = 0.1
"""Part of the face at each end that is left out: an edge's stress is no element's to give."""


def stress_peer_study(
    design: PairDesign,
    levels: Mapping[str, MeshSizes],
    materials: tuple[Material, Material],
    folder: Path,
    threads: int,
) -> pd.DataFrame:
    """One row a level and body: largest tension (MPa) below an even line load of 1 kN by gauges and CalculiX.

    `difference_percent` of the two, `largest_difference_percent` the largest of all planes across the face.
    Raises FacegearError if ccx is not installed or fails.
    """
    rows = []
    for level, sizes in levels.items():
        for body, material in zip(("pinion", "face_gear"), materials, strict=True):
            tooth = loaded_tooth(design, body, sizes, material, TEETH, on_corners=True)
            deck = folder / f"stress_{level}_{body}.inp"
            dof = write_stress_deck(deck, tooth, material)
            run = run_program(deck, threads)
            ours, theirs = along_the_face(tooth, read_stress(deck.with_suffix(".frd")))
            rows.append(
                {
                    "level": level,
                    "body": body,
                    "dof": dof,
                    "stress_mpa": 1e-3 * ours.max(),
                    "calculix_stress_mpa": 1e-3 * theirs.max(),
                    "difference_percent": 100.0 * (ours.max() / theirs.max() - 1.0),
                    "largest_difference_percent": 100.0 * np.abs(ours / theirs - 1.0).max(),
                    "calculix_seconds": run.seconds,
                    "calculix_memory_gb": run.gigabytes,
                    "calculix_version": run.version,
                }
            )
    return pd.DataFrame(rows)


def write_stress_deck(path: Path, tooth: LoadedTooth, material: Material) -> int:
    """Write the deck of a loaded tooth in the middle of its sector; returns its dof.

    Lengths are in m, stresses in Pa.
    """
    mesh = _sector(tooth)
    held = "bore" if tooth.mesh.body == "pinion" else "rim_back"
    hexes = mesh.hexes[:, SERENDIPITY20]
    title = f"{tooth.mesh.body}: 1 N along a line of the flank"
    abaqus.write(path, title, mesh.nodes, hexes, {held: np.unique(mesh.faces(held))}, {})
    labels = mesh.tooth_nodes[TEETH // 2][tooth.side.nodes.ravel()] + 1
    forces = tooth.load.reshape(-1, 3)
    on = np.flatnonzero(forces.any(axis=1))
    with open(path, "a", encoding="ascii") as deck:
        deck.write(f"*MATERIAL, NAME=STEEL\n*ELASTIC\n{material.young_modulus:.10g}, ")
        deck.write(f"{material.poisson_ratio:.10g}\n*SOLID SECTION, ELSET=BODY, MATERIAL=STEEL\n")
        deck.write(f"*BOUNDARY\n{held.upper()}, 1, 3\n*STEP\n*STATIC\n*CLOAD\n")
        for node in on:
            deck.writelines(f"{labels[node]}, {axis + 1}, {forces[node, axis]:.12e}\n" for axis in range(3))
        deck.write("*EL FILE\nS\n*END STEP\n")
    return 3 * np.unique(hexes).size


def read_stress(path: Path) -> dict[int, Array]:
    """Stress xx, yy, zz, xy, yz, zx (6,) Pa by node label from CalculiX's result file.

    Raises FacegearError where it holds none.
    """
    block = re.search(r"^ -4  STRESS.*?^ -3", path.read_text(encoding="ascii"), re.M | re.S)
    if block is None:
        raise FacegearError(f"no stress in {path}")
    lines = [line for line in block.group().splitlines() if line.startswith(" -1")]
    return {
        int(line[3:13]): np.array([float(line[13 + 12 * part : 25 + 12 * part]) for part in range(6)])
        for line in lines
    }


def along_the_face(tooth: LoadedTooth, stress: Mapping[int, Array]) -> tuple[Array, Array]:
    """Largest tension (Pa) down the loaded fillet on the planes of CalculiX's nodes (b,): ours, its own."""
    sides = fillet_sides(tooth.mesh.body)
    grid = tooth.mesh.surfaces[f"fillet_{sides[0]}"].nodes[:, ::2]
    points = tooth.mesh.nodes[grid]
    labels = _sector(tooth).tooth_nodes[TEETH // 2][grid] + 1
    tensor = np.array([stress[label] for label in labels.ravel()]).reshape(*labels.shape, 6)
    tangent = np.gradient(points, axis=0)
    tangent /= np.linalg.norm(tangent, axis=-1)[..., None]
    x, y, z = np.moveaxis(tangent, -1, 0)
    parts = np.stack([x * x, y * y, z * z, 2 * x * y, 2 * y * z, 2 * z * x], axis=-1)
    theirs = down_the_fillet(np.sum(parts * tensor, axis=-1)).max(axis=0)
    at, own = (_along(tooth.mesh.body, places).mean(axis=0) for places in (points, tooth.gauges.position[0]))
    ours = np.interp(at, own, down_the_fillet(tooth.stress[0]).max(axis=0))
    inside = np.abs(at - at.mean()) < (0.5 - ENDS) * np.ptp(at)
    return ours[inside], theirs[inside]


def _along(body: str, points: Array) -> Array:
    return points[..., 1] if body == "pinion" else np.hypot(points[..., 0], points[..., 1])


def _sector(tooth: LoadedTooth) -> SectorMesh:
    return sector(tooth.mesh, TEETH, -(TEETH // 2))
