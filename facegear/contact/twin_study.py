"""The twin against brute force: 23/23 and 23/143 teeth, three loads."""

from dataclasses import replace

import numpy as np
import pandas as pd

from facegear.contact.brute_force import flat_gear, loaded_rotation
from facegear.contact.iso import mesh_stiffness
from facegear.contact.options import Refinement
from facegear.contact.twin import analyse_twin, twin_model
from facegear.geometry.design import Material, PairDesign
from facegear.mesh.sizes import MeshSizes

TEETH = 13
"""In both sectors: the loaded teeth next to the middle one must not feel the free cut faces."""
POSITIONS = (0.0, 0.3, 0.6)
LINE_LOADS = (1e5, 3e5, 6e5)
STEEL = Material(206e9, 0.3)


def twin_gears(design: PairDesign, teeth: int) -> tuple[PairDesign, PairDesign]:
    """The design's pinion as a thin slab, and a spur gear of its module with `teeth` teeth."""
    first = replace(design, pinion=replace(design.pinion, width=0.5 * design.module))
    bore = design.pinion.bore_radius + (teeth - design.pinion.teeth) * design.module / 2
    return first, replace(first, pinion=replace(first.pinion, teeth=teeth, bore_radius=bore))


def twin_study(
    design: PairDesign,
    teeth: int,
    ladder: tuple[float, ...],
    positions: tuple[float, ...] = POSITIONS,
    line_loads: tuple[float, ...] = LINE_LOADS,
    sector: int = TEETH,
) -> pd.DataFrame:
    """Average stiffness (N/m per m) of ours and of brute force with facets of `ladder` (modules), 7-tooth
    sectors.

    Difference in percent of the finest brute force, its own last change beside it.
    """
    first, second = twin_gears(design, teeth)
    m = design.module
    sizes = MeshSizes(0.1 * m, 0.25 * m, 0.4 * m)
    model = twin_model(
        first, second, (sizes, sizes), Refinement(4, 1, 3, 2.0), (STEEL, STEEL), sector, "free"
    )
    ours = analyse_twin(model, np.array(positions), list(line_loads))
    thickness, base = float(np.ptp(model.surface.side.v)), first.pinion_base_radius
    fine = [MeshSizes(size * m, 0.25 * m, 0.4 * m) for size in ladder]
    meshes = [tuple(flat_gear(gear, size, STEEL, sector) for gear in (first, second)) for size in fine]
    rows = []
    for result in ours:
        load = result.torque / base / thickness
        brute = [load / (loaded_rotation(gears, result.position, load)[0] * base) for gears in meshes]
        k = result.k_average / thickness
        rows.append(
            {
                "pinion_teeth": first.pinion.teeth,
                "gear_teeth": teeth,
                "position": result.position,
                "line_load_n_per_mm": 1e-3 * load,
                "k_n_per_mm_um": 1e-9 * k,
                **{f"brute_{size:g}_modules": 1e-9 * b for size, b in zip(ladder, brute, strict=True)},
                "difference_percent": 100 * (k / brute[-1] - 1),
                "brute_last_change_percent": 100 * (brute[-1] / brute[-2] - 1) if len(brute) > 1 else np.nan,
                "iso_6336_c_gamma_n_per_mm_um": 1e-9 * mesh_stiffness(first, second),
            }
        )
    return pd.DataFrame(rows)
