"""Speed against error of the contact chain, as a table and a figure."""

import pandas as pd

from facegear.io import tables
from facegear.pipeline.provenance.stage import stage
from facegear.report.figures.draw_matplotlib import save_drawn
from validation.contact.benchmark import cheapest, with_errors
from validation.contact.refinement_levels import DEFAULT, FINEST
from validation.plots.contact import speed_against_error

with stage(snakemake) as run:
    parts = [tables.read(path, ["level", "torque_n_m", "mean_n_per_m"]) for path in snakemake.input.tables]
    growth = tables.read(snakemake.input.growth, ["varied", "positions", "loads", "contact_s"])
    table = with_errors(pd.concat(parts, ignore_index=True), FINEST)
    tables.write(snakemake.output.table, table)
    save_drawn(speed_against_error(table, growth, DEFAULT), snakemake.output.svg, snakemake.output.png)
    best = cheapest(table)
    run.summary(
        f"{table['level'].nunique()} resolutions against {FINEST}; cheapest {best}, default {DEFAULT}"
    )
