"""The region of likely inputs at full accuracy, from several starts, without a speed sweep."""

from pathlib import Path

from facegear.config.base import parse
from facegear.contact.columns import LTCA_FINITE
from facegear.io import tables
from facegear.paper.config.sections import Identify
from facegear.paper.identify.claim_judge import ONE_MOTION
from facegear.paper.identify.confirmed import accurate_region
from facegear.paper.identify.likelihood import Likelihood
from facegear.paper.identify.motions import distinct_inputs
from facegear.paper.identify.random_verdicts import dynamic_judge, unswept
from facegear.paper.identify.region import LOG_UNITS, most_likely
from facegear.paper.scorecard.claims import read_claims
from facegear.progress import Progress
from facegear.provenance.stage import stage
from facegear.scenarios.chunks import identity

with stage(snakemake) as run:
    files, params = snakemake.input, snakemake.params
    ltca = tables.read(files.ltca, LTCA_FINITE)
    random = tables.read_joined([*files.structures, *files.random])
    likelihood = Likelihood.of(read_claims(files.claims).claims, random)
    judge = dynamic_judge(params.case, ltca, files.claims, unswept, ONE_MOTION)
    region = tables.read(files.region)
    partial = Path(snakemake.output.judged).with_suffix(".partial")
    starts = parse(Identify, params.identify).search.starts
    same = identity(judge.deciding, region.to_csv(), starts, params.code)
    progress = Progress("region at full accuracy", len(distinct_inputs(region)) * starts)
    found = accurate_region(judge, likelihood, region, starts, partial, same, progress.step)
    tables.write(snakemake.output.judged, found)
    partial.unlink()
    inputs = distinct_inputs(found)
    kept = most_likely(inputs, LOG_UNITS)
    run.summary(f"{len(kept)} of {len(inputs)} inputs within {LOG_UNITS:g} log units of the best of them")
