"""Runs of all sets of inputs as the table that the repository stores."""

from facegear.io import tables
from facegear.provenance.stage import stage

with stage(snakemake) as run:
    runs = tables.read_joined(snakemake.input.runs)
    tables.write(snakemake.output.runs, runs)
    run.summary(f"{runs['set'].nunique()} sets, {runs['runs'].min()} to {runs['runs'].max()} runs each")
