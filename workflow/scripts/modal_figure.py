"""Typical mode shapes."""

from facegear.io import tables
from facegear.plots.modal import mode_shapes
from facegear.plots.style import save
from facegear.provenance.stage import stage

with stage(snakemake) as run:
    frequencies = tables.read(snakemake.input.frequencies, ["order", "frequency_hz", "symbols", "class"])
    shapes = tables.read(snakemake.input.shapes, ["order", "body", "dof", "relative"])
    save(mode_shapes(frequencies, shapes), snakemake.output.svg, snakemake.output.png)
