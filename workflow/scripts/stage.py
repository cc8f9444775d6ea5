"""One stage: what it takes from files, its call, what it gives to files."""

from importlib import import_module
from pathlib import Path

from facegear.pipeline.run import call, read_all, write_stage
from facegear.provenance.stage import stage

with stage(snakemake) as run:
    # Not imported above, where it would count as code of every rule: a new row makes no other stage again.
    stages = import_module("facegear.pipeline.table").STAGES
    row, params, output = stages[snakemake.rule], snakemake.params, dict(snakemake.output.items())
    given = {**read_all(row.upstream, snakemake.input, stages), **params.needs}
    wildcards = {name: snakemake.wildcards[name] for name in row.wildcards}
    partial = Path(output[row.resumable]).with_suffix(".partial") if row.resumable else None
    resumed = {"partial": partial, "code": params.code} if partial else {}
    outcome = call(row, given, **row.typed(wildcards), **resumed)
    write_stage(row, outcome.content, output)
    if partial:
        partial.unlink()
    run.summary(outcome.summary)
