"""Output of the mesh stage: files for gmsh, ParaView, Abaqus and CalculiX, and the quality table."""

from pathlib import Path

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.io import abaqus, meshes
from facegear.io.atomic import atomic_path
from facegear.mesh.gmsh_model import write_msh
from facegear.mesh.orderings import SERENDIPITY20, VTK27
from facegear.mesh.quality import scaled_jacobians, volume
from facegear.mesh.sector import SectorMesh
from facegear.mesh.sides import element_faces

QUANTILES = (0.0, 0.01, 0.1, 0.25, 0.5, 0.75, 0.9, 1.0)


def write_files(sector: SectorMesh, msh: Path, vtu: Path, inp: Path) -> pd.DataFrame:
    """Write the sector in three formats.

    Parameters
    ----------
    sector : SectorMesh
        Mesh of the teeth.
    msh : Path
        File for gmsh.
    vtu : Path
        File for ParaView.
    inp : Path
        File for Abaqus and CalculiX.

    Returns
    -------
    pd.DataFrame
        Rows of the body in quality.csv.
    """
    with atomic_path(msh) as temporary:
        condition = write_msh(sector, temporary)
    jacobian = scaled_jacobians(sector.nodes, sector.hexes)
    meshes.write_vtu(
        vtu,
        sector.nodes,
        {"hexahedron27": sector.hexes[:, VTK27]},
        cell_data={"scaled_jacobian": [jacobian], "min_sicn": [condition]},
    )
    names = [name for name in sector.tooth.faces if len(sector.faces(name))]
    abaqus.write(
        inp,
        f"{sector.tooth.body}: {len(sector.tooth_nodes)} of {sector.tooth.teeth} teeth",
        sector.nodes,
        sector.hexes[:, SERENDIPITY20],
        {name: np.unique(sector.faces(name)) for name in names},
        {f"{name}_surface": element_faces(sector, name) for name in names},
    )
    return quality_table(sector, jacobian, condition)


def quality_table(sector: SectorMesh, jacobian: Array, condition: Array) -> pd.DataFrame:
    """Tabulate counts, volume, and quality by quantile.

    Parameters
    ----------
    sector : SectorMesh
        Mesh of the teeth.
    jacobian : (elements,) array
        Scaled Jacobians, dimensionless.
    condition : (elements,) array
        gmsh's minSICN, dimensionless.

    Returns
    -------
    pd.DataFrame
        Columns body, quantity, statistic and value.
    """
    body, serendipity = sector.tooth.body, np.unique(sector.hexes[:, SERENDIPITY20])
    rows = [
        (body, "teeth", "count", len(sector.tooth_nodes)),
        (body, "elements", "count", len(sector.hexes)),
        (body, "nodes", "count", len(sector.nodes)),
        (body, "serendipity_dof", "count", 3 * len(serendipity)),
        (body, "volume_mm3", "sum", 1e9 * volume(sector.nodes, sector.hexes)),
    ]
    for name, values in (("scaled_jacobian", jacobian), ("min_sicn", condition)):
        rows += [(body, name, f"quantile_{q:g}", float(np.quantile(values, q))) for q in QUANTILES]
    return pd.DataFrame(rows, columns=["body", "quantity", "statistic", "value"])
