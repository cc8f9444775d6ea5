"""Percentiles, shares and Sobol indices of the samples."""

from facegear.io import columnar
from facegear.io.files import write_all
from facegear.provenance.stage import stage
from facegear.stages.tolerances import tolerances

with stage(snakemake) as run:
    given = snakemake.input
    samples, indices = ([columnar.read(path) for path in paths] for paths in (given.samples, given.indices))
    found = tolerances(samples, indices, **snakemake.params.needs)
    write_all(found.content, snakemake.output)
    run.summary(found.summary)
