"""Cost and error of sweeps against settings."""

from facegear.build.plans import sweep_plan
from facegear.io import tables
from facegear.meshing.stiffness_source import HARMONICS_COLUMNS
from facegear.pipeline.provenance.stage import stage
from facegear.pipeline.run import machine_inputs
from facegear.progress import Progress
from facegear.schema.motion import Sweep
from validation.dynamics.costs import sweep_costs

with stage(snakemake) as run:
    params = snakemake.params
    harmonics = tables.read(snakemake.input.harmonics, HARMONICS_COLUMNS)
    machine = machine_inputs({**params.machine, "harmonics": harmonics}).build()
    costs = sweep_costs(machine, sweep_plan(Sweep.of_config(params.sweep)), Progress("settings", 20).step)
    tables.write(snakemake.output.sweep, costs)
    ratio = (costs["plain_seconds_per_speed"] / costs["seconds_per_speed"]).max()
    run.summary(
        f"a speed costs down to {1e3 * costs['seconds_per_speed'].min():.1f} ms, 1/{ratio:.0f} of plain SciPy"
    )
