"""The figures of one chapter, from stored files alone."""

import signal
from importlib import import_module

signal.signal(signal.SIGINT, signal.SIG_DFL)  # before long imports: Ctrl-C ends a job without a traceback

from facegear.pipeline.provenance.stage import stage

with stage(snakemake) as run:
    from facegear.pipeline.arguments import typed_arguments
    from facegear.pipeline.run import read_all
    from facegear.pipeline.stage import load
    from facegear.report.figures.draw_matplotlib import save

    stages = import_module("facegear.pipeline.table").STAGES  # as in stage.py
    paths = list(zip(snakemake.output.svg, snakemake.output.json, strict=True))
    for name in snakemake.params.stages:
        figure_row = stages[name].figures
        inputs = {key.removeprefix(f"{name}__"): path for key, path in snakemake.input.items()}
        draw = load(figure_row.draw)
        needs = typed_arguments(draw, snakemake.params.needs[name])
        for figure in draw(**read_all(figure_row.upstream, inputs, stages), **needs):
            save(figure, *paths.pop(0))
    if paths:
        raise ValueError(f"not drawn: {paths}")
    count = len(snakemake.output.svg)
    run.summary(f"{count} figure{'s' * (count != 1)}")
