"""Figures 6 to 20 of the paper, and the page that holds them beside their claims."""

from pathlib import Path

import pandas as pd

from facegear.io import tables
from facegear.io.atomic import atomic_path
from facegear.number_format import count_noun
from facegear.pipeline.provenance.stage import stage
from facegear.report.figures.draw_matplotlib import save
from facegear.report.machine import inputs_in_words
from paper.figures.claims_of import NUMBERS, claims_of
from paper.figures.draw import draw, shown_data
from paper.figures.page import file_name, render
from paper.reproduction import InputSet
from paper.scorecard.claims import read_claims

TABLES = ("frequencies", "shapes", "tvms", "harmonics", "response", "spectrum", "sweep", "sharing")

with stage(snakemake) as run:
    files = snakemake.input
    inputs = {name: tables.read(files[name]) for name in TABLES}
    inputs["curves"] = pd.concat([tables.read(path) for path in files.studies], ignore_index=True)
    claims = read_claims(files.claims)
    folder = Path(snakemake.output.html).parent
    for number in NUMBERS:
        figure = draw(number, inputs, claims_of(number, claims.claims))
        tables.write(folder / file_name(number, "csv"), shown_data(figure))
        save(figure, *(folder / file_name(number, ending) for ending in ("svg", "png")))
    sets = [InputSet(**values) for values in snakemake.params.inputs]
    scorecard = tables.read(files.scorecard, ["id", "verdict"])
    page = render(snakemake.wildcards.case, inputs_in_words(snakemake.params.values), claims, scorecard, sets)
    with atomic_path(snakemake.output.html) as temporary:
        temporary.write_text(page, encoding="utf-8")
    run.summary(f"{count_noun(len(NUMBERS), 'figure')}")
