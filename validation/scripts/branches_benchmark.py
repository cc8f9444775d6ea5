"""Branches of periodic motions: error against tolerance, and cost of an orbit against settling."""

from facegear.io import tables
from facegear.meshing.stiffness_source import HARMONICS_COLUMNS
from facegear.pipeline.provenance.stage import stage
from facegear.pipeline.run import machine_inputs
from facegear.progress import Progress
from validation.dynamics.branches import DAMPING, ERRORS, TOLERANCES, accuracy, costs

with stage(snakemake) as run:
    params = snakemake.params
    harmonics = tables.read(snakemake.input.harmonics, HARMONICS_COLUMNS)
    machine = machine_inputs({**params.machine, "harmonics": harmonics}).build()
    errors = accuracy(machine, params.speed_rpm, Progress("tolerances", 2 * len(TOLERANCES)).step)
    prices = costs(machine, params.speed_rpm, Progress("dampings", len(ERRORS) * len(DAMPING)).step)
    tables.write(snakemake.output.table, errors)
    tables.write(snakemake.output.costs, prices)
    is_settled = prices[prices["settled"]]
    run.summary(f"an orbit costs down to 1/{is_settled['ratio'].max():.0f} of settling by integration")
