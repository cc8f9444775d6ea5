"""Natural frequencies, mode shapes and their classes."""

from facegear.io import tables
from facegear.io.files import write_all
from facegear.provenance.stage import stage
from facegear.stages.modal import modal
from facegear.stiffness.tables import HARMONICS_COLUMNS

with stage(snakemake) as run:
    inputs = {name: tables.read(path, HARMONICS_COLUMNS) for name, path in snakemake.input.items()}
    found = modal(**snakemake.params.needs, **inputs)
    write_all(found.content, snakemake.output)
    run.summary(found.summary)
