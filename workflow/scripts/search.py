"""The front of all islands, and its winners at full accuracy."""

from pathlib import Path

from facegear.io import columnar, tables
from facegear.io.files import write_all
from facegear.provenance.stage import stage
from facegear.stages.designs import SearchedMachine
from facegear.stages.search import search
from facegear.stages.tooth_meshes import read_flanks
from facegear.stiffness.tables import HARMONICS_COLUMNS

with stage(snakemake) as run:
    given = snakemake.input
    harmonics = tables.read(given.harmonics, HARMONICS_COLUMNS)
    flanks = read_flanks(given.flanks)
    machine = SearchedMachine(harmonics=harmonics, flanks=flanks, **snakemake.params.needs)
    islands = {int(Path(path).stem): columnar.read(path) for path in given.islands}
    found = search(islands, machine)
    write_all(found.content, snakemake.output)
    run.summary(found.summary)
