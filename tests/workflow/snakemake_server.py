"""Snakemake started in children of a process that has imported it, since the imports are most of a dry run.

`Server` is for the tests; as a program this file is the process that they ask. It serves until its standard
input is closed, and it is no child of the tests, some of which end or await all of theirs.
"""

import atexit
import ctypes
import gc
import json
import os
import signal
import socket
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from importlib import import_module
from pathlib import Path
from types import SimpleNamespace

MODULES = ("snakemake.cli", "nbformat", "smart_open", "facegear.config.cases", "facegear.pipeline.needs")
"""What every start imports. The Snakefile of another checkout imports its own `facegear` instead."""

NEW_MOUNTS, NEW_USER = 0x20000, 0x10000000
"""Namespaces that Linux makes on request: CLONE_NEWNS and CLONE_NEWUSER of sched.h."""


class Server:
    """The process that starts Snakemake, for the tests of one worker."""

    def __init__(self, root: Path) -> None:
        command = [sys.executable, __file__]
        self._process = subprocess.Popen(
            command, cwd=root, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )
        self._process.wait()  # for the parent of the one that serves
        atexit.register(self._process.stdin.close)

    def start(
        self,
        arguments: Sequence[str],
        environment: Mapping[str, str],
        warm: bool = False,
        disk: tuple[str, str] | None = None,
    ) -> subprocess.CompletedProcess[str]:
        """What `python -m snakemake` with these arguments gives, started in the present folder.

        warm: what jobs are copies of has made its imports before the run began. disk: a folder that is a
        disk of its own for this run, and its size, as 4k; its files at the end are printed.
        """
        with tempfile.TemporaryDirectory() as folder:
            out, error = Path(folder, "out"), Path(folder, "error")
            asked = (arguments, dict(environment), os.getcwd(), str(out), str(error), warm, disk)
            print(json.dumps(asked), file=self._process.stdin, flush=True)
            code = int(self._process.stdout.readline())
            return subprocess.CompletedProcess(arguments, code, out.read_text(), error.read_text())


def serve() -> list[str]:
    """Answer each request with the exit code of a child; returns the arguments in that child alone."""
    for request in sys.stdin:
        arguments, environment, folder, out, error, warm, disk = json.loads(request)
        if warm:
            import_all()
        child = os.fork()
        if not child:
            for number, file in enumerate((os.devnull, out, error)):
                opened = os.open(file, os.O_RDWR | os.O_CREAT)
                os.dup2(opened, number)
                os.close(opened)
            if disk:
                mount(*disk)
                atexit.register(print_files, disk[0], os.getpid())
            os.chdir(folder)
            os.environ.clear()
            os.environ.update(environment)
            if warm:
                serve_jobs()
            return arguments
        print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), flush=True)
    sys.exit()


def import_all() -> None:
    """What the scripts import of libraries and of the package, in the process that all jobs come from."""
    from facegear.pipeline.table import STAGES

    for stage in STAGES.values():
        drawn = [stage.figures.draw.partition(":")[0]] if stage.figures else []
        for module in (*stage.modules, *drawn, "facegear.report.page"):
            import_module(module)
    gc.freeze()


def serve_jobs() -> None:
    """Have the run of this process ask a copy of it for its jobs in place of a server of its own."""
    from workflow.process import forked_jobs, job_server

    ours, theirs = socket.socketpair()
    process = os.fork()
    if not process:
        ours.close()
        job_server.serve(theirs, [])
        os._exit(0)
    theirs.close()
    server = SimpleNamespace(
        kill=lambda: os.kill(process, signal.SIGKILL), wait=lambda: os.waitpid(process, 0)
    )
    forked_jobs.started = lambda: (ours, server)


def mount(folder: str, size: str) -> None:
    """Make a folder an empty disk of a size for this process and its children, in namespaces of their own."""
    maps = {"setgroups": "deny", "uid_map": f"0 {os.getuid()} 1", "gid_map": f"0 {os.getgid()} 1"}
    if ctypes.CDLL(None, use_errno=True).unshare(NEW_USER | NEW_MOUNTS):
        raise OSError(ctypes.get_errno(), "no namespaces")
    for name, text in maps.items():
        Path("/proc/self", name).write_text(text)
    subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", folder], check=True)


def print_files(folder: str, process: int) -> None:
    """Print the files of a folder in the process that is meant, and not at the end of its jobs."""
    for path in Path(folder).rglob("*") if os.getpid() == process else ():
        if path.is_file():
            print(f"left: {path.relative_to(folder)}")


def main() -> None:
    """Serve, and in each child be what `python -m snakemake` is."""
    sys.path[0] = os.getcwd()
    from workflow.process.job_server import leave_after

    for module in MODULES:
        import_module(module)
    from snakemake import cli

    cli.get_argument_parser()  # finds the plugins
    gc.freeze()
    python = sys.executable
    arguments = serve()
    sys.path[0] = os.getcwd()
    sys.argv = [str(Path(cli.__file__).with_name("__main__.py")), *arguments]
    sys.orig_argv = [python, "-m", "snakemake", *arguments]
    leave_after(cli.main)


if __name__ == "__main__" and os.fork() == 0:
    main()
