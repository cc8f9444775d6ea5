"""What a sector of few teeth does to the stiffness with its coupling kept."""

import pandas as pd

from facegear.contact.ltca import even_positions
from facegear.contact.options import Refinement
from facegear.geometry.design import Material, PairDesign
from facegear.mesh.sizes import MeshSizes
from validation.contact.benchmark import summary, with_errors
from validation.contact.peer_study import LOADED
from validation.contact.sector_model import sector_pair

TEETH = (3, 5, 9, 13)


def whole_sectors(
    design: PairDesign,
    sizes: MeshSizes,
    materials: tuple[Material, Material],
    torque: float,
    positions: int,
    teeth: tuple[int, ...] = TEETH,
) -> pd.DataFrame:
    """Mean and first harmonic under `torque` (N m), errors in percent of the largest sector's.

    A 3-tooth sector carries the pairs -1, 0 and 1 only. The contact strip is seen by unrefined elements: what
    counts is the ratio of rows.
    """
    places = even_positions(positions)
    tables = []
    for count in teeth:
        loaded = [tooth for tooth in LOADED if abs(tooth) <= count // 2]
        pair = sector_pair(design, sizes, materials, count, loaded, Refinement())
        results = [pair.solve(spot, (torque,))[0] for spot in places]
        tables.append(summary(results).assign(level=_name(count)))
    table = with_errors(pd.concat(tables, ignore_index=True), _name(max(teeth)))
    return table.rename(columns={"level": "case"})


def _name(count: int) -> str:
    return f"{count}-tooth sectors meshed whole, free cut faces"
