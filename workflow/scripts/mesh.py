"""Structured meshes of both bodies, written for gmsh, ParaView, Abaqus and CalculiX."""

from pathlib import Path

import pandas as pd

from facegear.io import tables
from facegear.mesh.export import write_files
from facegear.provenance.stage import stage
from facegear.stages.mesh import meshes

with stage(snakemake) as run:
    output, quality = snakemake.output, []
    for body, sector in meshes(**snakemake.params.needs).items():
        files = [Path(output[f"{body}_{kind}"]) for kind in ("msh", "vtu", "inp")]
        quality.append(write_files(sector, *files))
    table = pd.concat(quality, ignore_index=True)
    tables.write(output.quality, table)
    worst = table.query("quantity == 'scaled_jacobian'")["value"].min()
    elements = int(table.query("quantity == 'elements'")["value"].sum())
    run.summary(f"{elements} hexahedra, smallest scaled Jacobian {worst:.3f}")
