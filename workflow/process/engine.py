"""The names of Snakemake that it does not promise to keep: asked for here alone, each with a fallback.

Found in Snakemake 9.27. Where a name is missing a run does more work or prints more, but it works.
"""

import subprocess
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

RECORDED = {"running_time", "cpu_time", "cpu_usage", "max_rss", "io_in", "io_out", "data_collected"}
"""What is written to the record of a benchmark."""


@dataclass(frozen=True)
class Used:
    """What a process has used: processor (s), memory at most, data read from and written to disks (bytes)."""

    processor: float
    memory: float
    read: float
    written: float


@dataclass(frozen=True)
class Script:
    """A Python script that Snakemake has written for a job.

    - file: its path
    - temporary: folder for temporary files, empty for that of the run
    - watched: around the life of a process, given by its number; takes what it has used, for its benchmark
    """

    rule: str
    file: str
    threads: int
    temporary: str
    watched: Callable[[int], AbstractContextManager[Callable[[Used], None]]]


def write_parameters_without_pandas() -> bool:
    """Spare a run the import of pandas, 0.5 s, by which Snakemake asks whether a parameter is a table.

    None is here. Returns whether Snakemake still writes parameters that way; else it goes on as it likes.
    """
    try:
        persistence = import_module("snakemake.persistence").PersistenceBase
        plainly = persistence._serialize_param_builtin
        scripts = import_module("snakemake.iocontainers").Snakemake
    except (ImportError, AttributeError):
        return False
    if not hasattr(scripts, "_safely_store_params"):
        return False
    persistence._serialize_param, scripts._safely_store_params = plainly, _store_parameters
    return True


def _store_parameters(script: Any, params: Any) -> None:
    script._params_store, script._params_types = type(params)(toclone=list(params)), {}
    script._params_store._take_names(params._get_names())


def is_run(workflow: Any) -> bool:
    """Whether this process is the one a user started, no job of it. Without an answer: it is not."""
    return getattr(getattr(workflow, "exec_mode", None), "name", None) == "DEFAULT"


def shows_all(workflow: Any) -> bool:
    """Whether a user is shown every line: of a dry run, a listing, or on request. Without an answer: yes."""
    try:
        works = workflow.executor_plugin is not None and not workflow.dryrun
        return not works or bool(workflow.output_settings.verbose)
    except AttributeError:
        return True


def jobs_are_elsewhere(workflow: Any) -> bool:
    """Whether jobs run on other computers. Without an answer: they do not."""
    return bool(getattr(workflow, "non_local_exec", False))


def works_here(workflow: Any) -> bool:
    """Whether this is a run that makes files by jobs on this computer. Without an answer: it is not."""
    settings = getattr(getattr(workflow, "executor_plugin", None), "common_settings", None)
    here = getattr(settings, "local_exec", False)
    idle = getattr(settings, "dryrun_exec", True) or getattr(settings, "touch_exec", True)
    return is_run(workflow) and here and not idle


def before_planning(workflow: Any, begin: Callable[[], None]) -> bool:
    """Have `begin` called in a run that works here before it plans its jobs; whether it will be."""
    plan = getattr(workflow, "_build_dag", None)
    if plan is None:
        return False

    def begin_and_plan(*given: Any, **named: Any) -> Any:
        if works_here(workflow):
            begin()
        return plan(*given, **named)

    workflow._build_dag = begin_and_plan
    return True


def run_scripts_by(run: Callable[[Script], int | None]) -> bool:
    """Have Python scripts run by a function that gives their exit code; whether they are.

    Where it gives None, or the job asks for an environment of its own, Snakemake starts Python as ever.
    """
    try:
        scripts = import_module("snakemake.script").PythonScript
        start_python = scripts.execute_script
    except (ImportError, AttributeError):
        return False

    def execute_script(job: Any, file: str, *given: Any, **named: Any) -> None:
        script = _plain_script(job, file)
        code = run(script) if script else None
        if code is None:
            start_python(job, file, *given, **named)
        elif code:
            raise subprocess.CalledProcessError(code, [sys.executable, file])

    scripts.execute_script = execute_script
    return True


def _plain_script(job: Any, file: str) -> Script | None:
    """The script of a job that runs in the environment of the run. Without an answer: none."""
    try:
        if job.container_img or job.conda_env or job.env_modules or job.shadow_dir:
            return None
        record = job.bench_record
        if record and not all(hasattr(record, name) for name in RECORDED):
            return None
        return Script(
            job.rulename,
            file,
            job.threads,
            job.resources.get("tmpdir") or "",
            lambda process: _measured(record) if record else nullcontext(lambda used: None),
        )
    except AttributeError:
        return None


@contextmanager
def _measured(record: Any) -> Iterator[Callable[[Used], None]]:
    """Fill the record of a benchmark with the time until the end, and with what the process has used then.

    Snakemake would look at the process every half second, which takes some hundredths of a core, and would
    miss what happens after its last look. How much of its memory the process shares with others is not said.
    """

    def note(used: Used) -> None:
        record.cpu_time, record.cpu_usage = used.processor, 100 * used.processor
        record.max_rss, record.io_in, record.io_out = (
            size / 2**20 for size in (used.memory, used.read, used.written)
        )
        record.data_collected = True

    start = time.time()
    try:
        yield note
    finally:
        record.running_time = time.time() - start


def planned_jobs(workflow: Any) -> Iterable[Any]:
    """All jobs of the run. Without an answer: none, so that no file counts as made by one."""
    dag = getattr(getattr(workflow, "persistence", None), "dag", None)
    return getattr(dag, "jobs", ())


def keep(workflow: Any, job: Any) -> bool:
    """Have Snakemake take the outputs of a job as made; whether it does."""
    try:
        workflow.async_run(workflow.persistence.finished(job))
    except (AttributeError, TypeError):
        return False
    return True


def given_config(workflow: Any) -> Mapping[str, Any]:
    """Values after `--config`. Without an answer: none."""
    config: Mapping[str, Any] = getattr(getattr(workflow, "config_settings", None), "config", {})
    return config


def given_directory(workflow: Any) -> str | Path | None:
    """The folder after `--directory`. Without an answer: none."""
    directory: str | Path | None = getattr(workflow, "overwrite_workdir", None)
    return directory


def terminal_handlers(logger: Any) -> list[Any]:
    """Handlers of a logger that print to the terminal. Without an answer: none."""
    return [
        handler for handler in logger.handlers if getattr(handler, "name", None) == "DefaultStreamHandler"
    ]


def event_of(record: Any) -> str:
    """What a line of Snakemake's log is about, as `JOB_INFO`. Without an answer: nothing."""
    return str(getattr(getattr(record, "event", None), "name", ""))
