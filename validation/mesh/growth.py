"""Growth of the time to build a mesh with its resolution: time against nodes."""

import time

import numpy as np
import pandas as pd

from facegear.teeth.design import PairDesign
from facegear.teeth.mesh_files import SERENDIPITY20
from facegear.teeth.mesh_quality import scaled_jacobians, volume
from facegear.teeth.mesh_sizes import RESOLUTIONS, named_sizes
from facegear.teeth.tooth_mesh import gear_tooth, pinion_tooth

BUILDERS = {"pinion": pinion_tooth, "face_gear": gear_tooth}


def growth_table(design: PairDesign, repeats: int = 3) -> pd.DataFrame:
    """Measure how meshes grow: counts, smallest scaled Jacobian, volume, best time to build.

    growth_exponent is the slope of log time over log nodes against the level before (0 on the first).

    Parameters
    ----------
    design : PairDesign
        The pair.
    repeats : int
        Number of builds whose best time counts.

    Returns
    -------
    DataFrame
        One row per body and level.
    """
    rows = []
    for body, build in BUILDERS.items():
        before = None
        for level in RESOLUTIONS:
            sizes = named_sizes(level, design.module)
            seconds = []
            for _ in range(repeats):
                start = time.perf_counter()
                tooth = build(design, sizes)
                seconds.append(time.perf_counter() - start)
            now = (len(tooth.nodes), min(seconds))
            slope = np.log(now[1] / before[1]) / np.log(now[0] / before[0]) if before else 0.0
            rows.append(
                {
                    "body": body,
                    "resolution": level,
                    "elements": len(tooth.hexes),
                    "nodes": now[0],
                    "serendipity_dof": 3 * len(np.unique(tooth.hexes[:, SERENDIPITY20])),
                    "smallest_scaled_jacobian": float(scaled_jacobians(tooth.nodes, tooth.hexes).min()),
                    "volume_mm3": 1e9 * volume(tooth.nodes, tooth.hexes),
                    "build_s": now[1],
                    "growth_exponent": float(slope),
                }
            )
            before = now
    return pd.DataFrame(rows)
