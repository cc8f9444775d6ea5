"""The front between objectives, and how the islands came to it."""

from facegear.io import columnar, tables
from facegear.plots.search import front_figure, hypervolume_figure
from facegear.plots.style import save
from facegear.provenance.stage import stage

with stage(snakemake) as run:
    given = snakemake.input
    designs = columnar.read(given.designs, ["generation", "error"])
    front = tables.read(given.front, [], allow_empty=True)
    winners = tables.read(given.winners, ["design"], text=["design"])
    hypervolume = tables.read(given.hypervolume, ["hypervolume"], allow_empty=True)
    objectives = [one["name"] for one in snakemake.params.objectives]
    figures = (front_figure(designs, front, winners, objectives), hypervolume_figure(hypervolume))
    for figure, *paths in zip(figures, snakemake.output.svg, snakemake.output.png, strict=True):
        save(figure, *paths)
