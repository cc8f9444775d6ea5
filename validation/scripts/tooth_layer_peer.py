"""Natural frequencies of gear bodies with their real teeth, by one sector of the whole gear in space."""

from facegear.io import tables
from facegear.pipeline.provenance.stage import stage
from validation.gear_body.cyclic_teeth import FINENESSES, paper, peer_table, second

with stage(snakemake) as run:
    table = peer_table((paper(), second()), FINENESSES)
    tables.write(snakemake.output.table, table)
    finest = table[table["fineness"] == table["fineness"].max()]
    for name in ("fitted", "common"):
        off = (finest[f"{name}_hz"] / finest["sector_hz"] - 1.0).abs().max()
        run.summary(f"{name} teeth: largest difference {100 * off:.2f} % on the finest mesh")
