"""Percentiles of the machine with its tolerances over torque and speed."""

from pathlib import Path

from facegear.io import tables
from facegear.io.files import write_all
from facegear.provenance.stage import stage
from facegear.stages.sampled_machine import SampledMachine
from facegear.stages.tolerances_map import tolerances_map
from facegear.stages.tooth_meshes import read_flanks
from facegear.stiffness.tables import HARMONICS_COLUMNS

with stage(snakemake) as run:
    params, given = snakemake.params, snakemake.input
    harmonics = tables.read(given.harmonics, HARMONICS_COLUMNS)
    partial = Path(snakemake.output.load_map).with_suffix(".partial")
    machine = SampledMachine(harmonics=harmonics, flanks=read_flanks(given.flanks), **params.needs)
    found = tolerances_map(machine, partial, params.code)
    write_all(found.content, snakemake.output)
    partial.unlink()
    run.summary(found.summary)
