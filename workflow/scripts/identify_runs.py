"""Which claims a set of inputs holds in runs that differ by rounding and start."""

from pathlib import Path

from facegear.config.base import parse
from facegear.contact.columns import LTCA_FINITE
from facegear.io import tables
from facegear.paper.config.sections import Identify
from facegear.paper.identify.cases import settings_key
from facegear.paper.identify.claim_judge import ClaimJudge
from facegear.paper.identify.repeated import one_run, run_columns, run_table
from facegear.paper.identify.sets import set_cases, stored_sets
from facegear.paper.scorecard.claims import read_claims
from facegear.paper.scorecard.rows import OWN
from facegear.progress import Progress
from facegear.provenance.stage import stage
from facegear.scenarios.chunks import identity, run_chunk

with stage(snakemake) as run:
    name, params = snakemake.wildcards.set, snakemake.params
    row = None if name == OWN else stored_sets(snakemake.input.sets)[name]
    ltca = tables.read(snakemake.input.ltca, LTCA_FINITE)
    claims = [claim for claim in read_claims(snakemake.input.claims).claims if claim.dynamic]
    judge = ClaimJudge(params.case, ltca, claims)
    section = parse(Identify, params.identify)
    partial = Path(snakemake.output.runs).with_suffix(".partial")
    starts = params.case["load_sharing"]["starts"]
    same = identity(judge.deciding, row, section.swept_runs, params.code)
    progress = Progress(f"runs of set {name}", section.runs)
    columns = run_columns(judge.names)
    evaluate = one_run(judge, row, section.swept_runs, starts)
    found = run_chunk(evaluate, range(section.runs), columns, partial, same, progress.step)
    table = run_table(name, found, judge.names, settings_key(*set_cases(params.case, row)))
    tables.write(snakemake.output.runs, table)
    partial.unlink()
    split = int(((table["held"] > 0) & (table["held"] < table["runs"])).sum())
    always = int((table["held"] == table["runs"]).sum())
    run.summary(f"set {name}: {always} of {len(table)} claims hold in all runs, {split} in some")
