"""Natural frequencies of a gear body by CalculiX, or a message where it is not installed."""

from pathlib import Path

from facegear.io import tables
from facegear.pipeline.provenance.stage import stage
from validation.gear_body.calculix import peer_table

with stage(snakemake) as run:
    folder = Path(snakemake.output.table).parent / "calculix"
    folder.mkdir(parents=True, exist_ok=True)
    table = peer_table(folder, snakemake.threads)
    tables.write(snakemake.output.table, table)
    finest = table[table["around"] == table["around"].max()]
    run.summary(f"largest difference {finest['difference_percent'].abs().max():.2f} % on the finest mesh")
