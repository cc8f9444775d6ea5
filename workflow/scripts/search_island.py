"""An evolution of designs from one seed."""

from pathlib import Path

from facegear.io import tables
from facegear.io.files import write_all
from facegear.provenance.stage import stage
from facegear.stages.designs import SearchedMachine
from facegear.stages.search_island import search_island
from facegear.stages.tooth_meshes import read_flanks
from facegear.stiffness.tables import HARMONICS_COLUMNS

with stage(snakemake) as run:
    params = snakemake.params
    harmonics = tables.read(snakemake.input.harmonics, HARMONICS_COLUMNS)
    flanks = read_flanks(snakemake.input.flanks)
    machine = SearchedMachine(harmonics=harmonics, flanks=flanks, **params.needs)
    partial = Path(snakemake.output.designs).with_suffix(".partial")
    found = search_island(int(snakemake.wildcards.seed), machine, partial, params.code)
    write_all(found.content, snakemake.output)
    partial.unlink()
    run.summary(found.summary)
