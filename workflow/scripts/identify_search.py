"""Search for the most likely inputs under one pattern of e(t), the one that goes on at this place."""

from pathlib import Path

from facegear.config.base import parse
from facegear.contact.columns import LTCA_COLUMNS
from facegear.io import tables
from facegear.paper.config.search import plausible_inputs
from facegear.paper.config.sections import Identify
from facegear.paper.identify.claim_judge import QUICK
from facegear.paper.identify.likelihood import Likelihood
from facegear.paper.identify.patterns import going_on
from facegear.paper.identify.random_verdicts import dynamic_judge, fitted_at_speed
from facegear.paper.identify.search import (
    LOG_LIKELIHOOD,
    Budget,
    first_points,
    search_pattern,
    searched_again,
)
from facegear.paper.scorecard.base_rates import by_input
from facegear.paper.scorecard.claims import read_claims
from facegear.progress import Progress
from facegear.provenance.stage import stage
from facegear.scenarios.chunks import identity

with stage(snakemake) as run:
    files, params, place = snakemake.input, snakemake.params, int(snakemake.wildcards.place)
    section = parse(Identify, params.identify)
    search = section.search
    ltca = tables.read(files.ltca, LTCA_COLUMNS)
    claims = read_claims(files.claims).claims
    structures = tables.read_joined(files.structures)
    likelihood = Likelihood.of(claims, tables.read_joined([*files.structures, *files.random]))
    judge = dynamic_judge(params.case, ltca, files.claims, fitted_at_speed, QUICK)
    before = []
    if files.before:
        first_round = tables.read_joined(files.before)
        patterns = searched_again(first_round, search.again_within)
        before = [structures.copy().assign(**{LOG_LIKELIHOOD: likelihood(structures)}), first_round]
    else:
        rates = by_input(structures, claims, "pattern")
        patterns = going_on(rates, search.by_mean, search.by_upper, search.places)
    if place < len(patterns):
        pattern, budget = patterns[place], Budget(search.generations, search.seed)
        drawn = plausible_inputs(section, "structures", params.case, ltca)
        first = first_points(drawn, before, pattern, search.population)
        partial = Path(snakemake.output.evaluations).with_suffix(".partial")
        same = identity(
            judge.deciding,
            params.identify,
            pattern,
            likelihood.surprise.tolist(),
            first.tolist(),
            params.code,
        )
        told = Progress(f"search {pattern}", search.population * (budget.generations + 1)).step
        found = search_pattern(judge, likelihood, drawn.space, pattern, first, budget, partial, same, told)
        tables.write(snakemake.output.evaluations, found)
        partial.unlink()
        best = found.loc[found[LOG_LIKELIHOOD].idxmax()]
        torque, highest = best["per_input_n_m"], best[LOG_LIKELIHOOD]
        run.summary(f"{pattern}: {len(found)} evaluations, log-likelihood {highest:.1f} at {torque:.0f} N m")
    else:
        tables.write(snakemake.output.evaluations, structures.head(0))
        run.summary(f"no pattern goes on at this place: {len(patterns)} do")
