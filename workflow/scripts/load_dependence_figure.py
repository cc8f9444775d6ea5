"""Stiffness against load."""

from facegear.io import tables
from facegear.plots.stiffness import stiffness_against_load
from facegear.plots.style import save
from facegear.provenance.stage import stage

with stage(snakemake) as run:
    table = tables.read(snakemake.input.table, ["definition", "torque_n_m", "mean_n_per_m"])
    save(stiffness_against_load(table), snakemake.output.svg, snakemake.output.png)
