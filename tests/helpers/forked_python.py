"""Python programs as children of a process that has imported the slow libraries, and nothing of the package.

Each has memory and modules of its own, as a process started anew has; it saves the second of these imports.
That process is no child of the tests, some of which end all of theirs.
"""

import atexit
import json
import os
import subprocess
import sys
import tempfile
import traceback
from collections.abc import Mapping, Sequence
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import NoReturn

IMPORTED = ("pandas", "scipy.sparse.linalg", "scipy.optimize", "xarray", "pydantic", "ruamel.yaml")


def run_together(
    programs: Sequence[str], environment: Mapping[str, str] | None = None
) -> list[subprocess.CompletedProcess[str]]:
    """Return the output of programs that start together, with variables of the environment beside its own."""
    with tempfile.TemporaryDirectory() as folder:
        files = [[str(Path(folder, f"{name}{i}")) for name in ("out", "error")] for i in range(len(programs))]
        server = _server()
        print(json.dumps((programs, files, dict(environment or {}))), file=server.stdin, flush=True)
        codes = json.loads(server.stdout.readline())
        return [
            subprocess.CompletedProcess(program, code, *(Path(name).read_text() for name in names))
            for program, names, code in zip(programs, files, codes, strict=True)
        ]


@cache
def _server() -> subprocess.Popen[str]:
    process = subprocess.Popen(
        [sys.executable, __file__], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
    process.wait()  # for the parent of the one that serves
    atexit.register(process.stdin.close)
    return process


def _serve() -> None:
    for module in IMPORTED:
        import_module(module)
    for request in sys.stdin:
        programs, files, environment = json.loads(request)
        children = []
        for program, names in zip(programs, files, strict=True):
            children.append(os.fork())
            if not children[-1]:
                _run(program, names, environment)
        print(json.dumps([os.waitstatus_to_exitcode(os.waitpid(one, 0)[1]) for one in children]), flush=True)


def _run(program: str, names: Sequence[str], environment: Mapping[str, str]) -> NoReturn:
    code = 1
    try:
        for number, name in enumerate(names, start=1):
            os.dup2(os.open(name, os.O_WRONLY | os.O_CREAT), number)
        os.environ.update(environment)
        sys.path[:1] = ["", *environment.get("PYTHONPATH", "").split(os.pathsep)]
        exec(compile(program, "<string>", "exec"), {"__name__": "__main__"})
        code = 0
    except BaseException:
        traceback.print_exc()
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)


if __name__ == "__main__" and os.fork() == 0:
    _serve()
