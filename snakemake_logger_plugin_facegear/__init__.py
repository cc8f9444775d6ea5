"""Logger plugin of Snakemake that leaves one line for each stage of a run: `snakemake --logger facegear`.

A stage prints its own line. Of Snakemake's messages this plugin prints warnings, errors, and the last line
of the log of a job that ran on another computer, where the stage's line is not seen.
See https://snakemake.github.io/snakemake-plugin-catalog for how Snakemake finds and calls such a plugin.
"""

import logging
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from snakemake_interface_logger_plugins.base import LogHandlerBase
from snakemake_interface_logger_plugins.common import LogEvent

HIDDEN = {
    LogEvent.WORKFLOW_STARTED,
    LogEvent.RUN_INFO,
    LogEvent.RESOURCES_INFO,
    LogEvent.JOB_INFO,
    LogEvent.JOB_STARTED,
    LogEvent.GROUP_INFO,
    LogEvent.SHELLCMD,
    LogEvent.PROGRESS,
}
"""Events of a run that say nothing about its results."""
ROUTINE = (
    "Assuming unrestricted shared filesystem usage",
    "Building DAG of jobs",
    "Complete log(s)",
    "Conda environments: ignored",
    "Elapsed time",
    "Select jobs to execute",
    "Shutting down",
    "Exiting because a job execution failed",
    "Submitted job",
    "Terminating processes on user request",
    "Using shell",
)
"""Openings of messages without an event that every run prints. A message that is reworded is shown."""

FAILED = "At least one job did not complete successfully"
"""Part of the last message of a run that has failed; the workflow's own last line says so, too."""
EXPLAINED = "error in "
"""Opening of the line with which a stage says why it failed."""


class LogHandler(LogHandlerBase):
    """Print warnings and errors of Snakemake, and what jobs on other computers found.

    A dry run and `--verbose` show what Snakemake shows by itself.
    """

    def __post_init__(self) -> None:
        self.jobs: dict[int, Any] = {}
        self.stopped = False

    def emit(self, record: logging.LogRecord) -> None:
        """Print one record, or nothing."""
        try:
            text = self.text(record)
            if text:
                print(text, file=sys.stdout if self.common_settings.stdout else sys.stderr, flush=True)
        except Exception:
            self.handleError(record)

    def text(self, record: Any) -> str:
        """Return what is printed for a record."""
        if self.common_settings.dryrun or self.common_settings.verbose:
            return self.format(record)
        event = getattr(record, "event", None)
        if event == LogEvent.JOB_INFO:
            self.jobs[record.jobid] = record
        elif event == LogEvent.JOB_FINISHED:
            job = self.jobs.pop(record.job_id, None)
            return "" if job is None or job.local else last_line(job.log)
        elif event == LogEvent.JOB_ERROR:
            return self.error(record)
        elif event == LogEvent.ERROR and getattr(record, "exception", "") == "RuleException":
            return ""  # the exit code of a script, whose own line follows as the error of its job
        message = record.getMessage()
        if FAILED in message:
            return ""
        self.stopped |= message.startswith("Terminating processes on user request")
        routine = event in HIDDEN or (record.levelno < logging.WARNING and message.startswith(ROUTINE))
        return "" if routine else self.format(record)

    def error(self, record: Any) -> str:
        """Return why a job failed; nothing if the user has stopped the run, which ends all its jobs."""
        job = self.jobs.pop(record.jobid, None)
        # An executor adds its own log of the job, which ends in words of Snakemake.
        explained = [line for log in record.log if (line := last_line([log])).startswith(EXPLAINED)]
        if explained:
            return "" if job is None or job.local else explained[0]
        return "" if self.stopped else f"rule {record.rule_name} failed (log: {', '.join(record.log)})"

    @property
    def writes_to_stream(self) -> bool:
        """Replace Snakemake's own output to the terminal."""
        return True

    @property
    def writes_to_file(self) -> bool:
        """Leave Snakemake's log file as it is."""
        return False

    @property
    def has_filter(self) -> bool:
        """Let Snakemake filter by `--quiet`."""
        return False

    @property
    def has_formatter(self) -> bool:
        """Let Snakemake format what is shown."""
        return False

    @property
    def needs_rulegraph(self) -> bool:
        """Ask for no graph of the rules."""
        return False


def last_line(logs: Sequence[str]) -> str:
    """Return the last line of the logs of a job, which may have run on another computer."""
    lines = [
        line
        for log in map(Path, logs)
        if log.is_file()
        for line in log.read_text(encoding="utf-8", errors="replace").splitlines()
    ]
    return lines[-1] if lines else ""
