"""What a killed run of this folder has left working, on this computer or in Slurm's queue."""

import os
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path

import psutil

from facegear.errors import FacegearError
from workflow.process.forked_jobs import SERVER

PATIENCE = 60.0
"""Seconds that a scheduler may take to end jobs."""
SLURM_LOGS = Path(".snakemake/slurm_logs")
"""Where the output of a folder's jobs goes under Slurm."""


def end_orphans() -> bool:
    """End what a killed run of this folder left working, so that no job is made by two at once.

    Called with the run's lock held: whatever else works on jobs of this folder belongs to a run that is dead.
    Returns whether there was anything. Raises FacegearError where something does not end.
    """
    own = psutil.Process().children(recursive=True)
    processes = [process for process in psutil.process_iter() if _is_orphan(process, own)]
    for process in processes:
        with suppress(psutil.NoSuchProcess):
            process.kill()
    jobs = _slurm_jobs()
    if processes or jobs:
        print("ending jobs that a killed run has left working", file=sys.stderr)
        _cancel(jobs)
    if psutil.wait_procs(processes, timeout=PATIENCE)[1]:
        raise FacegearError("processes of a killed run do not end; stop them first")
    return bool(processes or jobs)


def _is_orphan(process: psutil.Process, own: list[psutil.Process]) -> bool:
    """Whether a process is a job of a local run, its script, or a server of scripts that is not our own."""
    try:
        if process.uids().real != os.getuid() or process.cwd() != os.getcwd():
            return False
        words = process.cmdline()
    except (psutil.Error, OSError):
        return False
    inner = words[1:3] == ["-m", "snakemake"] and "subprocess" in words
    server = tuple(words[1 : 1 + len(SERVER)]) == SERVER and process not in own
    return inner or server or any("/.snakemake/scripts/" in word for word in words[:3])


def _cancel(jobs: list[str]) -> None:
    if jobs:
        subprocess.run(["scancel", *jobs], check=False)
    end = time.monotonic() + PATIENCE
    while jobs and _slurm_jobs():
        if time.monotonic() > end:
            raise FacegearError(f"jobs {', '.join(jobs)} of a killed run do not end; scancel them first")
        time.sleep(0.5)


def _slurm_jobs() -> list[str]:
    """Numbers of the jobs in Slurm's queue that runs in this folder have submitted."""
    logs = SLURM_LOGS.absolute()
    if not logs.exists():
        return []
    command = ["squeue", "--me", "--noheader", "--Format", "JobArrayID:40,STDOUT:4000"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        raise FacegearError(
            f"squeue does not answer, and a killed run may have left jobs working (if not, remove {logs}): "
            + done.stderr.strip()
        )
    rows = [line.split(maxsplit=1) for line in done.stdout.splitlines()]
    return [row[0] for row in rows if len(row) == 2 and row[1].startswith(f"{logs}/")]
