"""Each speed of the sweep once more with everything finer that is discretised."""

import pandas as pd

from facegear.build.plans import sweep_plan
from facegear.io import arrays, tables
from facegear.meshing.stiffness_source import HARMONICS_COLUMNS
from facegear.motion.steady_state.simulate import build_model
from facegear.motion.sweeps.sweep import join_pieces
from facegear.motion.sweeps.whole_sweep import SHAPES, from_arrays
from facegear.motion.symmetries import mesh_images
from facegear.pipeline.provenance.stage import stage
from facegear.pipeline.run import machine_inputs
from facegear.progress import Progress
from facegear.schema.motion import Sweep
from validation.dynamics.convergence import (
    convergence_table,
    not_converged,
    rerun,
    watched_longer,
)

with stage(snakemake) as run:
    params = snakemake.params
    harmonics = tables.read(snakemake.input.harmonics, HARMONICS_COLUMNS)
    model = build_model(machine_inputs({**params.machine, "harmonics": harmonics}).build())
    plan = sweep_plan(Sweep.of_config(params.sweep))
    files = iter(snakemake.input.chunks)
    progress = Progress("finer sweep", len(plan.directions) * plan.points)
    frames = []
    for name in plan.directions:
        piece = join_pieces([from_arrays(arrays.read(next(files), SHAPES))[1] for _ in range(plan.chunks)])
        again = rerun(model, piece, plan.settings, progress.step)
        longer = watched_longer(model, piece, again, plan.settings)
        frames.append(convergence_table(name, piece, again, longer, mesh_images(model.system)))
    table = pd.concat(frames, ignore_index=True)
    tables.write(snakemake.output.table, table)
    run.summary(not_converged(table))
