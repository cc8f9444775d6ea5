"""One helical and one tapered pair by three programs, as `pair_peer` does for the spur pair.

The pairs are those of config/helical.yaml and config/tapered.yaml, cut out about the middle of their contact
path, at the position at which the unloaded flanks touch there.
"""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from math import pi
from pathlib import Path

import pandas as pd

import facegear
from facegear.build.tooth_pair import pair
from facegear.errors import FacegearError
from facegear.teeth.bounded_contact import contact_path
from facegear.teeth.design import Material, PairDesign
from facegear.teeth.family_contact import contact_line
from facegear.teeth.mesh_sizes import MeshSizes
from validation.contact.pair_peer import SLICE, middle, pair_peer_study

CONFIGS = {"helical": "config/helical.yaml", "tapered": "config/tapered.yaml"}
"""Configs of the pairs by kind of teeth."""
TORQUE = 500.0
"""On the whole face, N m; the part that is cut out carries the same line load."""
LEVELS = {"medium": (0.10, 0.30, 0.60), "fine": (0.06, 0.30, 0.60)}
"""Sizes of the meshes, as in `facegear.teeth.mesh_sizes.RESOLUTIONS`. Along the face they are half those of
the spur pair: the line of contact is oblique, and pressure rises by a third within 1 mm of an end."""
KRATOS_LEVELS = ("medium",)
"""Levels that Kratos solves, too: the fine one takes it minutes a pair."""


@dataclass(frozen=True)
class FamilyPair:
    """Pair cut out of a config's teeth, its materials, the torque (N m) that it carries and its position."""

    design: PairDesign
    materials: tuple[Material, Material]
    torque: float
    position: float


def family_pair(kind: str) -> FamilyPair:
    """Return the pair of a kind of teeth, cut out about the middle of its contact path.

    Parameters
    ----------
    kind : str
        Key of CONFIGS.

    Returns
    -------
    FamilyPair
        The pair.
    """
    teeth = pair(facegear.load(CONFIGS[kind], results=None).config.tooth_pair)
    whole = teeth.design
    _, y, _ = touching_place(whole)
    design = middle(whole, y)
    gear = whole.face_gear
    torque = TORQUE * SLICE * whole.module / (gear.outer_radius - gear.inner_radius)
    return FamilyPair(design, teeth.materials, torque, touching_place(design)[2])


def touching_place(design: PairDesign) -> tuple[float, float, float]:
    """Return where the pinion's flank touches at the middle of the unloaded contact path, and when.

    Parameters
    ----------
    design : PairDesign
        The pair.

    Returns
    -------
    float, float, float
        Roll angle (rad), place y along the pinion's axis (m) and position (fraction of a pitch).

    Raises
    ------
    FacegearError
        If the flanks never touch.
    """
    flank, line = design.family.pinion_flanks[0], contact_line(design.family, 1)
    if line is None:
        raise FacegearError("the flanks of the pair never touch")
    s = contact_path(design.family, line).middle
    roll, y = (s + line.pinion_lead) * flank.cosine / flank.base_radius, float(line.pinion_y(s))
    angle = roll + flank.lead * (y - design.middle) / flank.base_radius - line.pinion_slope - flank.phase
    return float(roll), y, float(angle) * design.pinion.teeth / (2 * pi) + 0.5


def family_peer_study(
    folder: Path,
    threads: int,
    levels: Mapping[str, tuple[float, float, float]] = LEVELS,
    kratos_levels: Collection[str] = KRATOS_LEVELS,
    kinds: Collection[str] = tuple(CONFIGS),
) -> pd.DataFrame:
    """Compare three programs on the pairs of several kinds of teeth.

    Parameters
    ----------
    folder : Path
        Folder of the programs' files.
    threads : int
        Number of threads.
    levels : Mapping[str, tuple[float, float, float]]
        Sizes of the meshes in modules by level, as in `facegear.teeth.mesh_sizes.RESOLUTIONS`.
    kratos_levels : collection of str
        Levels that Kratos solves, too.
    kinds : collection of str
        Keys of CONFIGS.

    Returns
    -------
    DataFrame
        One row for each kind, program and mesh.

    Raises
    ------
    FacegearError
        If a program is missing, fails, or does not come to the torque.
    """
    tables = []
    for kind in kinds:
        cut = family_pair(kind)
        sizes = {name: MeshSizes(*(cut.design.module * size for size in row)) for name, row in levels.items()}
        (folder / kind).mkdir(parents=True, exist_ok=True)
        table = pair_peer_study(
            cut.design,
            cut.materials,
            cut.torque,
            sizes,
            folder / kind,
            threads,
            position=cut.position,
            kratos_levels=kratos_levels,
        )
        table.insert(0, "teeth", kind)
        tables.append(table)
    return pd.concat(tables, ignore_index=True)
