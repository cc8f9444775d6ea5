"""Load sharing of one case at the nominal speed."""

from facegear.io import tables
from facegear.io.files import write_all
from facegear.provenance.stage import stage
from facegear.stages.load_sharing import load_sharing
from facegear.stiffness.tables import HARMONICS_COLUMNS

with stage(snakemake) as run:
    harmonics = tables.read(snakemake.input.harmonics, HARMONICS_COLUMNS)
    found = load_sharing(harmonics, **snakemake.params.needs)
    write_all(found.content, snakemake.output)
    run.summary(found.summary)
