"""Safety and life of the tooth pair."""

from facegear.io import arrays
from facegear.io.files import write_all
from facegear.provenance.stage import stage
from facegear.stages.rating import rating
from facegear.strength.columns import ROOT_STRESS_ARRAYS

with stage(snakemake) as run:
    found = rating(arrays.read(snakemake.input.stress, ROOT_STRESS_ARRAYS), **snakemake.params.needs)
    write_all(found.content, snakemake.output)
    run.summary(found.summary)
