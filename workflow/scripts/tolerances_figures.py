"""Distributions of the samples, and which errors decide them."""

from facegear.io import columnar, tables
from facegear.plots.style import save
from facegear.plots.tolerances import distribution_figure, importance_figure, scatter_figure
from facegear.provenance.stage import stage

with stage(snakemake) as run:
    given = snakemake.input
    samples = columnar.read(given.samples, ["sample", "error"])
    percentiles = tables.read(given.percentiles, ["percentile", "value"], allow_empty=True, text=["quantity"])
    importance = tables.read(given.importance, [], text=["quantity", "cause"])
    indices = tables.read(given.indices, [], allow_empty=True, text=["quantity", "cause"])
    figures = (
        distribution_figure(samples, percentiles),
        importance_figure(percentiles, importance, indices),
        scatter_figure(samples, percentiles, importance, indices),
    )
    for figure, *paths in zip(figures, snakemake.output.svg, snakemake.output.png, strict=True):
        save(figure, *paths)
