"""What a run prints to the terminal, and how Ctrl-C ends it."""

import atexit
import logging
import os
import signal
import sys
import threading
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import psutil

from workflow.process.engine import is_run, shows_all, terminal_handlers


class Quiet(logging.Filter):
    """Of Snakemake's own lines a run shows warnings and errors; each stage says what it found itself."""

    def __init__(self, workflow: Any) -> None:
        super().__init__()
        self.workflow, self.stopping = workflow, False

    def filter(self, record: logging.LogRecord) -> bool:
        """Whether a line is shown; none is while the run is being stopped."""
        if self.stopping:
            return False
        if shows_all(self.workflow):
            return True
        return record.levelno >= logging.WARNING or "Nothing to be done" in record.getMessage()


def quieten(workflow: Any, logger: logging.Logger) -> Quiet:
    """Hold back what Snakemake prints to the terminal of a run; its log file keeps all of it."""
    quiet = Quiet(workflow)
    for handler in terminal_handlers(logger) if is_run(workflow) else ():
        handler.addFilter(quiet)
    return quiet


def stop_at_once(quiet: Quiet) -> None:
    """End all jobs and this run with one line as soon as Ctrl-C is pressed.

    The jobs inherit that the signal is blocked, so that none of them prints a traceback of its own. It
    reaches this process by the thread that waits for it, or by one that was there before and does not block
    it. Snakemake, which finds its jobs killed, would end the run as a failed one: it is held until the thread
    has ended all.
    """
    if not hasattr(signal, "pthread_sigmask"):
        return
    # When a job has failed Snakemake leaves the folder of the run, and the working directory with it.
    results = Path("results").absolute()
    atexit.register(_hold_where_stopping, quiet)
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    reads, writes = os.pipe()
    os.set_blocking(writes, False)
    signal.set_wakeup_fd(writes, warn_on_full_buffer=False)
    signal.signal(signal.SIGINT, lambda number, frame: None)
    for wait in (lambda: signal.sigwait({signal.SIGINT}), lambda: _read_interrupt(reads)):
        threading.Thread(target=_end_after, args=(wait, quiet, results), daemon=True).start()


def _hold_where_stopping(quiet: Quiet) -> None:
    if quiet.stopping:
        threading.Event().wait()


def _read_interrupt(reads: int) -> None:
    while os.read(reads, 1)[0] != signal.SIGINT:
        pass


def _end_after(wait: Callable[[], object], quiet: Quiet, results: Path) -> None:
    wait()
    quiet.stopping = True
    try:
        end_jobs(results)
    finally:
        print("stopped; the same command goes on from here", file=sys.stderr, flush=True)
        os._exit(130)


def end_jobs(results: Path) -> None:
    """Kill all processes that this one has started, and remove the files that they had begun."""
    for _ in range(3):  # a job may have begun while others were ended
        jobs = halted_jobs()
        for job in jobs:
            with suppress(psutil.NoSuchProcess):
                job.kill()
        psutil.wait_procs(jobs, timeout=2)
        remove_begun(results, [job.pid for job in jobs])


def halted_jobs() -> list[psutil.Process]:
    """All processes started by this one, stopped: one killed while it starts another leaves that behind."""
    known: dict[int, psutil.Process] = {}
    while begun := [job for job in psutil.Process().children(recursive=True) if job.pid not in known]:
        for job in begun:
            with suppress(psutil.NoSuchProcess):
                job.suspend()
            known[job.pid] = job
    return list(known.values())


def remove_begun(results: Path, processes: list[int]) -> None:
    """Remove the temporary files below `results` that processes of these numbers were writing."""
    begun = tuple(f".{number}." for number in processes)
    for folder, _, names in os.walk(results):  # Snakemake removes folders at the same time
        for name in names:
            if begun and name.startswith(begun):
                Path(folder, name).unlink(missing_ok=True)
