"""Time and memory against sizes."""

import os

from facegear.io import tables
from facegear.pipeline.provenance.stage import stage
from facegear.progress import Progress
from facegear.report.figures.draw_matplotlib import save_drawn
from validation.growth.curves import CURVES
from validation.growth.measure import exponents, growth_table, round_numbers
from validation.plots.growth import growth_figure

with stage(snakemake) as run:
    sizes = {name: len(curve.values) for name, curve in CURVES.items()}
    table = growth_table(sizes, Progress("sizes", sum(sizes.values())).step)
    exponent_table = round_numbers(exponents(table))
    exponent_table.insert(1, "size", [CURVES[name].size for name in exponent_table["curve"]])
    exponent_table.insert(2, "timed", [CURVES[name].timed_task for name in exponent_table["curve"]])
    exponent_table["bent_by"] = [CURVES[name].bent_by for name in exponent_table["curve"]]
    tables.write(snakemake.output.table, table)
    tables.write(snakemake.output.exponents, exponent_table)
    texts = {name: (curve.size, curve.timed_task) for name, curve in CURVES.items()}
    save_drawn(growth_figure(table, texts), snakemake.output.svg, snakemake.output.png)
    steepest = exponent_table.loc[exponent_table["exponent"].idxmax()]
    run.summary(
        f"steepest: {steepest['timed']} over {steepest['size']}, exponent {steepest['exponent']:.2f}; "
        f"load {table['load'].mean():.1f} on {os.cpu_count()} processors"
    )
