"""The names of Snakemake that it does not promise to keep: asked for here alone, each with a fallback.

Found in Snakemake 9.27. Where a name is missing a run does more work or prints more, but it works.
"""

from collections.abc import Iterable, Mapping
from importlib import import_module
from pathlib import Path
from typing import Any


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
