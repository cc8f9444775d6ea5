"""A process of which the jobs of a run are copies: each begins where the imports of all were made.

Started by `workflow.process.forked_jobs` and asked by it alone. Its code of `facegear` is that of the moment
at which the first job needed it: sources that are edited while a run works count in the next one.
"""

import atexit
import gc
import json
import os
import runpy
import select
import signal
import socket
import sys
import threading
from collections.abc import Callable, Iterable
from contextlib import suppress
from importlib import import_module
from pathlib import Path
from typing import Any, NoReturn

COMMON = (
    "snakemake.script",
    "facegear.provenance.stage",
    "facegear.pipeline.run",
    "facegear.pipeline.table",
    "pandas",
    "scipy.sparse.linalg",
    "numba",
    "scipy.optimize",
    "xarray",
    "facegear.plots.style",
    "facegear.config.cases",
)
"""What most jobs import, made while the run still finds out what there is to do."""
OBJECTS = 50_000
"""Made by a job until Python looks for unused ones that refer to each other: small jobs end before."""
LOST = 120
"""Exit code of Python where what it has printed cannot be written."""
KILOBYTE, BLOCK = 1024, 512
"""Bytes in the units of the system's account of a process."""


def main() -> None:
    """Serve on the connection whose number the command line ends with."""
    serve(socket.socket(fileno=int(sys.argv[-1])), list(COMMON))


def serve(control: socket.socket, modules: list[str]) -> None:
    """Answer requests until the other end of `control` is closed, and import modules as long as none comes.

    Each byte of `control` brings the connection of one job, on which its script, folder, environment, modules
    and machine code are named. What is stored of the machine code is loaded here, once for all. The answer is
    the number of its process, and at its end its exit code and what it has used; nothing where no copy can be
    made. Jobs that still work when the run is gone go on, as those that Python starts would.
    """
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})  # Ctrl-C ends the run, which ends its jobs
    ended, ends = os.pipe2(os.O_NONBLOCK | os.O_CLOEXEC)
    signal.set_wakeup_fd(ends, warn_on_full_buffer=False)
    signal.signal(signal.SIGCHLD, lambda number, frame: None)
    gc.disable()
    jobs: dict[int, socket.socket] = {}
    while True:
        watched: list[Any] = [control, ended]
        ready = select.select(watched, [], [], 0 if modules else None)[0]
        if ended in ready:
            os.read(ended, 1 << 12)
            _report_ended(jobs)
        elif control in ready:
            _, numbers, *_ = socket.recv_fds(control, 1, 1)
            if not numbers:
                return
            _begin(socket.socket(fileno=numbers[0]), jobs, (control.fileno(), ended, ends))
        elif modules:
            _import([modules.pop(0)])


def _import(modules: Iterable[str]) -> None:
    for module in modules:
        with suppress(Exception):  # the job that needs it says what is wrong with it
            import_module(module)


def _begin(connection: socket.socket, jobs: dict[int, socket.socket], own: Iterable[int]) -> None:
    asked = _asked(connection)
    process = _copied() if asked and _is_alone() else None
    if asked is None or process is None:
        connection.close()
        return
    if not process:
        signal.set_wakeup_fd(-1)
        signal.signal(signal.SIGCHLD, signal.SIG_DFL)
        for number in (*own, *(job.fileno() for job in jobs.values())):
            os.close(number)
        with connection:
            if not _is_watched(connection):
                os._exit(1)
        gc.set_threshold(OBJECTS)
        gc.enable()
        _run(asked)
    jobs[process] = connection
    _tell(connection, process)


def _asked(connection: socket.socket) -> dict[str, Any] | None:
    """What is asked for, its modules imported; None where the run has ended before it had said it all."""
    try:
        with connection.makefile("r", encoding="utf-8") as stream:
            asked: dict[str, Any] = json.loads(stream.readline())
    except (OSError, ValueError):
        return None
    _import(asked["modules"])
    _load(asked["machine_code"])
    return asked


def _load(functions: Iterable[tuple[str, dict[str, Any]]]) -> None:
    """Call functions, `module:function` with arguments, that load machine code, where it is stored."""
    for name, arguments in functions:
        with suppress(Exception), import_module("facegear.machine_code.compiler").nothing_compiled():
            import_module("facegear.pipeline.stage").load(name)(**arguments)


def _copied() -> int | None:
    """0 in a copy of this process, its number in this one; None where the system has no room for it."""
    gc.freeze()
    with suppress(OSError):
        return os.fork()
    return None


def _is_watched(connection: socket.socket) -> bool:
    """Whether the run says that it watches this process: it may have ended before."""
    with suppress(OSError):
        return bool(connection.recv(1))
    return False


def _is_alone() -> bool:
    """Whether this process has one thread: others are not copied, and may leave a lock held in the copy."""
    return len(os.listdir("/proc/self/task")) == 1


def _report_ended(jobs: dict[int, socket.socket]) -> None:
    with suppress(ChildProcessError):
        while (ended := os.wait4(-1, os.WNOHANG))[0]:
            process, status, used = ended
            if process in jobs:  # else something that an import has started
                with jobs.pop(process) as connection:
                    _tell(
                        connection,
                        os.waitstatus_to_exitcode(status),
                        used.ru_utime + used.ru_stime,
                        used.ru_maxrss * KILOBYTE,
                        used.ru_inblock * BLOCK,
                        used.ru_oublock * BLOCK,
                    )


def _tell(connection: socket.socket, *numbers: float) -> None:
    with suppress(OSError):  # the run may be gone
        connection.sendall(json.dumps(numbers).encode() + b"\n")


def _run(asked: dict[str, Any]) -> NoReturn:
    script = asked["script"]
    os.chdir(asked["folder"])
    os.environ.clear()
    os.environ.update(asked["environment"])
    sys.argv = [script]
    sys.path.insert(0, str(Path(script).absolute().parent))
    leave_after(lambda: runpy.run_path(script, run_name="__main__"))


def leave_after(work: Callable[[], object]) -> NoReturn:
    """End this process with the exit code of some work, and all else as Python does, but leave its memory to
    the system: to tidy up a copy of so many modules takes longer than a small job.
    """
    code = 0
    try:
        work()
    except SystemExit as ended:
        if not isinstance(ended.code, int | None):
            print(ended.code, file=sys.stderr)
        code = ended.code or 0 if isinstance(ended.code, int | None) else 1
    except BaseException:
        sys.excepthook(*sys.exc_info())
        code = 1
    threading._shutdown()  # type: ignore[attr-defined]
    atexit._run_exitfuncs()
    for stream in (sys.stdout, sys.stderr):
        try:
            if stream is not None and not getattr(stream, "closed", False):
                stream.flush()
        except Exception:
            code = LOST
    os._exit(code & 255)


if __name__ == "__main__":
    main()
