"""Bins of the duty cycle beside the stress that may be repeated so often."""

from facegear.io import tables
from facegear.plots.strength import life
from facegear.plots.style import save
from facegear.provenance.stage import stage
from facegear.strength.columns import CURVE_COLUMNS, DAMAGE_FINITE

with stage(snakemake) as run:
    damage = tables.read(snakemake.input.damage, DAMAGE_FINITE)
    curves = tables.read(snakemake.input.curves, CURVE_COLUMNS)
    save(life(damage, curves), snakemake.output.svg, snakemake.output.png)
