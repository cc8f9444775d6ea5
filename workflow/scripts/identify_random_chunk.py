"""Which claims a chunk of random inputs holds."""

from pathlib import Path

from facegear.config.base import parse
from facegear.contact.columns import LTCA_FINITE
from facegear.io import tables
from facegear.paper.config.search import plausible_inputs
from facegear.paper.config.sections import Identify, sample_numbers
from facegear.paper.identify.claim_judge import GEOMETRIC, QUICK
from facegear.paper.identify.random_verdicts import dynamic_judge, judged_samples, unswept
from facegear.progress import Progress
from facegear.provenance.stage import stage
from facegear.scenarios.chunks import identity

with stage(snakemake) as run:
    wildcards, params = snakemake.wildcards, snakemake.params
    ltca = tables.read(snakemake.input.ltca, LTCA_FINITE)
    by_pattern = wildcards.design != "random"
    settings = {**QUICK, **(GEOMETRIC if wildcards.design == "geometric" else {})}
    kept = unswept if by_pattern else lambda claim: True
    judge = dynamic_judge(params.case, ltca, snakemake.input.claims, kept, settings)
    drawn = plausible_inputs(parse(Identify, params.identify), wildcards.design, params.case, ltca)
    numbers = sample_numbers(wildcards.design, int(wildcards.first), int(wildcards.last))
    rows = drawn.rows_by_pattern(numbers) if by_pattern else drawn.rows(numbers)
    partial = Path(snakemake.output.samples).with_suffix(".partial")
    same = identity(judge.deciding, params.identify, params.code)
    progress = Progress(f"{wildcards.design} inputs {wildcards.first} to {wildcards.last}", len(numbers))
    found = judged_samples(judge, rows, numbers, partial, same, progress.step)
    tables.write(snakemake.output.samples, found)
    partial.unlink()
    held = found[judge.names].sum(axis=1).mean()
    run.summary(f"{len(found)} random inputs hold {held:.1f} of {len(judge.names)} claims on average")
