"""One chunk of a speed sweep in one direction."""

from facegear.config.base import parse
from facegear.config.dynamics import Sweep, sweep_plan
from facegear.config.transmission import Transmission, machine, tooth_numbers
from facegear.dynamics.steady_state.simulate import build_model
from facegear.dynamics.sweeps.stored import to_arrays
from facegear.dynamics.sweeps.sweep import run_chunk
from facegear.io import arrays, tables
from facegear.progress import Progress
from facegear.provenance.stage import stage
from facegear.stiffness.tables import HARMONICS_COLUMNS, series_of

with stage(snakemake) as run:
    params, wildcards = snakemake.params, snakemake.wildcards
    stiffness = series_of(tables.read(snakemake.input.harmonics, HARMONICS_COLUMNS))
    model = build_model(
        machine(parse(Transmission, params.section), tooth_numbers(**params.teeth), stiffness)
    )
    plan = sweep_plan(parse(Sweep, params.sweep))
    number = int(wildcards.number)
    total = sum(map(len, plan.chunk(wildcards.direction, number)))
    progress = Progress(f"sweep {wildcards.direction}, chunk {number}", total)
    before, own = run_chunk(model, plan, wildcards.direction, number, progress.step)
    arrays.write(snakemake.output.chunk, **to_arrays(before, own))
    run.summary(f"{len(own.speeds)} speeds {wildcards.direction}, {len(before.speeds)} for overlap")
