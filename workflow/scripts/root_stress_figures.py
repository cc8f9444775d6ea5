"""Root stress over a passage and along the face."""

from facegear.io import tables
from facegear.plots.strength import along_face, passage
from facegear.plots.style import save
from facegear.provenance.stage import stage
from facegear.strength.columns import ALONG_FACE_COLUMNS, PASSAGE_COLUMNS

with stage(snakemake) as run:
    drawn = (
        passage(tables.read(snakemake.input.passage, PASSAGE_COLUMNS)),
        along_face(tables.read(snakemake.input.along_face, ALONG_FACE_COLUMNS)),
    )
    for figure, svg, png in zip(drawn, snakemake.output.svg, snakemake.output.png, strict=True):
        save(figure, svg, png)
