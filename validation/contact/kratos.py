"""KratosMultiphysics: two bodies of linear hexahedra pressed together by its mortar method.

Without friction, by augmented Lagrangian multipliers. Kratos condenses them, so that its algebraic multigrid
solves for displacements alone. Lengths in mm, forces in N. Kratos runs in an environment that uv makes.
"""

import json
import os
import shutil
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from facegear.arrays import Array, Integers
from facegear.errors import FacegearError
from facegear.teeth.design import Material
from validation.contact.process import run_alone

VERSION = "10.4.4"
"""Version of Kratos."""
PACKAGES = (
    "KratosMultiphysics",
    "KratosStructuralMechanicsApplication",
    "KratosContactStructuralMechanicsApplication",
    "KratosLinearSolversApplication",
)
"""Packages of the environment that uv makes."""


@dataclass(frozen=True, eq=False)
class TwoBodies:
    """Two bodies that may touch.

    Attributes
    ----------
    nodes : (n, 3)
        Nodes of both, mm.
    cubes : (c, 8) each
        Nodes of their hexahedra.
    faces : (f, 4) each
        Nodes of the faces that may touch, normals outward; the first body's are the slave's.
    support_displacement : (n, 3)
        Displacements (mm) of the nodes that supports hold, nan where a node is free.
    materials
        Materials of the two.
    """

    nodes: Array
    cubes: tuple[Integers, Integers]
    faces: tuple[Integers, Integers]
    support_displacement: Array
    materials: tuple[Material, Material]


@dataclass(frozen=True, eq=False)
class KratosRun:
    """Solution of a run, nodes in the order of the input, and what it took.

    `displacement` (n, 3) mm and `reaction` (n, 3) N; `pressure` (n,) N/mm2 of the slave's nodes; `part` of
    the displacements that were asked for; wall and processor time (s), memory (GB).
    """

    displacement: Array
    reaction: Array
    pressure: Array
    part: float
    seconds: float
    cpu_seconds: float
    gigabytes: float


def solve(
    folder: Path,
    bodies: TwoBodies,
    parts: Sequence[float],
    threads: int,
    work: float | None = None,
    timeout: float = 3600.0,
) -> KratosRun:
    """Solve in steps of the displacements; input, log and results stay in the folder.

    Parameters
    ----------
    folder : Path
        Folder of the run.
    bodies : TwoBodies
        Both bodies.
    parts : Sequence[float]
        Parts of the displacements, fractions, one after the other.
    threads : int
        Number of threads.
    work : float or None
        Work of the support's last reactions on the whole displacements, N mm: further steps follow until it
        is met within `kratos_run.CLOSE`. None for no further steps.
    timeout : float
        Time after which the run is ended, s.

    Returns
    -------
    KratosRun
        The solution.

    Raises
    ------
    FacegearError
        If uv is missing, Kratos fails or its contact does not converge.
    """
    write(folder, bodies, parts, work)
    log = folder / "kratos.log"
    environment = os.environ | {"OMP_NUM_THREADS": str(threads)}
    if run_alone(_command(), folder, log, environment, timeout).code != 0:
        raise FacegearError(f"Kratos failed: see {log}")
    run = json.loads((folder / "result.json").read_text(encoding="ascii"))
    if not run.pop("converged"):
        raise FacegearError(f"Kratos' contact did not converge: see {log}")
    table = np.loadtxt(folder / "nodes.csv", delimiter=",")
    return KratosRun(displacement=table[:, :3], reaction=table[:, 3:6], pressure=table[:, 6], **run)


def write(folder: Path, bodies: TwoBodies, parts: Sequence[float], work: float | None) -> None:
    """Write the input of a run into a folder.

    Parameters
    ----------
    folder : Path
        Folder of the run.
    bodies : TwoBodies
        Both bodies.
    parts : Sequence[float]
        Parts of the displacements, fractions.
    work : float or None
        Work to be met, N mm, or None.
    """
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "pair.mdpa").write_text(_mesh(bodies.nodes, bodies.cubes, bodies.faces), encoding="ascii")
    (folder / "materials.json").write_text(json.dumps(_materials(bodies.materials)), encoding="ascii")
    (folder / "parameters.json").write_text(json.dumps(_parameters(), indent=1), encoding="ascii")
    (folder / "steps.json").write_text(json.dumps({"parts": list(parts), "work": work}), encoding="ascii")
    np.savetxt(folder / "moved.csv", bodies.support_displacement, delimiter=",", fmt="%.12e")


def _command() -> list[str]:
    uv = shutil.which("uv") or shutil.which("uv", path=str(Path(sys.executable).parent))
    if uv is None:
        raise FacegearError(
            "uv is not installed, which makes the environment that Kratos runs in (make tools)"
        )
    packages = [argument for name in (*PACKAGES, "numpy") for argument in ("--with", _requirement(name))]
    options = "run", "--no-project", "--isolated", "--python", sys.executable
    return [uv, *options, *packages, "python", str(Path(__file__).with_name("kratos_run.py"))]


def _requirement(name: str) -> str:
    return f"{name}=={VERSION}" if name in PACKAGES else name


def _mesh(nodes: Array, cubes: Sequence[Integers], faces: Sequence[Integers]) -> str:
    """The mesh in Kratos' own format; the first body's face is the slave."""
    lines = [f"Begin Properties {i}\nEnd Properties" for i in range(3)]
    points = (f"{i} {x:.15e} {y:.15e} {z:.15e}" for i, (x, y, z) in enumerate(nodes.tolist(), 1))
    lines += ["Begin Nodes", *points, "End Nodes"]
    elements = _blocks("Elements SmallDisplacementElement3D8N", cubes, (1, 2), lines)
    conditions = _blocks("Conditions SurfaceCondition3D4N", faces, (0, 0), lines)
    for body, body_elements in enumerate(elements):
        lines += _part(f"Body_{body}", np.unique(cubes[body]) + 1, body_elements, [])
    contact_nodes = np.unique(np.concatenate([face.ravel() for face in faces])) + 1
    lines += _part("Contact_0", contact_nodes, [], [*conditions[0], *conditions[1]])
    lines += _part("Slave_0", np.unique(faces[0]) + 1, [], conditions[0])
    return "\n".join(lines) + "\n"


def _blocks(
    kind: str, tables: Sequence[Integers], properties: tuple[int, int], lines: list[str]
) -> list[list[int]]:
    """Append numbered tables of nodes to the lines; returns the numbers of each table."""
    start, numbers = 1, []
    for table, property_number in zip(tables, properties, strict=True):
        numbers.append(list(range(start, start + len(table))))
        rows = zip(numbers[-1], (table + 1).tolist(), strict=True)
        lines.append(f"Begin {kind}")
        lines += [f"{number} {property_number} " + " ".join(map(str, row)) for number, row in rows]
        lines.append(f"End {kind.split()[0]}")
        start += len(table)
    return numbers


def _part(name: str, nodes: Integers, elements: Sequence[int], conditions: Sequence[int]) -> list[str]:
    lines = [f"Begin SubModelPart {name}"]
    for kind, numbers in (("Nodes", nodes), ("Elements", elements), ("Conditions", conditions)):
        lines += [f"Begin SubModelPart{kind}", *map(str, numbers), f"End SubModelPart{kind}"]
    return [*lines, "End SubModelPart"]


def _materials(materials: tuple[Material, Material]) -> dict[str, object]:
    return {
        "properties": [
            {
                "model_part_name": f"Structure.Body_{body}",
                "properties_id": body + 1,
                "Material": {
                    "constitutive_law": {"name": "LinearElastic3DLaw"},
                    "Variables": {
                        "YOUNG_MODULUS": 1e-6 * material.young_modulus,
                        "POISSON_RATIO": material.poisson_ratio,
                        "DENSITY": 7.85e-9,
                    },
                    "Tables": {},
                },
            }
            for body, material in enumerate(materials)
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
        "contact_settings": {"mortar_type": "ALMContactFrictionlessComponents"},
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
        "contact_type": "FrictionlessComponents",
        "search_parameters": {"search_factor": 3.5},
    }
    process = {
        "python_module": "alm_contact_process",
        "kratos_module": "KratosMultiphysics.ContactStructuralMechanicsApplication",
        "process_name": "ALMContactProcess",
        "Parameters": contact,
    }
    problem = {"problem_name": "pair", "parallel_type": "OpenMP", "start_time": 0.0, "end_time": 1.0}
    return {
        "problem_data": problem | {"echo_level": 1},
        "solver_settings": solver,
        "processes": {"contact_process_list": [process]},
    }
