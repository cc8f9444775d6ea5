"""The plane-strain twin against brute-force contact, ISO 6336 beside it."""

import pandas as pd

from facegear.build.tooth_pair import ToothPair, pair
from facegear.io import tables
from facegear.pipeline.provenance.stage import stage
from validation.contact.twin_study import twin_study

with stage(snakemake) as run:
    design = pair(ToothPair.of_config(snakemake.params.tooth_pair)).design
    gears = (design.pinion.teeth, design.face_gear.teeth)
    facets = (0.2, 0.1, 0.05)
    table = pd.concat([twin_study(design, teeth, facets) for teeth in gears], ignore_index=True)
    tables.write(snakemake.output.table, table)
    run.summary(f"largest difference from brute force {table['difference_percent'].abs().max():.2f} %")
