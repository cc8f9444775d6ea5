"""Search for the most likely inputs under one pattern of e(t)."""

from pathlib import Path

import pandas as pd

from facegear.config.base import parse
from facegear.contact.columns import LTCA_COLUMNS
from facegear.io import tables
from facegear.paper.config.search import plausible_inputs
from facegear.paper.config.sections import Identify
from facegear.paper.identify.claim_judge import QUICK
from facegear.paper.identify.likelihood import Likelihood
from facegear.paper.identify.random_verdicts import dynamic_judge, fitted_at_speed
from facegear.paper.identify.search import LOG_LIKELIHOOD, Budget, first_points, search_pattern
from facegear.paper.scorecard.claims import read_claims
from facegear.progress import Progress
from facegear.provenance.stage import stage
from facegear.scenarios.chunks import identity

with stage(snakemake) as run:
    files, params, pattern = snakemake.input, snakemake.params, snakemake.wildcards.pattern.replace("-", "/")
    section = parse(Identify, params.identify)
    ltca = tables.read(files.ltca, LTCA_COLUMNS)
    random = pd.concat([tables.read(path) for path in files.structures], ignore_index=True)
    likelihood = Likelihood.of(read_claims(files.claims).claims, random)
    judge = dynamic_judge(params.case, ltca, files.claims, fitted_at_speed, QUICK)
    drawn = plausible_inputs(section, "structures", params.case, ltca)
    size, budget = section.search.population, Budget(section.search.generations, section.search.seed)
    judged = random.copy().assign(**{LOG_LIKELIHOOD: likelihood(random)})
    before = [judged, *map(tables.read, files.before)] if files.before else []
    first = first_points(drawn, before, pattern, size)
    partial = Path(snakemake.output.evaluations).with_suffix(".partial")
    same = identity(judge.deciding, params.identify, first.tolist(), params.code)
    told = Progress(f"search {pattern}", size * (budget.generations + 1)).step
    found = search_pattern(judge, likelihood, drawn.space, pattern, first, budget, partial, same, told)
    tables.write(snakemake.output.evaluations, found)
    partial.unlink()
    best = found.loc[found[LOG_LIKELIHOOD].idxmax()]
    torque = best["per_input_n_m"]
    run.summary(f"{len(found)} evaluations, log-likelihood {best[LOG_LIKELIHOOD]:.1f} at {torque:.0f} N m")
