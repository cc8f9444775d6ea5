"""Error of the meshes of loaded contact by kind of teeth: `python -m validation.contact.family_convergence`.

A spur, a helical, a tapered and an offset pair are loaded on the `medium` mesh, and on meshes finer in one
direction at a time and in all of them. Faces are some two modules wide: on a whole face of 28 mm the mesh
that is finer in every direction takes more than 4 GB, most of it for the dense stiffness of the cut faces.
"""

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np
import pandas as pd

from facegear.build.tooth_pair import ContactSetup, contact_setup
from facegear.contact.gear_flank import BUILDERS, GearFlank, contact_model, gear_flank
from facegear.contact.ltca import even_positions, loaded_contact
from facegear.contact.options import Refinement
from facegear.contact.pressure import flank_pressure
from facegear.gearbox import load
from facegear.progress import Progress
from facegear.teeth.mesh_sizes import RESOLUTIONS, MeshSizes

TABLE = Path(__file__).parents[2] / "docs" / "measured" / "family_convergence.csv"
LINE_LOAD = 18.0
"""Torque on the pinion over the width of its face, N m/mm: 500 N m on 28 mm."""
LIMITS = {"stiffness": 0.3, "pressure": 2.0}
"""Largest change of the mean stiffness and of the largest pressure by a finer mesh, percent."""


def _section(
    teeth: tuple[int, int, int],
    face: tuple[float, float, float, float],
    module: float,
    gear_addendum: float,
    rounding: float,
    **kind: float,
) -> dict[str, Any]:
    """Return section `tooth_pair`.

    Arguments are teeth of pinion, gear and shaper; middle and width of the pinion's face and radii of the
    gear's, mm; module, mm; addendum of the gear and rounding of the shaper in modules.
    """
    middle, width, inner, outer = face
    helix = kind.get("helix_angle_deg", 0.0)
    pitch_radius = module * teeth[0] / np.cos(np.radians(helix)) / 2
    return {
        "pinion_teeth": teeth[0],
        "face_gear_teeth": teeth[1],
        "module_mm": module,
        "pressure_angle_deg": 25.0,
        **kind,
        "pinion": {
            "width_mm": width,
            "middle_mm": middle,
            "thinning_um": 100.0,
            "bore_radius_mm": round(pitch_radius - 3.25 * module, 1),
        },
        "face_gear": {
            "inner_radius_mm": inner,
            "outer_radius_mm": outer,
            "rim_thickness_mm": 2.0 * module,
            "addendum_modules": gear_addendum,
        },
        "shaper": {"teeth": teeth[2], "tip_rounding_modules": rounding},
    }


PAIRS: Mapping[str, dict[str, Any]] = {
    "spur": _section((25, 125, 27), (221.0, 8.0, 216.0, 226.0), 3.5, 0.9, 0.1),
    "helical": _section((25, 125, 27), (227.0, 8.0, 222.0, 232.0), 3.5, 1.0, 0.05, helix_angle_deg=15.0),
    "tapered": _section((23, 143, 26), (268.0, 8.0, 263.0, 273.0), 3.75, 0.9, 0.1, taper_angle_deg=4.0),
    "offset": _section(
        (27, 120, 29),
        (239.0, 9.0, 233.0, 245.0),
        4.0,
        1.0,
        0.0,
        helix_angle_deg=-10.0,
        offset_mm=25.0,
        pressure_angle_deg=22.5,
    ),
}
"""Section `tooth_pair` by kind of teeth: a spur pair and the public designs P1, P2 and P4, with faces of 8 or
9 mm."""


@dataclass(frozen=True)
class MeshLevel:
    """Mesh of loaded contact.

    Attributes
    ----------
    profile, width, thickness
        Sizes of elements in modules, as in `facegear.teeth.mesh_sizes.RESOLUTIONS`.
    across, along, depth
        Cuts of the layer under the flank, which make the cells of the gaps too.
    positions
        Number of positions of a pitch.
    """

    profile: float
    width: float
    thickness: float
    across: int = 2
    along: int = 1
    depth: int = 2
    positions: int = 16

    @property
    def refinement(self) -> Refinement:
        """Cuts of the flank layer; depths double from the surface inwards."""
        return Refinement(self.across, self.along, self.depth, 2.0)


def directions(base: MeshLevel, finer: float) -> dict[str, MeshLevel]:
    """Return a level, the levels that are finer in one direction, and the one finer in all.

    Parameters
    ----------
    base : MeshLevel
        Level whose error is asked for.
    finer : float
        Factor on sizes of elements, dimensionless.

    Returns
    -------
    dict of str to MeshLevel
        Levels by direction: `base`, `positions`, `cells across`, `cells along`, `profile`, `face`,
        `thickness`, `depth` and `all`.
    """
    single: dict[str, dict[str, Any]] = {
        "positions": {"positions": 2 * base.positions},
        "cells across": {"across": base.across + 1},
        "cells along": {"along": base.along + 1},
        "profile": {"profile": finer * base.profile},
        "face": {"width": finer * base.width},
        "thickness": {"thickness": finer * base.thickness},
        "depth": {"depth": base.depth + 1},
    }
    # smaller elements make smaller cells, so that cells need no further cuts
    sizes = {**single["profile"], **single["face"], **single["thickness"]}
    changes: dict[str, dict[str, Any]] = {"base": {}, **single}
    changes["all"] = {**sizes, **single["depth"], **single["positions"]}
    return {name: replace(base, **change) for name, change in changes.items()}


BASE = MeshLevel(*RESOLUTIONS["medium"])
FINER = 0.7
"""Factor on sizes of elements of the finer meshes: half the area under an element."""


def setup_of(kind: str) -> ContactSetup:
    """Return a pair and what its contact is solved with.

    Parameters
    ----------
    kind : str
        A key of PAIRS.

    Returns
    -------
    ContactSetup
        Pair, mesh sizes and plan; torque by LINE_LOAD.
    """
    section = PAIRS[kind]
    torque = LINE_LOAD * section["pinion"]["width_mm"]
    config = load(
        {"case": "family_convergence", "tooth_pair": section, "contact": {"torques_n_m": [torque]}},
        results=None,
    ).config
    assert config.contact is not None
    return contact_setup(config.tooth_pair, config.mesh, config.contact)


def solve_levels(kind: str, levels: Mapping[str, MeshLevel]) -> Iterator[dict[str, Any]]:
    """Solve the drive flank of a pair on several meshes.

    Parameters
    ----------
    kind : str
        A key of PAIRS.
    levels : Mapping[str, MeshLevel]
        Levels by direction.

    Yields
    ------
    dict
        Row of the table without its errors.
    """
    setup, bodies = setup_of(kind), {}
    design, module = setup.pair.design, setup.pair.design.module
    for direction, level in levels.items():
        start, mesh = process_time(), replace(level, positions=1)
        if mesh not in bodies:
            sizes = MeshSizes(*(module * size for size in (level.profile, level.width, level.thickness)))
            plan = replace(setup.plan, refinement=level.refinement)
            flanks: list[GearFlank] = [
                gear_flank(design, body, sizes, setup.pair.material(body), plan) for body in BUILDERS
            ]
            bodies = {mesh: contact_model(design, *flanks)}
        model = bodies[mesh]
        results = loaded_contact(model, even_positions(level.positions), setup.plan.torques)
        pressure = flank_pressure(results, model.flanks, setup.pair.materials)
        yield {
            "teeth": kind,
            "finer_in": direction,
            "flank_nodes": len(model.pinion.loaded_tooth) + len(model.gear.loaded_tooth),
            "stiffness_n_per_um": 1e-6 * float(np.mean([result.k_average for result in results])),
            "pressure_mpa": 1e-6 * max(float(loads.largest()[0]) for loads in pressure.loads),
            "cpu_seconds": process_time() - start,
        }


def convergence_table(
    kinds: Collection[str] = tuple(PAIRS), base: MeshLevel = BASE, finer: float = FINER
) -> pd.DataFrame:
    """Compare the contact of pairs on a mesh with meshes finer in each direction and in all.

    Parameters
    ----------
    kinds : collection of str
        Keys of PAIRS.
    base : MeshLevel
        Mesh whose error is asked for.
    finer : float
        Factor on sizes of elements, dimensionless.

    Returns
    -------
    DataFrame
        A row for each kind and direction; errors are the base's against the row, percent.
    """
    levels = directions(base, finer)
    progress, tables = Progress("meshes", len(kinds) * len(levels)), []
    for kind in kinds:
        rows = []
        for row in solve_levels(kind, levels):
            rows.append(row)
            progress.step()
        table = pd.DataFrame(rows)
        for name, column in (("stiffness", "stiffness_n_per_um"), ("pressure", "pressure_mpa")):
            table[f"{name}_error_percent"] = 100.0 * (table[column].iloc[0] / table[column] - 1.0)
        tables.append(table)
    return pd.concat(tables, ignore_index=True)


if __name__ == "__main__":
    convergence_table().to_csv(TABLE, index=False, float_format="%.7g", lineterminator="\n")
