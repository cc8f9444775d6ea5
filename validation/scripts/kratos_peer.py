"""Hertz's contact by Kratos' mortar method."""

from pathlib import Path

from facegear.io import tables
from facegear.pipeline.provenance.stage import stage
from validation.contact.kratos_hertz import hertz_peer

with stage(snakemake) as run:
    table = hertz_peer(Path(snakemake.output.table).parent / "kratos", (0.06, 0.03), snakemake.threads)
    tables.write(snakemake.output.table, table)
    run.summary(f"largest pressure {table['error_percent'].iloc[-1]:+.2f} % from Hertz")
