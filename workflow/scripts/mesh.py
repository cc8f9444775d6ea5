"""Structured meshes of both bodies, written for gmsh, ParaView, Abaqus and CalculiX."""

from pathlib import Path

import pandas as pd

from facegear.config.base import parse
from facegear.config.mesh import Mesh, mesh_sizes
from facegear.config.tooth_pair import ToothPair, pair_design
from facegear.io import tables
from facegear.mesh.export import write_files
from facegear.mesh.sector import sector
from facegear.mesh.tooth import gear_tooth, pinion_tooth
from facegear.provenance.stage import stage

with stage(snakemake) as run:
    design = pair_design(parse(ToothPair, snakemake.params.tooth_pair))
    section = parse(Mesh, snakemake.params.mesh)
    sizes = mesh_sizes(section, design.module)
    quality = []
    for body, build in (("pinion", pinion_tooth), ("face_gear", gear_tooth)):
        tooth = build(design, sizes)
        merged = sector(tooth, min(section.exported_teeth, tooth.teeth))
        files = [Path(snakemake.output[f"{body}_{kind}"]) for kind in ("msh", "vtu", "inp")]
        quality.append(write_files(merged, *files))
    table = pd.concat(quality, ignore_index=True)
    tables.write(snakemake.output.quality, table)
    worst = table.query("quantity == 'scaled_jacobian'")["value"].min()
    elements = int(table.query("quantity == 'elements'")["value"].sum())
    run.summary(f"{elements} hexahedra, smallest scaled Jacobian {worst:.3f}")
