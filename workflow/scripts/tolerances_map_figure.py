"""K_gamma of the machine with its tolerances over torque and speed."""

from facegear.io import tables
from facegear.plots.style import save
from facegear.plots.tolerances import load_map_figure
from facegear.provenance.stage import stage

with stage(snakemake) as run:
    columns = ["torque_factor", "speed_rpm", "percentile", "value"]
    table = tables.read(snakemake.input.load_map, columns, allow_empty=True, text=["quantity"])
    save(load_map_figure(table), snakemake.output.svg, snakemake.output.png)
