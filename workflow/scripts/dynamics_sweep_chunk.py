"""One chunk of a speed sweep in one direction."""

from facegear.io import tables
from facegear.io.files import write_all
from facegear.provenance.stage import stage
from facegear.stages.dynamics_sweep_chunk import dynamics_sweep_chunk
from facegear.stiffness.tables import HARMONICS_COLUMNS

with stage(snakemake) as run:
    wildcards = snakemake.wildcards
    harmonics = tables.read(snakemake.input.harmonics, HARMONICS_COLUMNS)
    found = dynamics_sweep_chunk(
        wildcards.direction, int(wildcards.number), harmonics, **snakemake.params.needs
    )
    write_all(found.content, snakemake.output)
    run.summary(found.summary)
