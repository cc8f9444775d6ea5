"""Stages of the bodies of the teeth: meshes, their condensed compliance, and files for CAD."""

from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import pandas as pd

from facegear.build.plans import mesh_sizes
from facegear.build.tooth_pair import ToothPair, contact_setup, pair
from facegear.contact.gear_flank import every_flank_to_arrays, gear_flanks
from facegear.errors import FacegearError, require_choice
from facegear.io.cad import write_step, write_stl
from facegear.number_format import count_noun
from facegear.pipeline.outcome import Outcome
from facegear.quantities import BODIES, Body
from facegear.schema.contact import Contact, Mesh
from facegear.teeth.mesh_files import write_files
from facegear.teeth.solids import solid, teeth_of, triangles
from facegear.teeth.tooth_mesh import SectorMesh, gear_tooth, pinion_tooth, sector

KINDS = ("msh", "vtu", "inp")
"""Endings of the mesh files."""


def mesh(tooth_pair: ToothPair, mesh: Mesh) -> Outcome:
    """Mesh both bodies with hexahedra, and write the meshes as files for other programs.

    Parameters
    ----------
    tooth_pair : ToothPair
        Section `tooth_pair` of the config.
    mesh : Mesh
        Section `mesh` of the config.

    Returns
    -------
    Outcome
        `<body>_<kind>` (bytes of a mesh file) for both bodies and KINDS, and table `quality`: quantity
        and value of each body, such as the scaled Jacobian and the number of elements.
    """
    content: dict[str, Any] = {}
    quality = []
    with TemporaryDirectory() as folder:
        for body, tooth in meshes(tooth_pair, mesh).items():
            files = [Path(folder, f"{body}.{kind}") for kind in KINDS]
            quality.append(write_files(tooth, *files))
            content |= {f"{body}_{kind}": file.read_bytes() for kind, file in zip(KINDS, files, strict=True)}
    table = pd.concat(quality, ignore_index=True)
    worst = table.query("quantity == 'scaled_jacobian'")["value"].min()
    elements = int(table.query("quantity == 'elements'")["value"].sum())
    summary = f"{elements} hexahedra, smallest scaled Jacobian {worst:.3f}"
    return Outcome({**content, "quality": table}, summary)


def meshes(tooth_pair: ToothPair, mesh: Mesh) -> dict[str, SectorMesh]:
    """Build the finite element meshes of both bodies, sectors with as many teeth as the config exports.

    Parameters
    ----------
    tooth_pair : ToothPair
        Section `tooth_pair` of the config.
    mesh : Mesh
        Section `mesh` of the config.

    Returns
    -------
    dict[str, SectorMesh]
        Sectors by name, `pinion` and `face_gear`; at most all teeth of a gear.
    """
    design = pair(tooth_pair).design
    sizes = mesh_sizes(mesh, design.module)
    teeth = {"pinion": pinion_tooth(design, sizes), "face_gear": gear_tooth(design, sizes)}
    return {body: sector(tooth, min(mesh.exported_teeth, tooth.teeth)) for body, tooth in teeth.items()}


def cad(body: Body, tooth_pair: ToothPair, mesh: Mesh, case: str) -> Outcome:
    """Build the exact teeth of a body as STEP and STL files, as many as mesh files hold.

    Parameters
    ----------
    body : Body
        `pinion` or `face_gear`.
    tooth_pair : ToothPair
        Section `tooth_pair` of the config.
    mesh : Mesh
        Section `mesh` of the config.
    case : str
        Name of the config, by which the STEP file's product is called.

    Returns
    -------
    Outcome
        `step` and `stl`, bytes of a file each.

    Raises
    ------
    ConfigError
        For a pair without bodies.
    """
    design = pair(tooth_pair).design
    patches = solid(design, body, min(mesh.exported_teeth, teeth_of(design, body)))
    with TemporaryDirectory() as folder:
        step, stl = Path(folder, "body.step"), Path(folder, "body.stl")
        volume = write_step(step, patches, product_name(case, body))
        write_stl(stl, triangles(patches))
        content = {"step": step.read_bytes(), "stl": stl.read_bytes()}
    return Outcome(content, f"{count_noun(len(patches), 'surface')} around {1e9 * volume:.2f} mm3")


def product_name(case: str, body: Body) -> str:
    """Return the name of a body's product in a STEP file: `paper, face gear`.

    Parameters
    ----------
    case : str
        Name of the config.
    body : Body
        `pinion` or `face_gear`.

    Returns
    -------
    str
        Name of the config and of the body.
    """
    return f"{case}, {body.replace('_', ' ')}"


def export(path: str | Path, body: str, teeth: int | None, tooth_pair: ToothPair, case: str) -> Path:
    """Write teeth of a body, or the whole gear, as STEP or STL by the ending of the path.

    Parameters
    ----------
    path : str or Path
        File to write; it ends in .step, .stp or .stl.
    body : str
        `pinion` or `face_gear`.
    teeth : int or None
        Number of teeth; None writes the whole gear.
    tooth_pair : ToothPair
        Section `tooth_pair` of the config.
    case : str
        Name of the config, by which the STEP file's product is called.

    Returns
    -------
    Path
        The path.

    Raises
    ------
    FacegearError
        For another ending, body or number of teeth.
    ConfigError
        For a pair without bodies.
    """
    path = Path(path)
    ending = require_choice(path.suffix.lower(), (".step", ".stp", ".stl"), "ending of the path")
    gear = next(name for name in BODIES if name == require_choice(body, BODIES, "body"))
    is_whole = teeth is None or (isinstance(teeth, int) and not isinstance(teeth, bool))
    if not is_whole:
        raise FacegearError(f"teeth = {teeth!r}: must be a whole number")
    design = pair(tooth_pair).design
    if teeth is not None and not 1 <= teeth <= teeth_of(design, gear):
        raise FacegearError(f"teeth = {teeth}: must be from 1 to {teeth_of(design, gear)}")
    patches = solid(design, gear, teeth)
    if ending == ".stl":
        write_stl(path, triangles(patches))
    else:
        write_step(path, patches, product_name(case, gear))
    return path


def compliance(
    body: str, tooth_pair: ToothPair, mesh: Mesh, contact: Contact, gears: Sequence[str]
) -> Outcome:
    """Compute the condensed compliance of one body's flanks by finite elements, with the gauges of its
    fillets.

    It does not depend on how a flank is loaded. All contact analyses of the pair use it. Teeth whose coast
    flank is no mirror image of the drive flank have one compliance for each.

    Parameters
    ----------
    body : str
        `pinion` or `face_gear`.
    tooth_pair : ToothPair
        Section `tooth_pair` of the config.
    mesh : Mesh
        Section `mesh` of the config.
    contact : Contact
        Section `contact` of the config.
    gears : Sequence[str]
        Face gears that flanks are needed of: `upper`, and `lower` where it is another gear.

    Returns
    -------
    Outcome
        `arrays` (see `every_flank_to_arrays` of `facegear.contact.gear_flank`): surface points, compliance
        in m/N between nodes of the flank and of neighbouring teeth, readings of gauges.

    Raises
    ------
    ConfigError
        For a sector with more teeth than the gear, and for a mesh turned inside out.
    """
    setup = contact_setup(tooth_pair, mesh, contact)
    flanks = gear_flanks(setup.pair.design, body, setup.sizes, setup.pair.material(body), setup.plan, gears)
    flank = flanks[0]
    teeth = count_noun(len(flank.compliance.neighbour_blocks), "tooth", "teeth")
    summary = f"{count_noun(len(flank.compliance.loaded_tooth), 'flank node')}, {teeth} coupled"
    return Outcome({"arrays": every_flank_to_arrays(flanks)}, summary)
