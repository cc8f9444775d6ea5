"""Exact teeth as solids, for CAD."""

from pathlib import Path
from tempfile import TemporaryDirectory

from facegear.config.mesh import Mesh
from facegear.config.tooth_pair import ToothPair, pair
from facegear.errors import FacegearError, require_choice
from facegear.geometry.bodies import BODIES, Body
from facegear.geometry.solids import solid, teeth_of, triangles
from facegear.io.cad import write_step, write_stl
from facegear.number_format import count_noun
from facegear.stages.outcome import Outcome


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
