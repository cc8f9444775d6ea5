"""Figures of the contact of the studies' cases side by side."""

from facegear.contact.studies import stored_cases
from facegear.plots.contact_study import contact_study, pattern_study
from facegear.plots.style import save
from facegear.provenance.stage import stage

with stage(snakemake) as run:
    given = snakemake.params
    cases = stored_cases(given.points, dict(snakemake.input.items()))
    files = iter(zip(snakemake.output.svg, snakemake.output.png, strict=True))
    for study, title in given.titles.items():
        shown = [cases[0], *(case for case in cases if case.study == study)]
        save(contact_study(shown, given.torque, title), *next(files))
        save(pattern_study(shown, given.torque), *next(files))
