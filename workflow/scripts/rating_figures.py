"""Bins of the duty cycle beside the stress that may be repeated so often, and their damage."""

from facegear.io import tables
from facegear.plots.strength import damage_by_bin, life
from facegear.plots.style import save
from facegear.provenance.stage import stage
from facegear.strength.columns import CURVE_COLUMNS, DAMAGE_FINITE, RATING_FINITE

with stage(snakemake) as run:
    rating = tables.read(snakemake.input.rating, RATING_FINITE)
    damage = tables.read(snakemake.input.damage, DAMAGE_FINITE)
    curves = tables.read(snakemake.input.curves, CURVE_COLUMNS)
    drawn = life(rating, damage, curves), damage_by_bin(rating, damage)
    for figure, svg, png in zip(drawn, snakemake.output.svg, snakemake.output.png, strict=True):
        save(figure, svg, png)
