"""The whole sweep from its chunks: table, jumps, resonances, seams, waterfall."""

from facegear.dynamics.sweeps.stored import SHAPES
from facegear.io import arrays, tables
from facegear.io.files import write_all
from facegear.provenance.stage import stage
from facegear.stages.dynamics_sweep import dynamics_sweep
from facegear.stiffness.tables import HARMONICS_COLUMNS

with stage(snakemake) as run:
    harmonics = tables.read(snakemake.input.harmonics, HARMONICS_COLUMNS)
    chunks = [arrays.read(path, SHAPES) for path in snakemake.input.chunks]
    found = dynamics_sweep(chunks, harmonics, **snakemake.params.needs, threads=snakemake.threads)
    write_all(found.content, snakemake.output)
    run.summary(found.summary)
