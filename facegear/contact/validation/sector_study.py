"""What a sector of few teeth does to the stiffness with its coupling kept: sectors meshed whole."""

from math import pi

import numpy as np
import pandas as pd

from facegear.contact.benchmark import summary, with_errors
from facegear.contact.ltca import Place, even_positions
from facegear.contact.pair import BUILDERS
from facegear.contact.validation.peer_study import LOADED, unrefined_model
from facegear.contact.validation.sector_model import analyse_sector, sector_blocks
from facegear.geometry.design import Material, PairDesign
from facegear.geometry.unloaded import unloaded_contact
from facegear.mesh.sizes import MeshSizes

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
    phi1 = (places - 0.5) * 2 * pi / design.pinion.teeth
    phi2 = unloaded_contact(design, phi1).phi2
    model = unrefined_model(design, sizes)
    tables = []
    for count in teeth:
        loaded = [pair for pair in LOADED if abs(pair) <= count // 2]
        blocks = [
            sector_blocks(design, build(design, sizes), material, count, loaded)
            for build, material in zip(BUILDERS.values(), materials, strict=True)
        ]
        results = [
            analyse_sector(
                model, *blocks, Place(float(place), 0.0, design.pinion_base_radius), tuple(angles), [torque]
            )[0]
            for place, angles in zip(places, np.stack([phi1, phi2], axis=1).tolist(), strict=True)
        ]
        tables.append(summary(results).assign(rung=_name(count)))
    table = with_errors(pd.concat(tables, ignore_index=True), _name(max(teeth)))
    return table.rename(columns={"rung": "case"})


def _name(count: int) -> str:
    return f"{count}-tooth sectors meshed whole, free cut faces"
