"""Cost of samples, and the error of their statistics against their number."""

from facegear.contact.gear_flank import ARRAY_SHAPES
from facegear.io import arrays, tables
from facegear.meshing.stiffness_source import HARMONICS_COLUMNS
from facegear.pipeline.provenance.stage import stage
from facegear.studies.sampled_machine import SampledMachine
from validation.scenarios.costs import costs
from validation.scenarios.errors import statistics_errors

with stage(snakemake) as run:
    params = snakemake.params
    harmonics = tables.read(snakemake.input.harmonics, HARMONICS_COLUMNS)
    flanks = [arrays.read(path, ARRAY_SHAPES) for path in snakemake.input.flanks]
    sampled_machine = SampledMachine.of_stage(harmonics=harmonics, flanks=flanks, **params.chunk)
    table = costs(sampled_machine, params.samples)
    tables.write(snakemake.output.costs, table)
    tables.write(snakemake.output.errors, statistics_errors([2**power for power in range(7, 14)]))
    text = ", ".join(f"{row.model} {row.ms_a_sample:.3g} ms" for row in table.itertuples())
    run.summary(f"a sample takes: {text}")
