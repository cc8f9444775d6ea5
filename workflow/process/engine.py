"""The names of Snakemake that it does not promise to keep: asked for here alone, each with a fallback.

Found in Snakemake 9.27. Where a name is missing a run does more work or prints more, but it works.
"""

import subprocess
import sys
from collections.abc import Callable, Iterable, Mapping
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any


@dataclass(frozen=True)
class Script:
    """A Python script that Snakemake has written for a job.

    - file: its path
    - temporary: folder for temporary files, empty for that of the run
    - watched: measures a process by its number, for the job's benchmark
    """

    rule: str
    file: str
    threads: int
    temporary: str
    watched: Callable[[int], AbstractContextManager[Any]]


def write_parameters_without_pandas() -> bool:
    """Spare every start the import of pandas, 0.5 s, by which Snakemake asks whether a parameter is a table.

    None is here. Returns whether Snakemake still writes parameters that way; else it goes on as it likes.
    """
    try:
        persistence = import_module("snakemake.persistence").PersistenceBase
        persistence._serialize_param = persistence._serialize_param_builtin
    except (ImportError, AttributeError):
        return False
    return True


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
        benchmarked = import_module("snakemake.benchmark").benchmarked
        start_python = scripts.execute_script
    except (ImportError, AttributeError):
        return False

    def execute_script(job: Any, file: str, *given: Any, **named: Any) -> None:
        script = _plain_script(job, file, benchmarked)
        code = run(script) if script else None
        if code is None:
            start_python(job, file, *given, **named)
        elif code:
            raise subprocess.CalledProcessError(code, [sys.executable, file])

    scripts.execute_script = execute_script
    return True


def _plain_script(job: Any, file: str, benchmarked: Callable[..., Any]) -> Script | None:
    """The script of a job that runs in the environment of the run. Without an answer: none."""
    try:
        if job.container_img or job.conda_env or job.env_modules or job.shadow_dir:
            return None
        record = job.bench_record
        return Script(
            job.rulename,
            file,
            job.threads,
            job.resources.get("tmpdir") or "",
            (lambda process: benchmarked(process, record)) if record else lambda process: nullcontext(),
        )
    except AttributeError:
        return None


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
