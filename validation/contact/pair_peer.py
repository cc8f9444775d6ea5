"""Three programs on one pair: stiffness, largest contact pressure and root stress at the same torque.

One tooth of each gear, cut out and held at the cuts, on the same nodes: our solution, CalculiX (20-node
hexahedra) and Kratos (8-node ones). The reference is ours with the strip of contact resolved.
"""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.contact.options import Element, Refinement
from facegear.errors import FacegearError
from facegear.progress import Progress
from facegear.teeth.design import Material, PairDesign
from facegear.teeth.mesh_sizes import MeshSizes
from validation.contact import calculix, kratos, pair_own
from validation.contact.pair_bodies import FIXED_FACES, PairBodies
from validation.contact.pair_own import Answer, PairRequest
from validation.contact.stress_peer import on_grid, read_nodes

POSITION = 0.34
"""Position of the pair, fraction of a pitch."""
SLICE = 2.1
"""Middle part of the face, in modules: small enough for meshes that see the strip of contact."""
LEVELS = {"medium": (0.10, 0.60, 0.60), "fine": (0.05, 0.60, 0.60)}
"""Sizes of its meshes, as in `facegear.teeth.mesh_sizes.RESOLUTIONS`."""
STRIP_REFINEMENT = Refinement(2, 1, 2, 2.0)
"""Cuts of the fine mesh's flank layer in the reference."""
PARTS = (0.3, 0.6, 0.9)
"""Steps in which Kratos takes our turn, before it looks for the torque."""
CLOSE = 2e-3
"""Largest relative error of CalculiX' torque against the one asked for, and the runs it may take."""
RUNS = 3
ERROR_COLUMNS = {
    "stiffness": "stiffness_n_per_um",
    "pressure": "pressure_mpa",
    "pinion_root": "pinion_root_mpa",
    "gear_root": "gear_root_mpa",
}
"""Columns whose errors are added, by name of the error."""

Row = dict[str, float | str]


def middle(design: PairDesign, radius: float | None = None) -> PairDesign:
    """Return the part of the pair's face about a radius alone: the same teeth, shorter.

    Parameters
    ----------
    design : PairDesign
        The pair.
    radius : float or None
        Radius of the middle, m; None for the mean radius.

    Returns
    -------
    PairDesign
        The cut pair.
    """
    face, gear = SLICE * design.module, design.face_gear
    radius = design.mean_radius if radius is None else radius
    ends = radius - face / 2, radius + face / 2
    shift = float(design.family.shift(radius))
    return replace(
        design,
        face_gear=replace(gear, inner_radius=ends[0], outer_radius=ends[1]),
        pinion=replace(design.pinion, width=0.75 * face, middle=radius, profile_shift=shift),
    )


def pair_peer_study(
    design: PairDesign,
    materials: tuple[Material, Material],
    torque: float,
    levels: Mapping[str, MeshSizes],
    folder: Path,
    threads: int,
    position: float = POSITION,
    kratos_levels: Collection[str] | None = None,
) -> pd.DataFrame:
    """Compare three programs, a row for each program and mesh from the coarsest to the finest.

    Stiffness on the line of action, largest pressure on the pinion's flank in the middle of the contact line,
    largest tension at the fillets, each with its distance in percent from the first row, ours on the last
    mesh with the strip resolved.

    Parameters
    ----------
    design : PairDesign
        The pair.
    materials : tuple[Material, Material]
        Materials of pinion and gear.
    torque : float
        Torque on the pinion, N m.
    levels : Mapping[str, MeshSizes]
        Sizes of the meshes by level.
    folder : Path
        Folder of the programs' files.
    threads : int
        Number of threads.
    position : float
        Position of the pair, fraction of a pitch.
    kratos_levels : collection of str or None
        Levels that Kratos solves, too; None for all.

    Returns
    -------
    DataFrame
        One row for each program and mesh.

    Raises
    ------
    FacegearError
        If a program is missing, fails, or does not come to the torque.
    """
    pairs = {level: PairBodies(design, sizes, materials, position) for level, sizes in levels.items()}
    kratos_levels = levels if kratos_levels is None else kratos_levels
    progress = Progress("pair by three programs", 1 + 3 * len(levels) + len(kratos_levels))
    rows = []
    for row in _rows(pairs, torque, kratos_levels, folder, threads):
        rows.append(row)
        progress.step()
    table = pd.DataFrame(rows)
    for name, column in ERROR_COLUMNS.items():
        table[f"{name}_error_percent"] = 100.0 * (table[column] / table[column].iloc[0] - 1.0)
    return table


def posed_peer_study(
    design: PairDesign,
    materials: tuple[Material, Material],
    torque: float,
    offsets: Sequence[float],
    radius: float,
    sizes: MeshSizes,
    folder: Path,
) -> pd.DataFrame:
    """Compare ours, CalculiX and Kratos on a pair whose bodies stand displaced.

    Ours a second time on the 8-node elements that Kratos has.

    Parameters
    ----------
    design : PairDesign
        The pair.
    materials : tuple[Material, Material]
        Materials of pinion and gear.
    torque : float
        Torque on the pinion, N m.
    offsets : Sequence[float]
        Offsets of the axes, m.
    radius : float
        Radius about which a part of the face is cut out, m.
    sizes : MeshSizes
        Mesh sizes.
    folder : Path
        Folder of the programs' files.

    Returns
    -------
    DataFrame
        One row for each program and offset.

    Raises
    ------
    FacegearError
        If a program is missing, fails, or does not come to the torque.
    """
    rows = []
    for number, offset in enumerate(offsets):
        posed_design = replace(middle(design, radius), assembly=replace(design.assembly, offset=offset))
        pair = PairBodies(posed_design, sizes, materials, POSITION)
        level = f"posed_{number}"
        row, our_answer = _solve_ours(pair, level, "facegear", torque, Refinement(), folder, 1)
        linear, _ = _solve_ours(pair, level, "facegear, 8-node", torque, Refinement(), folder, 1)
        peers = (
            _calculix(pair, level, our_answer, folder, 1),
            _kratos(pair, level, our_answer, folder / f"kratos_{number}", 1),
        )
        rows += [{"offset_um": 1e6 * offset, **row} for row in (row, linear, *peers)]
    return pd.DataFrame(rows)


def _rows(
    pairs: Mapping[str, PairBodies],
    torque: float,
    kratos_levels: Collection[str],
    folder: Path,
    threads: int,
) -> Iterator[Row]:
    finest = list(pairs)[-1]
    plain = Refinement()
    yield _solve_ours(
        pairs[finest], finest, "facegear, strip resolved", torque, STRIP_REFINEMENT, folder, threads
    )[0]
    for level, pair in pairs.items():
        row, our_answer = _solve_ours(pair, level, "facegear", torque, plain, folder, threads)
        yield row
        yield _solve_ours(pair, level, "facegear, 8-node", torque, plain, folder, threads)[0]
        yield _calculix(pair, level, our_answer, folder, threads)
        if level in kratos_levels:
            yield _kratos(pair, level, our_answer, folder / f"kratos_{level}", threads)


def _solve_ours(
    pair: PairBodies,
    level: str,
    program: str,
    torque: float,
    cuts: Refinement,
    folder: Path,
    threads: int,
) -> tuple[Row, Answer]:
    element: Element = "hex8" if "8-node" in program else "hex27"
    answer, process = pair_own.solve(
        folder / f"own_{level}_{program.split()[-1]}", PairRequest(pair, torque, cuts, element), threads
    )
    dof = 3 * sum(len(tooth.nodes) for tooth in pair.teeth.values())
    return _row(pair, level, program, dof, answer, process.cpu_seconds, process.gigabytes), answer


def _calculix(pair: PairBodies, level: str, our_answer: Answer, folder: Path, threads: int) -> Row:
    """Return the last of the runs until the torque is met: it grows as a power of the turn."""
    deck, turn = folder / f"pair_{level}.inp", our_answer.turn
    for _ in range(RUNS):
        dof = calculix.write_deck(
            deck,
            pair.design,
            pair.sizes,
            pair.materials,
            1,
            pair.angles,
            turn,
            fixed_faces=FIXED_FACES,
            output="*NODE FILE\nU\n*CONTACT FILE\nCDIS, CSTR\n",
        )
        result = calculix.run_deck(deck, threads, dof)
        if abs(result.torque / our_answer.torque - 1.0) < CLOSE:
            break
        turn *= (our_answer.torque / result.torque) ** (1.0 / our_answer.exponent)
    else:
        raise FacegearError(f"CalculiX did not come to {our_answer.torque:g} N m: see {deck}")
    run, answers = result.run, deck.with_suffix(".frd")
    displacement = 1e-3 * _calculix_displacement(pair, answers)
    pressure = np.full(len(pair.teeth["pinion"].nodes), np.nan)
    for label, (*_, value) in read_nodes(answers, "CONTACT", 4).items():
        if label <= len(pressure):
            pressure[label - 1] = 1e6 * value
    answer = _read(pair, result.torque, turn, displacement, pressure)
    return _row(pair, level, f"CalculiX {run.version}", dof, answer, run.cpu_seconds, run.gigabytes)


def _calculix_displacement(pair: PairBodies, results: Path) -> Array:
    """Displacements (n, 3), mm, of all nodes of both bodies that its elements or their faces have."""
    values = read_nodes(results, "DISP", 3)
    count = sum(len(tooth.nodes) for tooth in pair.teeth.values())
    displacement, shift = np.zeros((count, 3)), 0
    for tooth in pair.teeth.values():
        for surface in tooth.surfaces.values():
            displacement[shift + surface.nodes] = on_grid(values, shift + surface.nodes + 1)
        shift += len(tooth.nodes)
    return displacement


def _kratos(pair: PairBodies, level: str, our_answer: Answer, folder: Path, threads: int) -> Row:
    bodies = pair.linear(our_answer.turn)
    run = kratos.solve(folder, bodies, PARTS, threads, work=1e3 * our_answer.torque * our_answer.turn)
    work = float(np.nansum(bodies.support_displacement * run.reaction))
    answer = _read(
        pair,
        1e-3 * work / our_answer.turn,
        run.part * our_answer.turn,
        1e-3 * run.displacement,
        1e6 * run.pressure,
    )
    dof = 3 * len(run.displacement)
    return _row(pair, level, f"Kratos {kratos.VERSION}", dof, answer, run.cpu_seconds, run.gigabytes)


def _read(pair: PairBodies, torque: float, turn: float, displacement: Array, pressure: Array) -> Answer:
    """Read the answer from displacements (n, 3) m and pressures (n,) Pa, nan where there are none, of all
    nodes of both bodies."""
    count = len(pair.teeth["pinion"].nodes)
    return Answer(
        torque=torque,
        turn=turn,
        pressure=pair.largest_pressure(pressure),
        pinion_root=pair.root_stress("pinion", displacement[:count]),
        gear_root=pair.root_stress("face_gear", displacement[count:]),
        path=pair.path(np.nan_to_num(pressure[:count])),
    )


def _row(
    pair: PairBodies, level: str, program: str, dof: int, answer: Answer, seconds: float, gigabytes: float
) -> Row:
    arm = pair.design.normal_arm
    return {
        "level": level,
        "program": program,
        "dof": dof,
        "torque_n_m": answer.torque,
        "turn_rad": answer.turn,
        "stiffness_n_per_um": 1e-6 * answer.torque / (arm**2 * answer.turn),
        "pressure_mpa": 1e-6 * answer.pressure,
        "pinion_root_mpa": 1e-6 * answer.pinion_root,
        "gear_root_mpa": 1e-6 * answer.gear_root,
        "path_mm": 1e3 * answer.path,
        "cpu_seconds": seconds,
        "memory_gb": gigabytes,
    }
