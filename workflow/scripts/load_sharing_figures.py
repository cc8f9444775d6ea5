"""Figures 13 to 20: load sharing over one mesh cycle for every study."""

from facegear.config.undisclosed import undisclosed_inputs
from facegear.io import tables
from facegear.load_sharing.tables import SUMMARY_COLUMNS
from facegear.plots.load_sharing import sharing_figure
from facegear.plots.style import save
from facegear.provenance.stage import stage

with stage(snakemake) as run:
    summary = tables.read(snakemake.input.summary, SUMMARY_COLUMNS[:2], text=["study", "point"]).astype(
        {"point": str}
    )
    caption = "Not disclosed, chosen here: " + "; ".join(undisclosed_inputs(snakemake.params.values))
    files = iter(zip(snakemake.output.svg, snakemake.output.png, strict=True))
    for path, title in zip(snakemake.input.studies, snakemake.params.titles, strict=True):
        curves = tables.read(path, ["cycle_fraction"], text=["study", "point"]).astype({"point": str})
        for kind in snakemake.params.kinds:
            save(sharing_figure(curves, summary, kind, title, caption), *next(files))
