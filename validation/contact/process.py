"""Program in a process of its own: its output in a log, its time and its largest memory."""

import os
import subprocess
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from threading import Timer


@dataclass(frozen=True)
class ProcessResult:
    """Exit code, wall and processor time (s) and largest memory (GB) of a process and what it started."""

    code: int
    seconds: float
    cpu_seconds: float
    gigabytes: float


def run_alone(
    command: Sequence[str], folder: Path, log: Path, environment: Mapping[str, str], timeout: float
) -> ProcessResult:
    """Run a command in a folder until it ends, or is ended.

    Parameters
    ----------
    command : Sequence[str]
        Program and its arguments.
    folder : Path
        Working directory.
    log : Path
        Path of the log.
    environment : Mapping[str, str]
        Environment variables.
    timeout : float
        Time after which it is ended, s.

    Returns
    -------
    ProcessResult
        Exit code and costs.
    """
    start = time.perf_counter()
    with open(log, "w", encoding="utf-8") as output:
        process = subprocess.Popen(
            command, cwd=folder, env=dict(environment), stdout=output, stderr=subprocess.STDOUT
        )
        limit = Timer(timeout, process.kill)
        limit.start()
        # subprocess does not say what a single child used
        _, status, usage = os.wait4(process.pid, 0)
        limit.cancel()
    process.returncode = os.waitstatus_to_exitcode(status)
    return ProcessResult(
        code=process.returncode,
        seconds=time.perf_counter() - start,
        cpu_seconds=usage.ru_utime + usage.ru_stime,
        gigabytes=usage.ru_maxrss * 1024 / 1e9,
    )
