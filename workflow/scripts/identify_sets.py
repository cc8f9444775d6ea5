"""The sets of inputs that the repository stores: the most likely ones, confirmed at full accuracy."""

from pathlib import Path

from facegear.config.base import parse
from facegear.contact.columns import LTCA_FINITE
from facegear.io import tables
from facegear.paper.config.sections import Identify
from facegear.paper.identify.claim_judge import ONE_MOTION
from facegear.paper.identify.confirmed import confirmed_inputs, kept_sets
from facegear.paper.identify.likelihood import Likelihood
from facegear.paper.identify.motions import distinct_inputs
from facegear.paper.identify.random_verdicts import dynamic_judge, unswept
from facegear.paper.scorecard.claims import read_claims
from facegear.progress import Progress
from facegear.provenance.stage import stage
from facegear.scenarios.chunks import identity

with stage(snakemake) as run:
    files, output, params = snakemake.input, snakemake.output, snakemake.params
    section = parse(Identify, params.identify).search
    ltca = tables.read(files.ltca, LTCA_FINITE)
    random = tables.read_joined([*files.structures, *files.random])
    likelihood = Likelihood.of(read_claims(files.claims).claims, random)
    judge = dynamic_judge(params.case, ltca, files.claims, unswept, ONE_MOTION)
    region = distinct_inputs(tables.read(files.region)).head(section.confirmed)  # the most likely come first
    partial = Path(output.sets).with_suffix(".partial")
    same = identity(judge.deciding, region.to_csv(), section.runs, params.code)
    progress = Progress("confirming at full accuracy", len(region) * section.runs)
    found = confirmed_inputs(judge, likelihood, region, section.runs, partial, same, progress.step)
    sets = kept_sets(found, section.sets)
    tables.write(output.confirmed, found)
    tables.write(output.sets, sets)
    partial.unlink()
    run.summary(f"{len(sets)} sets; recommended {sets['pattern'][0]}, {sets['per_input_n_m'][0]:.0f} N m")
