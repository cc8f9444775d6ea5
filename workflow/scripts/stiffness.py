"""Mesh stiffness over a pitch at the operating load, and its harmonics."""

from facegear.config.base import parse
from facegear.config.stiffness import MeshStiffness, stiffness_request
from facegear.contact.columns import LTCA_COLUMNS
from facegear.io import tables
from facegear.provenance.stage import stage
from facegear.stiffness.source import stiffness_from_contact, stiffness_given

with stage(snakemake) as run:
    request = stiffness_request(parse(MeshStiffness, snakemake.params.section))
    inputs = dict(snakemake.input.items())
    if "ltca" in inputs:
        result = stiffness_from_contact(tables.read(inputs["ltca"], LTCA_COLUMNS), request)
    else:
        result = stiffness_given(request)
    tables.write(snakemake.output.tvms, result.curve)
    tables.write(snakemake.output.harmonics, result.harmonics)
    tables.write(snakemake.output.spectrum, result.spectrum)
    run.summary(result.summary)
