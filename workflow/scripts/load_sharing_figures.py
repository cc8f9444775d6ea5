"""Load sharing over one mesh cycle for every study."""

from facegear.io import tables
from facegear.load_sharing.tables import SUMMARY_COLUMNS
from facegear.plots.load_sharing import sharing_figure
from facegear.plots.style import save
from facegear.provenance.stage import stage
from facegear.report.inputs import inputs_caption

NAMES = ["study", "point", "label"]

with stage(snakemake) as run:
    summary = tables.read(snakemake.input.summary, SUMMARY_COLUMNS[:2], text=NAMES)
    files = iter(zip(snakemake.output.svg, snakemake.output.png, strict=True))
    for path, (title, of_paper) in zip(snakemake.input.studies, snakemake.params.titles, strict=True):
        caption = inputs_caption(snakemake.params.values, of_paper)
        curves = tables.read(path, ["cycle_fraction"], text=NAMES)
        for kind in snakemake.params.kinds:
            save(sharing_figure(curves, summary, kind, title, caption), *next(files))
