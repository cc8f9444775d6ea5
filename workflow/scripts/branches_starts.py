"""Random starts at one speed: which motions they end on."""

from facegear.config.base import parse
from facegear.config.branches import Branches, branch_plan
from facegear.config.machines import wired_machine
from facegear.dynamics.branches.machine import random_starts
from facegear.dynamics.branches.stored import to_arrays
from facegear.dynamics.steady_state.simulate import build_model
from facegear.io import arrays, tables
from facegear.progress import Progress
from facegear.provenance.stage import stage
from facegear.stiffness.tables import HARMONICS_COLUMNS

with stage(snakemake) as run:
    params, output = snakemake.params, snakemake.output
    harmonics = tables.read(snakemake.input.harmonics, HARMONICS_COLUMNS)
    model = build_model(wired_machine(params.transmission, params.teeth, harmonics))
    plan = branch_plan(parse(Branches, params.branches), params.speed_rpm)
    speed = plan.speeds_rpm[int(snakemake.wildcards.number)]
    found = random_starts(model, plan, speed, Progress("random starts", plan.starts).step)
    arrays.write(output.found, **to_arrays(speed, found))
    run.summary(
        f"{speed:g} rpm: "
        + ", ".join(f"{one.label} {100 * one.share:.1f} +- {100 * one.error:.1f} %" for one in found)
    )
