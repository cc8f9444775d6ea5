"""Time to mesh one tooth of either body against its number of nodes, over the named resolutions."""

from facegear.build.tooth_pair import ToothPair, pair
from facegear.io import tables
from facegear.pipeline.provenance.stage import stage
from validation.mesh.growth import growth_table

with stage(snakemake) as run:
    table = growth_table(pair(ToothPair.of_config(snakemake.params.tooth_pair)).design)
    tables.write(snakemake.output.table, table)
    slowest = table.loc[table["build_s"].idxmax()]
    run.summary(f"slowest: {slowest['body']} {slowest['resolution']}, {slowest['build_s']:.2f} s a tooth")
