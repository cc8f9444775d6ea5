"""Branches of periodic motions over the speed, their special points, margins of the nominal speed."""

from facegear.dynamics.branches.columns import SWEEP_JUMPS
from facegear.dynamics.branches.stored import SHAPES
from facegear.dynamics.sweeps.stored import SHAPES as CHUNK_SHAPES
from facegear.io import arrays, tables
from facegear.io.files import write_all
from facegear.provenance.stage import stage
from facegear.stages.branches import branches
from facegear.stiffness.tables import HARMONICS_COLUMNS

with stage(snakemake) as run:
    given = snakemake.input
    harmonics = tables.read(given.harmonics, HARMONICS_COLUMNS)
    jumps = tables.read(given.jumps, SWEEP_JUMPS, allow_empty=True)
    starts = [arrays.read(path, SHAPES) for path in given.starts]
    chunks = [arrays.read(path, CHUNK_SHAPES) for path in given.chunks]
    found = branches(starts, chunks, jumps, harmonics, **snakemake.params.needs)
    write_all(found.content, snakemake.output)
    run.summary(found.summary)
