"""Root stress, pressure and dynamic factor over speed."""

from facegear.io import tables
from facegear.plots.stress_over_speed import stress_over_speed
from facegear.plots.style import save
from facegear.provenance.stage import stage
from facegear.strength.columns import STRESS_OVER_SPEED_FINITE

with stage(snakemake) as run:
    table = tables.read(snakemake.input.table, STRESS_OVER_SPEED_FINITE)
    figure = stress_over_speed(table, snakemake.params.speed_rpm)
    save(figure, snakemake.output.svg, snakemake.output.png)
