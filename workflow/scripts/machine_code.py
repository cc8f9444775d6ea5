"""Compile the time integration early; a job that finds no machine code compiles it as well."""

from facegear.dynamics.steady_state.prepare import prepare
from facegear.provenance.stage import stage

with stage(snakemake) as run:
    prepare()
    run.summary("time integration ready")
