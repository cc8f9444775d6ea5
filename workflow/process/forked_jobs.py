"""Scripts of a local run, each begun as a copy of one process that has imported what they use.

Python, imports and the reading of compiled modules would take each job a second or two of the processor.
"""

import atexit
import json
import os
import signal
import socket
import subprocess
import sys
import threading
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from typing import Any

from workflow.process.engine import Script, Used

VARIABLE = "FACEGEAR_FORK"
"""Environment variable; with the value `no` Python is started for each job."""
SERVER = ("-P", "-m", "workflow.process.job_server")
"""How Python is started as the server; its copies are known by the same words."""
THREADS = (
    *("OMP_NUM_THREADS", "GOTO_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"),
    *("VECLIB_MAXIMUM_THREADS", "NUMEXPR_NUM_THREADS"),
)
"""What tells libraries how many threads they may start; they read it when they are imported."""
FOLDERS = ("TMPDIR", "TMP", "TEMPDIR", "TEMP")
ALONE = {**dict.fromkeys(THREADS, "1"), "JE_ARROW_MALLOC_CONF": "background_thread:false"}
"""Environment of a server with one thread: a copy of a process has no other."""


class ForkedJobs:
    """The connection to the server of a run.

    - modules: what a rule's script will import, by the rule's name
    - machine_code: functions (`module:function`, arguments) that load the machine code which it will run
    """

    def __init__(
        self,
        modules: Callable[[str], Sequence[str]],
        machine_code: Callable[[str], Sequence[tuple[str, Mapping[str, Any]]]] = lambda rule: (),
    ) -> None:
        self._modules, self._machine_code = modules, machine_code
        self._control: socket.socket | None = None
        self._turn = threading.Lock()

    def start(self) -> None:
        """Start the server where jobs can be copies of it; it ends when this process does."""
        if sys.platform != "linux" or os.environ.get(VARIABLE) == "no":
            return
        with suppress(OSError):
            self._control, server = started()
            atexit.register(_end, server)

    def run(self, script: Script) -> int | None:
        """The exit code of a script, run by a copy of the server; None where it has not been begun.

        A job on several threads is none for a copy, whose libraries use one.
        """
        if self._control is None or script.threads != 1:
            return None
        asked = {
            "script": script.file,
            "folder": os.getcwd(),
            "environment": {
                **os.environ,
                **dict.fromkeys(THREADS, "1"),
                **dict.fromkeys(FOLDERS if script.temporary else (), script.temporary),
            },
            "modules": self._modules(script.rule),
            "machine_code": self._machine_code(script.rule),
        }
        request = json.dumps(asked).encode() + b"\n"
        ours, theirs = socket.socketpair()
        with ours, ours.makefile("r", encoding="utf-8") as answers:
            try:
                with theirs, self._turn:
                    socket.send_fds(self._control, [b"."], [theirs.fileno()])
                ours.sendall(request)
                (process,) = json.loads(answers.readline())
            except (OSError, ValueError):  # no server any more, or one that may not be copied
                return None
            with script.watched(process) as note:
                with suppress(OSError):
                    ours.sendall(b"\n")
                ended = answers.readline()
                if not ended:
                    _kill(process)
                    return -signal.SIGKILL
                code, *used = json.loads(ended)
                note(Used(*used))
            return int(code)


def started() -> tuple[socket.socket, subprocess.Popen[bytes]]:
    """A new server, and the connection to it."""
    ours, theirs = socket.socketpair()
    with theirs:
        server = subprocess.Popen(
            [sys.executable, *SERVER, str(theirs.fileno())],
            stdin=subprocess.DEVNULL,
            env={**os.environ, **ALONE},
            pass_fds=[theirs.fileno()],
        )
    return ours, server


def _end(server: subprocess.Popen[bytes]) -> None:
    """End a server that has no jobs any more, whatever it imports."""
    server.kill()
    server.wait()


def _kill(process: int) -> None:
    """End a job whose server was killed, as nobody else would hear of its end."""
    with suppress(ProcessLookupError):
        os.kill(process, signal.SIGKILL)
