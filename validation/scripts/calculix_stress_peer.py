"""Fillet stress by CalculiX on the same meshes, or a message where it is not installed."""

from pathlib import Path

from facegear.build.tooth_pair import ToothPair, pair
from facegear.io import tables
from facegear.pipeline.provenance.stage import stage
from validation.contact.stress_peer import stress_peer_tables

with stage(snakemake) as run:
    teeth = pair(ToothPair.of_config(snakemake.params.tooth_pair))
    folder = Path(snakemake.output.table).parent / "calculix"
    folder.mkdir(parents=True, exist_ok=True)
    table = stress_peer_tables(teeth.design, teeth.materials, folder, snakemake.threads)
    tables.write(snakemake.output.table, table)
    last = table.groupby("face_mm").tail(2)["difference_percent"].abs().max()
    run.summary(f"largest difference on the finest meshes {last:.1f} %")
