"""Natural frequencies of a gear body by CalculiX, from bricks of 20 nodes with the bore held.

The bricks are the section revolved about the axis. The section is that of docs/explanation/bodies.md without
teeth: a hub, a conical web of 18 to 12 mm and a ring. CalculiX does not use waves: it solves the whole body
in space, and finds every mode with nodal diameters twice.
"""

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from facegear.arrays import Array, Integers
from facegear.errors import FacegearError
from facegear.parts.body_mesh import BodyMesh, body_mesh
from facegear.parts.gear_body import solve_body
from facegear.parts.section import Section
from facegear.parts.wheel import Hub, Rim, Web, wheel
from facegear.teeth.design import Material
from validation.contact.calculix import run_program

STEEL, DENSITY = Material(206e9, 0.3), 7850.0
TEETH, MAX_FREQUENCY, LAST_ORDER = 143, 3000.0, 6
FREQUENCY_COUNT = 6
"""Number of different frequencies that are compared, in ascending order."""
MESHES = ((1, 2.0, 24), (2, 2.0, 36))
"""Elements across the thinnest wall, how many times smaller at corners, and elements round the axis."""


@dataclass(frozen=True, eq=False)
class Bricks:
    """Points (n, 3) in m, bricks (e, 20) in CalculiX's order, and indices of the points that are held."""

    points: Array
    bricks: Integers
    fixed_points: Integers


def section() -> Section:
    """Return the section: hub r 120..140, web, ring r 250..275 mm.

    Returns
    -------
    Section
        The section in m.
    """
    web = Web(0.018, 0.012, -0.006, 25 / 110)
    corners = wheel(Hub(0.12, 0.14, -0.05, 0.0), web, Rim(0.25, 0.275, -0.012, 0.012))
    bore = np.isclose(corners[:, 0], 0.12)
    is_fixed = bore & np.roll(bore, -1)
    return Section(corners, tuple(is_fixed.tolist()), (0.25, 0.275), STEEL, DENSITY)


def revolve(mesh: BodyMesh, around: int) -> Bricks:
    """Revolve the quadrilaterals of a section about the axis; edges bend with the circle.

    Parameters
    ----------
    mesh : BodyMesh
        Mesh of the section.
    around : int
        Number of elements round the axis.

    Returns
    -------
    Bricks
        Bricks of the whole body.
    """
    quads = mesh.quads
    ends = np.stack([quads, np.roll(quads, -1, axis=1)], axis=2).reshape(-1, 2)
    edges, number = np.unique(np.sort(ends, axis=1), axis=0, return_inverse=True)
    middles = 0.5 * (mesh.nodes[edges[:, 0]] + mesh.nodes[edges[:, 1]])
    flat, corners = np.concatenate([mesh.nodes, middles]), len(mesh.nodes)
    per_step = len(flat) + corners
    angle = -2.0 * np.pi / around * np.arange(2 * around) / 2.0  # backwards: bricks then have their volume
    points = np.concatenate(
        [_rotate(flat if step % 2 == 0 else flat[:corners], angle[step]) for step in range(2 * around)]
    )
    on_edges = len(mesh.nodes) + number.reshape(quads.shape)
    bricks = []
    for step in range(around):
        first, last = step * per_step, (step + 1) % around * per_step
        between = first + len(flat)
        parts = (quads + first, quads + last, on_edges + first, on_edges + last, quads + between)
        bricks.append(np.concatenate(parts, axis=1))
    fixed_points = np.flatnonzero(np.hypot(points[:, 0], points[:, 1]) < mesh.nodes[:, 0].min() + 1e-9)
    return Bricks(points, np.concatenate(bricks), fixed_points)


def _rotate(flat: Array, angle: float) -> Array:
    r, height = flat.T
    return np.stack([r * np.cos(angle), r * np.sin(angle), height], axis=1)


def write_deck(path: Path, bricks: Bricks, modes: int) -> None:
    """Write the deck of the first modes, in mm, MPa and t.

    Parameters
    ----------
    path : Path
        Path of the deck.
    bricks : Bricks
        Bricks of the body.
    modes : int
        Number of modes.
    """
    with open(path, "w", encoding="ascii") as deck:
        deck.write("*NODE, NSET=ALL_NODES\n")
        numbers = np.arange(1, len(bricks.points) + 1)
        np.savetxt(deck, np.column_stack([numbers, 1e3 * bricks.points]), fmt="%d, %.13e, %.13e, %.13e")
        deck.write("*ELEMENT, TYPE=C3D20R, ELSET=BODY\n")
        for label, row in enumerate((bricks.bricks + 1).tolist(), 1):
            whole = [label, *row]
            deck.write(", ".join(map(str, whole[:11])) + ",\n" + ", ".join(map(str, whole[11:])) + "\n")
        deck.write("*NSET, NSET=BORE\n" + "".join(f"{node + 1},\n" for node in bricks.fixed_points))
        deck.write("*MATERIAL, NAME=STEEL\n*ELASTIC\n")
        deck.write(f"{1e-6 * STEEL.young_modulus:.10g}, {STEEL.poisson_ratio:.10g}\n")
        deck.write(f"*DENSITY\n{1e-12 * DENSITY:.10g}\n")
        deck.write("*SOLID SECTION, ELSET=BODY, MATERIAL=STEEL\n*BOUNDARY\nBORE, 1, 3\n")
        deck.write(f"*STEP\n*FREQUENCY\n{modes}\n*END STEP\n")


def frequencies_of(text: str) -> Array:
    """Read the frequencies from the text of CalculiX's .dat file.

    Parameters
    ----------
    text : str
        Content of the file.

    Returns
    -------
    (modes,) array
        Frequencies, Hz.

    Raises
    ------
    FacegearError
        If there are none.
    """
    part = text.partition("E I G E N V A L U E   O U T P U T")[2].partition("P A R T I C I P A T I O N")[0]
    rows = re.findall(r"^\s*\d+\s+\S+\s+\S+\s+(\S+)\s+\S+\s*$", part, re.MULTILINE)
    if not rows:
        raise FacegearError("CalculiX wrote no frequencies")
    return np.array([float(value) for value in rows])


def peer_table(folder: Path, threads: int) -> pd.DataFrame:
    """Compare the frequencies for each mesh and nodal diameter: ours, CalculiX's (both of a pair) and the
    difference in %.

    Parameters
    ----------
    folder : Path
        Folder for CalculiX's files.
    threads : int
        Number of threads of CalculiX.

    Returns
    -------
    DataFrame
        One row for each mesh and nodal diameter.

    Raises
    ------
    FacegearError
        If ccx is not installed or fails.
    """
    shape = section()
    solution = solve_body(shape, MAX_FREQUENCY, LAST_ORDER, TEETH)
    our_frequencies = sorted((float(f), modes.order) for modes in solution.orders for f in modes.frequencies)[
        :FREQUENCY_COUNT
    ]
    our_modes = [f for f, order in our_frequencies for _ in range(2 if order else 1)]
    rows = []
    for across, finer, around in MESHES:
        bricks = revolve(body_mesh(shape, across, finer), around)
        deck = folder / f"body_{around}.inp"
        write_deck(deck, bricks, len(our_modes) + 2)
        run = run_program(deck, threads)
        calculix_frequencies = frequencies_of(deck.with_suffix(".dat").read_text(encoding="ascii"))
        start = 0
        for frequency, order in our_frequencies:
            pair = calculix_frequencies[start : start + (2 if order else 1)]
            start += pair.size
            rows.append(
                {
                    "elements": len(bricks.bricks),
                    "around": around,
                    "nodal_diameters": order,
                    "ours_hz": frequency,
                    "calculix_hz": pair.mean(),
                    "pair_hz": np.ptp(pair),
                    "difference_percent": 100.0 * (pair.mean() / frequency - 1.0),
                    "cpu_seconds": run.cpu_seconds,
                    "calculix_version": run.version,
                }
            )
    return pd.DataFrame(rows)
