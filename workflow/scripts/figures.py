"""The figures of one stage, from stored files alone."""

from importlib import import_module

from facegear.config.arguments import typed_arguments
from facegear.pipeline.run import read_all
from facegear.pipeline.stage import FIGURES, load
from facegear.plots.style import save
from facegear.provenance.stage import stage

KINDS = ("svg", "png", "json")

with stage(snakemake) as run:
    stages = import_module("facegear.pipeline.table").STAGES  # as in stage.py
    drawn = stages[snakemake.rule.removesuffix(FIGURES)].figures
    given = read_all(drawn.upstream, snakemake.input, stages)
    draw = load(drawn.draw)
    figures = draw(**given, **typed_arguments(draw, snakemake.params.needs))
    for figure, *paths in zip(figures, *(getattr(snakemake.output, kind) for kind in KINDS), strict=True):
        save(figure, *paths)
