"""One stage, for a case or for several cases of studies: read, call, write."""

import signal
from importlib import import_module
from pathlib import Path

signal.signal(signal.SIGINT, signal.SIG_DFL)  # before long imports: Ctrl-C ends a job without a traceback

from facegear.pipeline.provenance.stage import job, parts_of, record_part

with job(snakemake):
    from facegear.pipeline.run import call, read_all, write_stage

    # Not imported by name, where it would count as code of every rule: a new row makes no other stage again.
    stages = import_module("facegear.pipeline.table").STAGES
    row, code = stages[snakemake.params.stage], snakemake.params.code
    wildcards = {name: snakemake.wildcards[name] for name in row.wildcards}
    for part in parts_of(snakemake):
        with record_part(part) as run:
            arguments = {**read_all(row.upstream, part.input, stages), **part.params["needs"]}
            partial = Path(part.output[row.resumable]).with_suffix(".partial") if row.resumable else None
            resume_options = {"partial": partial, "code": code} if partial else {}
            outcome = call(row, arguments, **row.typed_wildcards(wildcards), **resume_options)
            write_stage(row, outcome.content, part.output)
            if partial:
                partial.unlink()
            run.summary(outcome.summary)
