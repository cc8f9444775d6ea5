"""Flank compliance of one body."""

from facegear.contact.gear_flank import to_arrays
from facegear.io import arrays
from facegear.provenance.stage import stage
from facegear.stages.compliance import compliance

with stage(snakemake) as run:
    found = compliance(snakemake.wildcards.body, **snakemake.params.needs)
    arrays.write(snakemake.output.arrays, **to_arrays(found))
    run.summary(f"{len(found.compliance.own)} flank nodes, {len(found.compliance.others)} teeth coupled")
