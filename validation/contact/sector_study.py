"""Effect of a sector of few teeth on the stiffness with its coupling kept."""

import pandas as pd

from facegear.contact.ltca import even_positions
from facegear.contact.options import Refinement
from facegear.teeth.design import Material, PairDesign
from facegear.teeth.mesh_sizes import MeshSizes
from validation.contact.benchmark import summary, with_errors
from validation.contact.peer_study import LOADED_TEETH
from validation.contact.sector_model import sector_pair

TEETH = (3, 5, 9, 13)
"""Numbers of teeth of the sectors."""


def whole_sectors(
    design: PairDesign,
    sizes: MeshSizes,
    materials: tuple[Material, Material],
    torque: float,
    positions: int,
    teeth: tuple[int, ...] = TEETH,
) -> pd.DataFrame:
    """Compare mean and first harmonic of sectors.

    A 3-tooth sector carries the pairs -1, 0 and 1 only. Contact is resolved by unrefined elements: the ratio
    of rows counts.

    Parameters
    ----------
    design : PairDesign
        The pair.
    sizes : MeshSizes
        Mesh sizes.
    materials : tuple[Material, Material]
        Materials of pinion and gear.
    torque : float
        Torque on the pinion, N m.
    positions : int
        Number of positions in a pitch.
    teeth : tuple[int, ...]
        Numbers of teeth of the sectors.

    Returns
    -------
    DataFrame
        Errors in percent of the largest sector's.
    """
    pitch_positions = even_positions(positions)
    tables = []
    for count in teeth:
        loaded_teeth = [tooth for tooth in LOADED_TEETH if abs(tooth) <= count // 2]
        pair = sector_pair(design, sizes, materials, count, loaded_teeth, Refinement())
        results = [pair.solve(spot, (torque,))[0] for spot in pitch_positions]
        tables.append(summary(results).assign(level=_name(count)))
    table = with_errors(pd.concat(tables, ignore_index=True), _name(max(teeth)))
    return table.rename(columns={"level": "case"})


def _name(count: int) -> str:
    return f"{count}-tooth sectors meshed whole, free cut faces"
