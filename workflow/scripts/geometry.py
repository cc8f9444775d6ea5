"""Exact geometry of the tooth pair: limits, contact path, backlash, smallest gaps."""

from facegear.io.files import write_all
from facegear.provenance.stage import stage
from facegear.stages.geometry import geometry

with stage(snakemake) as run:
    found = geometry(**snakemake.params.needs)
    write_all(found.content, snakemake.output)
    run.summary(found.summary)
