"""CalculiX deck of the pair: an independent solver on the same mesh.

Two sectors of C3D20 elements in one deck, cut faces free, rim back clamped, the pinion's bore rigid and
rotated by a given angle about its axis; frictionless face-to-face contact of the loaded flanks and fillets.
The result is the moment at the bore.
"""

import re
import shutil
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from facegear.arrays import Array
from facegear.contact.teeth import LOADED_SIDE
from facegear.errors import FacegearError
from facegear.teeth.design import Material, PairDesign
from facegear.teeth.mesh_files import SERENDIPITY20, element_faces
from facegear.teeth.mesh_sizes import MeshSizes
from facegear.teeth.placement import to_pinion_section
from facegear.teeth.tooth_mesh import SectorMesh, gear_tooth, pinion_tooth, sector
from validation.contact.process import run_alone

PROGRAM = "ccx"
"""Name of CalculiX's executable."""
FIXED_FACES = {"pinion": ("bore",), "face_gear": ("rim_back",)}
"""Groups of faces that are held; the pinion's turn as one about its axis."""


@dataclass(frozen=True)
class CalculixRun:
    """Wall and processor time (s), memory (GB) and version of a run."""

    seconds: float
    cpu_seconds: float
    gigabytes: float
    version: str


@dataclass(frozen=True)
class PeerResult:
    """Moment about the pinion's axis (N m), free dof, and what the run took."""

    torque: float
    dof: int
    run: CalculixRun


def program() -> str | None:
    """Return the path of ccx.

    Returns
    -------
    str or None
        Path, None where it is not installed.
    """
    return shutil.which(PROGRAM)


def write_deck(
    path: Path,
    design: PairDesign,
    sizes: MeshSizes,
    materials: tuple[Material, Material],
    teeth: int,
    angles: tuple[float, float],
    turn: float,
    slave: str = "pinion",
    fixed_faces: Mapping[str, Sequence[str]] = FIXED_FACES,
    output: str = "",
) -> int:
    """Write the deck of the pair with the pinion rotated; lengths in mm, stresses in MPa.

    Parameters
    ----------
    path : Path
        Path of the deck.
    design : PairDesign
        The pair.
    sizes : MeshSizes
        Mesh sizes.
    materials : tuple[Material, Material]
        Materials of pinion and gear.
    teeth : int
        Number of teeth of both sectors, around the pairs in mesh.
    angles : tuple[float, float]
        Angles (phi1, phi2) of pinion and gear, rad.
    turn : float
        Rotation of the pinion's bore, rad.
    slave : str
        Body, pinion or face_gear, on whose flank CalculiX integrates the contact pressure.
    fixed_faces : Mapping[str, Sequence[str]]
        Groups of faces that supports hold, by body.
    output : str
        Further lines that request results.

    Returns
    -------
    int
        Number of dof.
    """
    first = -(teeth // 2)
    bodies = {
        "pinion": sector(pinion_tooth(design, sizes), teeth, first),
        "face_gear": sector(gear_tooth(design, sizes), teeth, first),
    }
    points = _place_bodies(design, bodies, angles)
    count = len(points["pinion"])
    nodes = np.concatenate([points["pinion"], points["face_gear"]])
    nodes_used = np.unique(
        np.concatenate(
            [bodies["pinion"].hexes[:, SERENDIPITY20], count + bodies["face_gear"].hexes[:, SERENDIPITY20]]
        )
    )
    reference, rotation = len(nodes) + 1, len(nodes) + 2
    with open(path, "w", encoding="ascii") as deck:
        deck.write("*NODE, NSET=ALL_NODES\n")
        np.savetxt(
            deck, np.column_stack([nodes_used + 1, 1e3 * nodes[nodes_used]]), fmt="%d, %.13e, %.13e, %.13e"
        )
        deck.write(f"{reference}, 0., 0., 0.\n{rotation}, 0., 0., 0.\n")
        start = 1
        for body, shift, material in zip(bodies, (0, count), materials, strict=True):
            mesh = bodies[body]
            labels = np.arange(start, start + len(mesh.hexes))
            deck.write(f"*ELEMENT, TYPE=C3D20, ELSET={body.upper()}\n")
            for row in np.column_stack([labels, mesh.hexes[:, SERENDIPITY20] + shift + 1]).tolist():
                deck.write(", ".join(map(str, row[:11])) + ",\n" + ", ".join(map(str, row[11:])) + "\n")
            side = LOADED_SIDE[body]
            contact_faces = [f for name in ("flank", "fillet") for f in element_faces(mesh, f"{name}_{side}")]
            per_tooth = len(mesh.hexes) // teeth
            for tooth in range(teeth):
                deck.write(f"*SURFACE, NAME={_surface(body, tooth)}, TYPE=ELEMENT\n")
                tooth_faces = [
                    (element, name) for element, name in contact_faces if element // per_tooth == tooth
                ]
                deck.writelines(f"{start + element}, {name}\n" for element, name in tooth_faces)
            faces = np.concatenate([mesh.faces(name) for name in fixed_faces[body]])
            fixed_nodes = np.intersect1d(faces + shift, nodes_used)
            deck.write(f"*NSET, NSET=H_{body.upper()}\n" + "".join(f"{node + 1},\n" for node in fixed_nodes))
            deck.write(f"*MATERIAL, NAME=M_{body.upper()}\n*ELASTIC\n")
            deck.write(f"{1e-6 * material.young_modulus:.10g}, {material.poisson_ratio:.10g}\n")
            deck.write(f"*SOLID SECTION, ELSET={body.upper()}, MATERIAL=M_{body.upper()}\n")
            start += len(mesh.hexes)
        deck.write(_step(reference, rotation, turn, teeth, slave, output))
    return 3 * len(nodes_used)


def run_deck(path: Path, threads: int, dof: int, timeout: float = 3600.0) -> PeerResult:
    """Run ccx on a deck and read the moment.

    Parameters
    ----------
    path : Path
        Path of the deck.
    threads : int
        Number of threads.
    dof : int
        Number of dof of the deck.
    timeout : float
        Time after which the run is ended, s.

    Returns
    -------
    PeerResult
        Moment and costs.

    Raises
    ------
    FacegearError
        If ccx is not installed, fails, or prints no moment.
    """
    run = run_program(path, threads, timeout)
    result = path.with_suffix(".dat")
    moments = re.findall(
        r"^\s*\d+\s+(\S+)\s+(\S+)\s+(\S+)\s*$", result.read_text() if result.exists() else "", re.M
    )
    if not moments:
        raise FacegearError(f"{PROGRAM} printed no moment for {path}: see {path.with_suffix('.log')}")
    return PeerResult(torque=1e-3 * abs(float(moments[-1][1])), dof=dof, run=run)


def run_program(path: Path, threads: int, timeout: float = 3600.0) -> CalculixRun:
    """Run ccx on a deck, its output in a log beside it.

    Parameters
    ----------
    path : Path
        Path of the deck.
    threads : int
        Number of threads.
    timeout : float
        Time after which the run is ended, s.

    Returns
    -------
    CalculixRun
        Costs and version.

    Raises
    ------
    FacegearError
        If ccx is not installed or fails.
    """
    executable = program()
    if executable is None:
        raise FacegearError(f"{PROGRAM} is not installed (Debian: apt-get install calculix-ccx)")
    environment = {
        "OMP_NUM_THREADS": str(threads),
        "CCX_NPROC_EQUATION_SOLVER": str(threads),
        "PATH": "/usr/bin:/bin",
    }
    log = path.with_suffix(".log")
    process = run_alone((executable, "-i", path.stem), path.parent, log, environment, timeout)
    if process.code != 0:
        raise FacegearError(f"{PROGRAM} failed on {path}: see {log}")
    version = re.search(r"Version ([\d.]+)", log.read_text(encoding="utf-8", errors="replace"))
    return CalculixRun(
        seconds=process.seconds,
        cpu_seconds=process.cpu_seconds,
        gigabytes=process.gigabytes,
        version=version.group(1) if version else "unknown",
    )


def _place_bodies(
    design: PairDesign, bodies: dict[str, SectorMesh], angles: tuple[float, float]
) -> dict[str, Array]:
    """Both bodies in the pinion's frame, whose y axis is the axis the bore turns about."""
    phi1, phi2 = (np.array([angle]) for angle in angles)
    section = to_pinion_section(design, phi1, phi2, np.zeros(1)).points(bodies["face_gear"].nodes)
    x, minus_z, y = section[0, 0].T
    return {"pinion": bodies["pinion"].nodes, "face_gear": np.stack([x, y, -minus_z], axis=1)}


def _surface(body: str, tooth: int) -> str:
    return f"S_{body.upper()}_{tooth}"


def _step(reference: int, rotation: int, turn: float, teeth: int, slave: str, output: str) -> str:
    """Supports, contact and the one step: the bore turned about the pinion's axis, positive towards +x.

    Each tooth is paired with its own opposite: with all flanks in one pair and the gear's as the slave
    CalculiX ends at torques of many times ours, as if it closed gaps between different teeth.
    """
    master = "face_gear" if slave == "pinion" else "pinion"
    pairs = "\n".join(
        f"*CONTACT PAIR, INTERACTION=SMOOTH, TYPE=MORTAR\n{_surface(slave, j)}, {_surface(master, j)}"
        for j in range(teeth)
    )
    return f"""*RIGID BODY, NSET=H_PINION, REF NODE={reference}, ROT NODE={rotation}
*SURFACE INTERACTION, NAME=SMOOTH
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD
{pairs}
*BOUNDARY
H_FACE_GEAR, 1, 3
{reference}, 1, 3
{rotation}, 1, 1
{rotation}, 3, 3
*STEP, INC=200
*STATIC
1., 1., 1e-3, 1.
*BOUNDARY
{rotation}, 2, 2, {-turn:.12e}
*NODE PRINT, NSET=TURNED
RF
{output}*END STEP
""".replace("*STEP", f"*NSET, NSET=TURNED\n{rotation}\n*STEP", 1)
