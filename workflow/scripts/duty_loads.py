"""Loads of the running machine's meshes in every bin of the duty cycle."""

from facegear.io import tables
from facegear.io.files import write_all
from facegear.provenance.stage import stage
from facegear.stages.duty_loads import duty_loads
from facegear.stiffness.tables import HARMONICS_COLUMNS

with stage(snakemake) as run:
    harmonics = tables.read(snakemake.input.harmonics, HARMONICS_COLUMNS)
    found = duty_loads(harmonics, **snakemake.params.needs)
    write_all(found.content, snakemake.output)
    run.summary(found.summary)
