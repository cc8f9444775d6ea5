"""Hertz's contact by KratosMultiphysics: a mortar method of another program, held against the formula.

A cylinder on a block in plane strain, both linear hexahedra whose nodes do not meet, without friction, by the
augmented Lagrangian mortar method. Lengths in mm, forces in N. Kratos runs in an environment that uv makes.
"""

import json
import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from facegear.arrays import Array, Integers
from facegear.errors import FacegearError

VERSION = "10.4.4"
PACKAGES = (
    "KratosMultiphysics",
    "KratosStructuralMechanicsApplication",
    "KratosContactStructuralMechanicsApplication",
    "KratosLinearSolversApplication",
)
RADIUS, YOUNG, POISSON = 10.0, 210_000.0, 0.3
APPROACH = 0.026
"""By how much the far sides of both bodies come closer."""
REACH, FINE, GROWTH = 12.0, 0.4, 1.4
"""Half width and depth of a body; width on each side with even cells; growth of the cells beyond."""
SLAVE, MASTER = 2, 3
"""Layers of cells along the axis of both bodies."""
UNEVEN = 1.23
"""Cells of the block over those of the cylinder."""


def hertz_peer(folder: Path, cells: Sequence[float], threads: int) -> pd.DataFrame:
    """A row for each length of the cylinder's cells (mm): largest pressure against Hertz at Kratos' own load.

    Raises FacegearError if Kratos cannot be run or does not converge.
    """
    rows = []
    for cell in cells:
        own = folder / f"hertz_{round(1e3 * cell):03d}"
        own.mkdir(parents=True, exist_ok=True)
        nodes, held = write_hertz(own, cell)
        run = run_kratos(own, threads)
        table = np.loadtxt(own / "nodes.csv", delimiter=",")
        load = table[held, 1].sum() / thickness(cell)
        pressure, half_width = hertz(load)
        rows.append(
            {
                "cells_in_half_width": half_width / cell,
                "dof": nodes.size,
                "load_n_mm": load,
                "pressure_mpa": table[:, 2].max(),
                "hertz_mpa": pressure,
                "error_percent": 100.0 * (table[:, 2].max() / pressure - 1.0),
                "kratos_seconds": run["seconds"],
                "kratos_gigabytes": run["gigabytes"],
                "kratos_version": VERSION,
            }
        )
    return pd.DataFrame(rows)


def hertz(load: float) -> tuple[float, float]:
    """Largest pressure (N/mm2) and half width (mm) of the contact under a line load (N/mm)."""
    stiffness = YOUNG / (2.0 * (1.0 - POISSON**2))
    return np.sqrt(load * stiffness / (np.pi * RADIUS)), np.sqrt(4.0 * load * RADIUS / (np.pi * stiffness))


def thickness(cell: float) -> float:
    """Length of both bodies along the axis, mm."""
    return 6.0 * cell


def write_hertz(folder: Path, cell: float) -> tuple[Array, Integers]:
    """Write the input of a run; returns the nodes (n, 3) and which of them hold the block."""
    depth = thickness(cell)
    upper, lower = _grid(cell, 1.0, depth, SLAVE), _grid(UNEVEN * cell, -1.0, depth, MASTER)
    upper[..., 1] += upper[..., 0] ** 2 / (2.0 * RADIUS) * (1.0 - upper[..., 1] / upper[..., 1].max())
    numbers = [np.arange(upper[..., 0].size).reshape(upper.shape[:-1])]
    numbers.append(numbers[0].size + np.arange(lower[..., 0].size).reshape(lower.shape[:-1]))
    nodes = np.concatenate([upper.reshape(-1, 3), lower.reshape(-1, 3)])
    moved = np.full(nodes.shape, np.nan)
    moved[:, 2] = 0.0
    held = numbers[1][:, -1].ravel()
    moved[held, :2] = 0.0
    moved[numbers[0][:, -1].ravel(), :2] = 0.0, -APPROACH
    cubes = [_cubes(numbers[0]), _cubes(numbers[1])[:, [4, 5, 6, 7, 0, 1, 2, 3]]]
    faces = [_faces(numbers[0]), _faces(numbers[1])[:, ::-1]]
    (folder / "pair.mdpa").write_text(_mesh(nodes, cubes, faces), encoding="ascii")
    (folder / "materials.json").write_text(json.dumps(_materials()), encoding="ascii")
    (folder / "parameters.json").write_text(json.dumps(_parameters(), indent=1), encoding="ascii")
    np.savetxt(folder / "moved.csv", moved, delimiter=",", fmt="%.12e")
    return nodes, held


def run_kratos(folder: Path, threads: int) -> dict[str, float]:
    """Run Kratos on a folder, its output in a log there; `seconds` and `gigabytes` of the run.

    Raises FacegearError if uv is missing, Kratos fails or its contact does not converge.
    """
    uv = shutil.which("uv") or shutil.which("uv", path=str(Path(sys.executable).parent))
    if uv is None:
        raise FacegearError(
            "uv is not installed, which makes the environment that Kratos runs in (make tools)"
        )
    packages = [argument for name in (*PACKAGES, "numpy") for argument in ("--with", _pinned(name))]
    script = str(Path(__file__).with_name("kratos_run.py"))
    command = [
        uv,
        "run",
        "--no-project",
        "--isolated",
        "--python",
        sys.executable,
        *packages,
        "python",
        script,
    ]
    environment = f"OMP_NUM_THREADS={threads}"
    done = subprocess.run(["env", environment, *command], cwd=folder, capture_output=True, text=True)
    log = folder / "kratos.log"
    log.write_text(done.stdout + done.stderr, encoding="utf-8")
    if done.returncode != 0:
        raise FacegearError(f"Kratos failed: see {log}")
    run: dict[str, float] = json.loads((folder / "result.json").read_text(encoding="ascii"))
    if not run["converged"]:
        raise FacegearError(f"Kratos' contact did not converge: see {log}")
    return run


def _pinned(name: str) -> str:
    return f"{name}=={VERSION}" if name in PACKAGES else name


def _grid(cell: float, side: float, depth: float, layers: int) -> Array:
    """Points (along, down, axis, 3) of a block whose contact face is y = 0, above (side 1) or below it."""
    down = _graded(cell)
    along = np.concatenate([-down[:0:-1], down])
    x, y, z = np.meshgrid(along, down, np.linspace(0.0, depth, layers + 1), indexing="ij")
    return np.stack([x, side * y, z], axis=-1)


def _graded(cell: float) -> Array:
    """Distances from the first point of contact to REACH, even up to FINE."""
    ends, step = [0.0], cell
    while ends[-1] < REACH:
        step *= GROWTH if ends[-1] > FINE else 1.0
        ends.append(ends[-1] + step)
    return np.array(ends)


def _cubes(numbers: Integers) -> Integers:
    """Nodes (cells, 8) of the hexahedra of a grid."""
    ring = ((0, 0), (1, 0), (1, 1), (0, 1))
    n = tuple(size - 1 for size in numbers.shape)
    corners = [numbers[i : i + n[0], j : j + n[1], k : k + n[2]] for k in (0, 1) for i, j in ring]
    return np.stack(corners, axis=-1).reshape(-1, 8)


def _faces(numbers: Integers) -> Integers:
    """Nodes (faces, 4) of the contact face of a grid."""
    face = numbers[:, 0]
    return np.stack([face[:-1, :-1], face[1:, :-1], face[1:, 1:], face[:-1, 1:]], axis=-1).reshape(-1, 4)


def _mesh(nodes: Array, cubes: list[Integers], faces: list[Integers]) -> str:
    """The mesh in Kratos' own format; the first body's face is the slave."""
    lines = [f"Begin Properties {i}\nEnd Properties" for i in range(3)]
    points = (f"{i} {x:.15e} {y:.15e} {z:.15e}" for i, (x, y, z) in enumerate(nodes.tolist(), 1))
    lines += ["Begin Nodes", *points, "End Nodes"]
    elements = _blocks("Elements SmallDisplacementElement3D8N", cubes, (1, 2), lines)
    conditions = _blocks("Conditions SurfaceCondition3D4N", faces, (0, 0), lines)
    for body, own in enumerate(elements):
        lines += _part(f"Body_{body}", np.unique(cubes[body]) + 1, own, [])
    touching = np.unique(np.concatenate([face.ravel() for face in faces])) + 1
    lines += _part("Contact_0", touching, [], [*conditions[0], *conditions[1]])
    lines += _part("Slave_0", np.unique(faces[0]) + 1, [], conditions[0])
    return "\n".join(lines) + "\n"


def _blocks(
    kind: str, tables: list[Integers], properties: tuple[int, int], lines: list[str]
) -> list[list[int]]:
    """Append numbered tables of nodes to the lines; returns the numbers of each table."""
    start, numbers = 1, []
    for table, own in zip(tables, properties, strict=True):
        numbers.append(list(range(start, start + len(table))))
        rows = zip(numbers[-1], (table + 1).tolist(), strict=True)
        lines.append(f"Begin {kind}")
        lines += [f"{number} {own} " + " ".join(map(str, row)) for number, row in rows]
        lines.append(f"End {kind.split()[0]}")
        start += len(table)
    return numbers


def _part(name: str, nodes: Integers, elements: Sequence[int], conditions: Sequence[int]) -> list[str]:
    lines = [f"Begin SubModelPart {name}"]
    for kind, numbers in (("Nodes", nodes), ("Elements", elements), ("Conditions", conditions)):
        lines += [f"Begin SubModelPart{kind}", *map(str, numbers), f"End SubModelPart{kind}"]
    return [*lines, "End SubModelPart"]


def _materials() -> dict[str, object]:
    variables = {"YOUNG_MODULUS": YOUNG, "POISSON_RATIO": POISSON, "DENSITY": 7.85e-9}
    material = {"constitutive_law": {"name": "LinearElastic3DLaw"}, "Variables": variables, "Tables": {}}
    bodies = [("Structure.Body_0", 1), ("Structure.Body_1", 2)]
    return {
        "properties": [
            {"model_part_name": part, "properties_id": number, "Material": material}
            for part, number in bodies
        ]
    }


def _parameters() -> dict[str, object]:
    solver = {
        "model_part_name": "Structure",
        "domain_size": 3,
        "solver_type": "Static",
        "analysis_type": "non_linear",
        "model_import_settings": {"input_type": "mdpa", "input_filename": "pair"},
        "material_import_settings": {"materials_filename": "materials.json"},
        "contact_settings": {"mortar_type": "ALMContactFrictionless"},
        "time_stepping": {"time_step": 1.0},
        "clear_storage": True,
        "reform_dofs_at_each_step": True,
        "convergence_criterion": "contact_residual_criterion",
        "displacement_relative_tolerance": 1e-6,
        "displacement_absolute_tolerance": 1e-12,
        "residual_relative_tolerance": 1e-6,
        "residual_absolute_tolerance": 1e-9,
        "max_iteration": 60,
        "linear_solver_settings": {"solver_type": "LinearSolversApplication.sparse_lu"},
    }
    contact = {
        "model_part_name": "Structure",
        "contact_model_part": {"0": ["Contact_0"]},
        "assume_master_slave": {"0": ["Slave_0"]},
        "contact_type": "Frictionless",
        "search_parameters": {"search_factor": 3.5},
    }
    process = {
        "python_module": "alm_contact_process",
        "kratos_module": "KratosMultiphysics.ContactStructuralMechanicsApplication",
        "process_name": "ALMContactProcess",
        "Parameters": contact,
    }
    problem = {"problem_name": "pair", "parallel_type": "OpenMP", "start_time": 0.0, "end_time": 1.0 - 1e-9}
    return {
        "problem_data": problem | {"echo_level": 1},
        "solver_settings": solver,
        "processes": {"contact_process_list": [process]},
    }
