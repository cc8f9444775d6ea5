"""Loci of folds and period doublings in the plane of speed and a second parameter."""

from facegear.dynamics.branches.stored import SPECIAL_SHAPES
from facegear.io import arrays, tables
from facegear.io.files import write_all
from facegear.provenance.stage import stage
from facegear.stages.branches_loci import branches_loci
from facegear.stiffness.tables import HARMONICS_COLUMNS

with stage(snakemake) as run:
    harmonics = tables.read(snakemake.input.harmonics, HARMONICS_COLUMNS)
    orbits = arrays.read(snakemake.input.orbits, SPECIAL_SHAPES)
    found = branches_loci(orbits, harmonics, **snakemake.params.needs)
    write_all(found.content, snakemake.output)
    run.summary(found.summary)
