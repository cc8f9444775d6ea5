"""Jobs of a run in children of a process that has imported what they use, most of what small ones do.

Snakemake calls the launcher instead of Python. It hands a job's script over with its surroundings, and ends
as the script does.
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
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import NoReturn

LAUNCHER = """#!{python} -IS
import json, os, socket, sys
if "/.snakemake/scripts/" not in sys.argv[1]:
    os.execv({python!r}, [{python!r}, *sys.argv[1:]])
with socket.socket(socket.AF_UNIX) as server:
    server.connect({at!r})
    asked = json.dumps([sys.argv[1], os.getcwd(), dict(os.environ)]).encode()
    socket.send_fds(server, [asked[:1]], [0, 1, 2])
    server.sendall(asked[1:])
    server.shutdown(socket.SHUT_WR)
    sys.exit(int(server.recv(4) or b"1"))
"""


def import_all() -> None:
    """What the scripts import of libraries and of the package, in the process that all jobs come from."""
    from facegear.pipeline.table import STAGES

    for stage in STAGES.values():
        drawn = [stage.figures.draw.partition(":")[0]] if stage.figures else []
        for module in (*stage.modules, *drawn, "facegear.report.page"):
            import_module(module)
    gc.freeze()


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
    threading._shutdown()
    atexit._run_exitfuncs()
    for stream in (sys.stdout, sys.stderr):
        stream.flush()
    os._exit(code & 255)


def serve_jobs(folder: Path) -> Path:
    """Serve the jobs of this process, and return the program that takes the place of Python in it."""
    at, launcher = folder / "jobs", folder / "python"
    listening = socket.socket(socket.AF_UNIX)
    listening.bind(str(at))
    listening.listen()
    launcher.write_text(LAUNCHER.format(python=sys.executable, at=str(at)))
    launcher.chmod(0o755)
    ended, kept = os.pipe()
    if os.fork() == 0:
        os.close(kept)
        _serve(listening, ended)
    os.close(ended)
    listening.close()
    return launcher


def _serve(listening: socket.socket, ended: int) -> NoReturn:
    """Run each script that is asked for in a child, until the process whose jobs they are has ended."""
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # nobody awaits the children
    while listening in select.select([listening, ended], [], [])[0]:
        connection, _ = listening.accept()
        if os.fork() == 0:
            listening.close()
            signal.signal(signal.SIGCHLD, signal.SIG_DFL)
            _run_for(connection)
        connection.close()
    os._exit(0)


def _run_for(connection: socket.socket) -> NoReturn:
    """Run the script that a launcher names in a child, and tell the launcher how it ended."""
    asked, streams, *_ = socket.recv_fds(connection, 1, 3)
    while part := connection.recv(1 << 16):
        asked += part
    script, folder, environment = json.loads(asked)
    child = os.fork()
    if child:
        connection.send(str(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) & 255).encode())
        os._exit(0)
    connection.close()
    for number, stream in enumerate(streams):
        os.dup2(stream, number)
        os.close(stream)
    os.chdir(folder)
    os.environ.clear()
    os.environ.update(environment)
    sys.argv = [script]
    sys.path[:0] = [str(Path(script).parent), environment["PYTHONPATH"]]
    leave_after(lambda: runpy.run_path(script, run_name="__main__"))
