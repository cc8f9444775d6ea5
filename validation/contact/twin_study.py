"""Twin compared with brute force: 23/23 and 23/143 teeth, three loads."""

from dataclasses import replace

import numpy as np
import pandas as pd

from facegear.contact.options import Refinement
from facegear.progress import Progress
from facegear.teeth.design import AssemblyErrors, Material, PairDesign, PinionGeometry
from facegear.teeth.mesh_sizes import MeshSizes
from validation.contact.brute_force import gears_at, loaded_rotations
from validation.contact.brute_mesh import flat_mesh
from validation.contact.iso import mesh_stiffness
from validation.contact.twin import analyse_twin, twin_model

TEETH = 13
"""Number of teeth of both sectors: the loaded teeth next to the middle one must not feel the cut faces."""
POSITIONS = (0.0, 0.3, 0.6)
LINE_LOADS = (1e5, 3e5, 6e5)
STEEL = Material(206e9, 0.3)
CUTS = Refinement(8, 1, 4, 2.0)
HALVINGS, RADIUS = 3, 0.2
"""Number of halvings of brute force's triangles, and the distance from a contact, in modules, within which
they apply: facets of an eighth of the mesh's."""


def twin_gears(design: PairDesign, teeth: int) -> tuple[PairDesign, PairDesign]:
    """Return the design's pinion as a thin slab, and a spur gear of its module.

    Both are standard gears without backlash: thinning, profile shift, chamfer and reliefs are left out.

    Parameters
    ----------
    design : PairDesign
        The pair.
    teeth : int
        Number of teeth of the spur gear.

    Returns
    -------
    tuple[PairDesign, PairDesign]
        Both gears.
    """
    part = design.pinion
    standard = PinionGeometry(
        part.teeth,
        0.5 * design.module,
        part.addendum,
        part.dedendum,
        part.rack_tip_radius,
        part.bore_radius,
    )
    first = replace(design, pinion=standard, assembly=AssemblyErrors())
    bore = design.pinion.bore_radius + (teeth - design.pinion.teeth) * design.module / 2
    return first, replace(first, pinion=replace(first.pinion, teeth=teeth, bore_radius=bore))


def twin_study(
    design: PairDesign,
    teeth: int,
    facets: tuple[float, ...],
    positions: tuple[float, ...] = POSITIONS,
    line_loads: tuple[float, ...] = LINE_LOADS,
    sector: int = TEETH,
) -> pd.DataFrame:
    """Compare the average stiffness of ours and of brute force.

    Facets are halved `HALVINGS` times more where the flanks touch. Differences are in percent of the
    finest brute force, whose own last change is given, too.

    Parameters
    ----------
    design : PairDesign
        The pair.
    teeth : int
        Number of teeth of the spur gear.
    facets : tuple[float, ...]
        Sizes of brute force's facets, modules.
    positions : tuple[float, ...]
        Positions, fractions of a pitch.
    line_loads : tuple[float, ...]
        Loads along the line of action, N/m.
    sector : int
        Number of teeth of both sectors.

    Returns
    -------
    DataFrame
        One row for each position and load.
    """
    first, second = twin_gears(design, teeth)
    m = design.module
    sizes = MeshSizes(0.05 * m, 0.25 * m, 0.2 * m)
    model = twin_model(first, second, (sizes, sizes), CUTS, (STEEL, STEEL), sector, "free")
    results = analyse_twin(model, np.array(positions), list(line_loads))
    thickness, base = float(np.ptp(model.surface.side.v)), first.pinion_base_radius
    fine = [MeshSizes(size * m, 0.25 * m, 0.4 * m) for size in facets]
    progress = Progress(f"brute force, {teeth} teeth", len(facets) * len(positions))
    brute = [_brute(first, second, size, sector, positions, line_loads, progress) for size in fine]
    rows = []
    for result, *brute_k in zip(results, *brute, strict=True):
        load = result.torque / base / thickness
        k = result.k_average / thickness
        rows.append(
            {
                "pinion_teeth": first.pinion.teeth,
                "gear_teeth": teeth,
                "position": result.position,
                "line_load_n_per_mm": 1e-3 * load,
                "k_n_per_mm_um": 1e-9 * k,
                **{f"brute_{size:g}_modules": 1e-9 * b for size, b in zip(facets, brute_k, strict=True)},
                "difference_percent": 100 * (k / brute_k[-1] - 1),
                "brute_last_change_percent": 100 * (brute_k[-1] / brute_k[-2] - 1),
                "iso_6336_c_gamma_n_per_mm_um": 1e-9 * mesh_stiffness(first, second),
            }
        )
    return pd.DataFrame(rows)


def _brute(first, second, sizes, sector, positions, line_loads, progress):  # type: ignore[no-untyped-def]
    """Stiffness (N/m per m) at all loads of all positions on one mesh."""
    meshes = flat_mesh(first, sizes, sector), flat_mesh(second, sizes, sector)
    base, results = first.pinion_base_radius, []
    for position in positions:
        gears = gears_at(meshes, position, STEEL, RADIUS * first.module, HALVINGS)
        turns = loaded_rotations(gears, position, line_loads)
        results += [load / (turn * base) for load, (turn, _) in zip(line_loads, turns, strict=True)]
        progress.step()
    return results
