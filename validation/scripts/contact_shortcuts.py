"""Effect of the usual shortcuts on mean and first harmonic of the mesh stiffness."""

import pandas as pd

from facegear.build.tooth_pair import ToothPair, pair
from facegear.contact.options import ContactOptions, ContactPlan, Refinement, Sector
from facegear.io import tables
from facegear.pipeline.provenance.stage import stage
from facegear.teeth.mesh_sizes import MeshSizes
from validation.contact.benchmark import Level, shortcuts
from validation.contact.sector_study import whole_sectors

with stage(snakemake) as run:
    teeth = pair(ToothPair.of_config(snakemake.params.tooth_pair))
    design = teeth.design
    plan = ContactPlan(
        torques=(600.0,),
        positions=16,
        refinement=Refinement(profile=4, width=2, depth=2, grading=2.0),
        sector=Sector(),
        options=ContactOptions(),
    )
    m = design.module
    base = Level("full model", MeshSizes(0.4 * m, 0.85 * m, 0.8 * m), plan)
    table = shortcuts(design, base, teeth.materials)
    flat = MeshSizes(0.2 * m, 1.6 * m, 1.2 * m)
    whole = whole_sectors(design, flat, teeth.materials, 600.0, plan.positions)
    table = pd.concat([table, whole], ignore_index=True)
    tables.write(snakemake.output.table, table)
    worst = table.loc[table["mean_error_percent"].abs().idxmax()]
    run.summary(
        f"worst of {len(table) - 1}: {worst['case']}, {worst['mean_error_percent']:+.1f} % on the mean"
    )
