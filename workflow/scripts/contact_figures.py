"""Transmission error, load share and contact pattern."""

from facegear.contact.columns import LTCA_FINITE, PRESSURE_ARRAYS
from facegear.io import arrays, tables
from facegear.plots.contact import contact_curves, contact_pattern
from facegear.plots.style import save
from facegear.provenance.stage import stage

with stage(snakemake) as run:
    ltca = tables.read(snakemake.input.ltca, LTCA_FINITE)
    pressure = arrays.read(snakemake.input.pressure, PRESSURE_ARRAYS)
    drawn = (contact_curves(ltca), contact_pattern(pressure))
    for figure, svg, png in zip(drawn, snakemake.output.svg, snakemake.output.png, strict=True):
        save(figure, svg, png)
