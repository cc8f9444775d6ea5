"""Runs of all sets of inputs as the table that the repository stores."""

import pandas as pd

from facegear.io import tables
from facegear.provenance.stage import stage

with stage(snakemake) as run:
    runs = pd.concat([tables.read(path) for path in snakemake.input.runs], ignore_index=True)
    tables.write(snakemake.output.runs, runs)
    run.summary(f"{runs['set'].nunique()} sets, {runs['runs'].min()} to {runs['runs'].max()} runs each")
