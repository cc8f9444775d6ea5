import atexit
import logging
import os
import signal
import sys
import threading
from contextlib import suppress
from pathlib import Path

import psutil
from snakemake.logging import logger

RESULTS = Path("results").absolute()
"""Snakemake leaves the folder of a run, and this process's working directory with it, when a job has failed."""


class Quiet(logging.Filter):
    """Of Snakemake's own lines a run shows warnings and errors; each stage tells what it found itself."""

    stopping = False

    def filter(self, record):
        if self.stopping:
            return False
        works = workflow.executor_plugin is not None and not workflow.dryrun
        if not works or workflow.output_settings.verbose:
            return True
        return record.levelno >= logging.WARNING or "Nothing to be done" in record.getMessage()


QUIET = Quiet()


def quieten():
    """Hold back what Snakemake prints to the terminal; its log file keeps all of it."""
    for handler in logger.handlers:
        if handler.name == "DefaultStreamHandler":
            handler.addFilter(QUIET)


def stop_at_once():
    """End all jobs and this run with one line as soon as Ctrl-C is pressed.

    The jobs inherit that the signal is blocked, so that none of them prints a traceback of its own. It reaches this
    process by the thread that waits for it, or by one that was there before and does not block it. Snakemake, which
    finds its jobs killed, would end the run as a failed one: it is held until the thread has ended all.
    """
    if not hasattr(signal, "pthread_sigmask"):
        return
    atexit.register(_hold_where_stopping)
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    told, tells = os.pipe()
    os.set_blocking(tells, False)
    signal.set_wakeup_fd(tells, warn_on_full_buffer=False)
    signal.signal(signal.SIGINT, lambda number, frame: None)
    threading.Thread(target=_end_after, args=(signal.sigwait, {signal.SIGINT}), daemon=True).start()
    threading.Thread(target=_end_after, args=(_read_interrupt, told), daemon=True).start()


def _hold_where_stopping():
    if QUIET.stopping:
        threading.Event().wait()


def _read_interrupt(told):
    while os.read(told, 1)[0] != signal.SIGINT:
        pass


def _end_after(wait, *arguments):
    wait(*arguments)
    QUIET.stopping = True
    try:
        _end_jobs()
    finally:
        print("stopped; the same command goes on from here", file=sys.stderr, flush=True)
        os._exit(130)


def _end_jobs():
    for _ in range(3):  # a job may have begun while others were ended
        jobs = psutil.Process().children(recursive=True)
        for job in jobs:
            with suppress(psutil.NoSuchProcess):
                job.kill()
        psutil.wait_procs(jobs, timeout=2)
        begun = tuple(f".{job.pid}." for job in jobs)
        for folder, _, names in os.walk(RESULTS):  # Snakemake removes folders at the same time
            for name in names:
                if name.startswith(begun):
                    Path(folder, name).unlink(missing_ok=True)
