"""Response at the nominal speed: time history, spectrum, statistics, multipliers."""

from facegear.io import tables
from facegear.io.files import write_all
from facegear.provenance.stage import stage
from facegear.stages.dynamics_response import dynamics_response
from facegear.stiffness.tables import HARMONICS_COLUMNS

with stage(snakemake) as run:
    harmonics = tables.read(snakemake.input.harmonics, HARMONICS_COLUMNS)
    found = dynamics_response(harmonics, **snakemake.params.needs)
    write_all(found.content, snakemake.output)
    run.summary(found.summary)
