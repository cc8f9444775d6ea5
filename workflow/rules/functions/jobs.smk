import json
from snakemake_interface_logger_plugins.common import LogEvent

from facegear.io.checksums import MANIFEST_SUFFIX, sha256

STARTED = Path(".snakemake/facegear_jobs")
"""One file a job that has begun and is not known to have ended, with the names of its outputs."""


class Jobs(logging.Handler):
    """Keeps account of the jobs that work, for the next run should this one be killed.

    A job on another computer tells what it found to its log alone: the last line of that is told here at its end.
    """

    def __init__(self):
        super().__init__()
        self.logs = {}

    def emit(self, record):
        event = getattr(record, "event", None)
        if event == LogEvent.JOB_INFO:
            self.logs[record.jobid] = record.log
            STARTED.mkdir(exist_ok=True)
            (STARTED / str(record.jobid)).write_text("\n".join(record.output))
        elif event in (LogEvent.JOB_FINISHED, LogEvent.JOB_ERROR):
            number = record.job_id if event == LogEvent.JOB_FINISHED else record.jobid
            (STARTED / str(number)).unlink(missing_ok=True)
            tell(self.logs.pop(number, []) if workflow.non_local_exec else [])


def tell(logs):
    """The last lines of logs that another computer may have written."""
    for log in map(Path, logs):
        lines = log.read_text(errors="replace").splitlines() if log.is_file() else []
        print(*lines[-1:], sep="\n", file=sys.stderr, flush=True)


def settle():
    """Keep what jobs of a killed run have finished by themselves, if they would do the same today; drop the rest.

    Snakemake knows nothing of such files and would keep them whatever has changed. Returns whether there were any.
    """
    marks = [*STARTED.glob("*")]
    names = {name for mark in marks for name in mark.read_text().splitlines() if Path(name).exists()}
    for job in workflow.persistence.dag.jobs if names else ():
        if names.intersection(map(str, job.output)) and is_current(job):
            workflow.async_run(workflow.persistence.finished(job))
            names.difference_update(map(str, job.output))
    for path in [*names, *marks]:
        Path(path).unlink()
    return bool(names)


def is_current(job):
    """Whether the outputs of a job are what its manifest says, made from its inputs, by its code and values."""
    (manifest,) = [Path(path) for path in job.output if path.endswith(MANIFEST_SUFFIX)]
    others = [path for path in job.output if path != str(manifest)]
    try:
        told = json.loads(manifest.read_text())
        inputs = {os.path.relpath(path, manifest.parent): sha256(path) for path in job.input}
        outputs = {Path(path).name: sha256(path) for path in others}
    except (OSError, ValueError):
        return False
    params = json.loads(json.dumps(dict(job.params.items())))
    known = (
        {**told["params"], "code": told["code"]},
        told["inputs"],
        {name: file["sha256"] for name, file in told["files"].items()},
    )
    return known == (params, inputs, outputs)
