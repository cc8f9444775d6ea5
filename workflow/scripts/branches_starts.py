"""Random starts at one speed: which motions they end on."""

from facegear.io import tables
from facegear.io.files import write_all
from facegear.provenance.stage import stage
from facegear.stages.branches_starts import branches_starts
from facegear.stiffness.tables import HARMONICS_COLUMNS

with stage(snakemake) as run:
    harmonics = tables.read(snakemake.input.harmonics, HARMONICS_COLUMNS)
    found = branches_starts(int(snakemake.wildcards.number), harmonics, **snakemake.params.needs)
    write_all(found.content, snakemake.output)
    run.summary(found.summary)
