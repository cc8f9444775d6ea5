"""Shafts by ROSS and torsional springs by openTorsion."""

from pathlib import Path

from facegear.io import tables
from facegear.pipeline.provenance.stage import stage
from validation.dynamics.shaft_peer import shaft_peer

with stage(snakemake) as run:
    table = shaft_peer(Path(snakemake.output.table).parent / "shafts")
    tables.write(snakemake.output.table, table)
    run.summary(f"largest difference {table['difference'].abs().max():.1e}")
