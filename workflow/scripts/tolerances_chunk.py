"""A chunk of samples of the machine with its tolerances."""

from pathlib import Path

from facegear.io import tables
from facegear.io.files import write_all
from facegear.provenance.stage import stage
from facegear.stages.sampled_machine import SampledMachine
from facegear.stages.tolerances_chunk import tolerances_chunk
from facegear.stages.tooth_meshes import read_flanks
from facegear.stiffness.tables import HARMONICS_COLUMNS

with stage(snakemake) as run:
    wildcards, params = snakemake.wildcards, snakemake.params
    harmonics = tables.read(snakemake.input.harmonics, HARMONICS_COLUMNS)
    flanks = read_flanks(snakemake.input.flanks)
    machine = SampledMachine(harmonics=harmonics, flanks=flanks, **params.needs)
    partial = Path(snakemake.output.chunk).with_suffix(".partial")
    numbers = int(wildcards.first), int(wildcards.last)
    found = tolerances_chunk(wildcards.design, *numbers, machine, partial, params.code)
    write_all(found.content, snakemake.output)
    partial.unlink()
    run.summary(found.summary)
