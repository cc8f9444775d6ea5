"""Search for the most likely inputs under one pattern of e(t), the one that goes on at this place."""

from pathlib import Path

import pandas as pd

from facegear.config.base import parse
from facegear.contact.columns import LTCA_FINITE
from facegear.io import tables
from facegear.paper.config.search import plausible_inputs, search_budget
from facegear.paper.config.sections import Identify
from facegear.paper.identify.claim_judge import QUICK
from facegear.paper.identify.likelihood import Likelihood
from facegear.paper.identify.motions import LOG_LIKELIHOOD
from facegear.paper.identify.random_verdicts import dynamic_judge, fitted_at_speed
from facegear.paper.identify.search import search_pattern, start_at
from facegear.paper.scorecard.claims import read_claims
from facegear.progress import Progress
from facegear.provenance.stage import stage
from facegear.scenarios.chunks import identity

with stage(snakemake) as run:
    files, params = snakemake.input, snakemake.params
    place, repeat = int(snakemake.wildcards.place), int(snakemake.wildcards.repeat)
    section = parse(Identify, params.identify)
    budget = search_budget(section.search)
    ltca = tables.read(files.ltca, LTCA_FINITE)
    structures = tables.read_joined(files.structures)
    random = pd.concat([structures, tables.read_joined(files.random)], ignore_index=True)
    likelihood = Likelihood.of(read_claims(files.claims).claims, random)
    judge = dynamic_judge(params.case, ltca, files.claims, fitted_at_speed, QUICK)
    drawn = plausible_inputs(section, "structures", params.case, ltca)
    before = tables.read_joined(files.before, allow_empty=True) if files.before else None
    pattern, first = start_at(place, repeat, drawn, likelihood, structures, before, budget)
    partial = Path(snakemake.output.evaluations).with_suffix(".partial")
    deciding = likelihood.surprise.tolist(), first.tolist(), pattern
    same = identity(judge.deciding, params.identify, deciding, params.code)
    progress = Progress(f"search {pattern}", len(first) * (budget.generations + 1) * budget.starts)
    found = search_pattern(
        judge, likelihood, drawn.space, pattern, first, budget, repeat, partial, same, progress.step
    )
    tables.write(snakemake.output.evaluations, found)
    partial.unlink()
    best = f"{len(found)} motions, log-likelihood of inputs at most {found[LOG_LIKELIHOOD].max():.1f}"
    run.summary(f"{pattern}: {best}" if pattern else "no pattern goes on at this place")
