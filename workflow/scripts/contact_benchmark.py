"""Speed against error of the contact chain, as a table and a figure."""

import pandas as pd

from facegear.contact.benchmark import with_errors
from facegear.contact.rungs import FINEST
from facegear.io import tables
from facegear.plots.benchmark_contact import speed_against_error
from facegear.plots.style import save
from facegear.provenance.stage import stage

with stage(snakemake) as run:
    parts = [tables.read(path, ["rung", "torque_n_m", "mean_n_per_m"]) for path in snakemake.input.tables]
    table = with_errors(pd.concat(parts, ignore_index=True), FINEST)
    tables.write(snakemake.output.table, table)
    save(speed_against_error(table), snakemake.output.svg, snakemake.output.png)
    run.summary(f"{table['rung'].nunique()} resolutions against {FINEST}")
