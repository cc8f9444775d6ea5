"""Fillet stress by CalculiX on the same meshes, or a message where it is not installed."""

from pathlib import Path

from facegear.config.tooth_pair import pair
from facegear.io import tables
from facegear.mesh.sizes import named_sizes, thin_fillet
from facegear.provenance.stage import stage
from facegear.validation.contact.stress_peer import LEVELS, stress_peer_study

with stage(snakemake) as run:
    teeth = pair(snakemake.params.tooth_pair)
    levels = {name: thin_fillet(named_sizes(name, teeth.design.module), name) for name in LEVELS}
    folder = Path(snakemake.output.table).parent / "calculix"
    folder.mkdir(parents=True, exist_ok=True)
    table = stress_peer_study(teeth.design, levels, teeth.materials, folder, snakemake.threads)
    tables.write(snakemake.output.table, table)
    last = table[table["level"] == LEVELS[-1]]["difference_percent"].abs().max()
    run.summary(f"largest difference on {LEVELS[-1]} meshes {last:.1f} %")
