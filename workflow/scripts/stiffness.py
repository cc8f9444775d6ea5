"""Mesh stiffness over a pitch at the operating load, and its harmonics."""

from facegear.contact.columns import LTCA_FINITE
from facegear.io import tables
from facegear.io.files import write_all
from facegear.provenance.stage import stage
from facegear.stages.stiffness import stiffness

with stage(snakemake) as run:
    inputs = {name: tables.read(path, LTCA_FINITE) for name, path in snakemake.input.items()}
    found = stiffness(**snakemake.params.needs, **inputs)
    write_all(found.content, snakemake.output)
    run.summary(found.summary)
