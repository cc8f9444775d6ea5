"""An account of the jobs that work, and what becomes of those of a killed run that finished by themselves."""

import json
import logging
import os
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from facegear.io.checksums import MANIFEST_SUFFIX, sha256
from workflow.process.engine import event_of, jobs_are_elsewhere, keep, planned_jobs

STARTED = Path(".snakemake/facegear_jobs")
"""One file a job that has begun and is not known to have ended, with the names of its outputs."""


class Jobs(logging.Handler):
    """Keeps account of the jobs that work, for the next run should this one be killed.

    A job on another computer writes what it found to its log alone: its last line is printed at its end.
    """

    def __init__(self, workflow: Any) -> None:
        super().__init__()
        self.workflow = workflow
        self.logs: dict[int, list[str]] = {}

    def emit(self, record: Any) -> None:
        """Note that a job has begun or ended."""
        event = event_of(record)
        if event == "JOB_INFO":
            self.logs[record.jobid] = record.log
            STARTED.mkdir(parents=True, exist_ok=True)
            (STARTED / str(record.jobid)).write_text("\n".join(record.output))
        elif event in ("JOB_FINISHED", "JOB_ERROR"):
            number = record.job_id if event == "JOB_FINISHED" else record.jobid
            (STARTED / str(number)).unlink(missing_ok=True)
            logs = self.logs.pop(number, [])
            if jobs_are_elsewhere(self.workflow):
                print_last_lines(logs)


def print_last_lines(logs: Iterable[str]) -> None:
    """The last lines of logs that another computer may have written."""
    for log in map(Path, logs):
        lines = log.read_text(errors="replace").splitlines() if log.is_file() else []
        print(*lines[-1:], sep="\n", file=sys.stderr, flush=True)


def settle(workflow: Any) -> bool:
    """Keep what jobs of a killed run have finished by themselves, if they would do so today; drop the rest.

    Snakemake knows nothing of such files and would keep them whatever has changed. Returns whether some were
    dropped.
    """
    marks = [*STARTED.glob("*")]
    names = {name for mark in marks for name in mark.read_text().splitlines() if Path(name).exists()}
    for job in planned_jobs(workflow) if names else ():
        own = {str(output) for output in job.output}
        if names & own and is_current(job) and keep(workflow, job):
            names -= own
    for path in [*map(Path, names), *marks]:
        path.unlink()
    return bool(names)


def is_current(job: Any) -> bool:
    """Whether the outputs of a job are what its manifest says, made from its inputs, code and values."""
    (manifest,) = [Path(path) for path in job.output if path.endswith(MANIFEST_SUFFIX)]
    others = [path for path in job.output if path != str(manifest)]
    try:
        stored = json.loads(manifest.read_text())
        inputs = {os.path.relpath(path, manifest.parent): sha256(path) for path in job.input}
        outputs = {Path(path).name: sha256(path) for path in others}
        known = (
            {**stored["params"], "code": stored["code"]},
            stored["inputs"],
            {name: file["sha256"] for name, file in stored["files"].items()},
        )
    except (OSError, ValueError, KeyError, TypeError):
        return False
    params = json.loads(json.dumps(dict(job.params.items())))
    return known == (params, inputs, outputs)
