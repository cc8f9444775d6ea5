"""Dry runs that begin where Snakemake has been imported, which takes half of one.

Nothing of the project is imported before a run begins: the Snakefile finds its own sources, as in a process
that `python -m snakemake` starts.
"""

import multiprocessing
import os
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from functools import cache
from multiprocessing.context import ForkServerContext
from pathlib import Path


def dry_run(arguments: Sequence[str], environment: Mapping[str, str]) -> subprocess.CompletedProcess[str]:
    """What `python -m snakemake` with these arguments gives in this environment; `-n` must be one of them."""
    with tempfile.TemporaryDirectory() as folder:
        out, error = Path(folder, "out"), Path(folder, "error")
        given = [*arguments], dict(environment), str(out), str(error)
        process = _server().Process(target=_run, args=given)
        process.start()
        process.join()
        code = process.exitcode
        process.close()
        return subprocess.CompletedProcess(given[0], code, out.read_text(), error.read_text())


@cache
def _server() -> ForkServerContext:
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(["snakemake.cli"])
    return context


def _run(arguments: list[str], environment: dict[str, str], out: str, error: str) -> None:
    for stream, file in ((sys.stdout, out), (sys.stderr, error)):
        with open(file, "wb") as target:
            os.dup2(target.fileno(), stream.fileno())
    os.environ.clear()
    os.environ.update(environment)
    from snakemake import cli

    sys.argv = [str(Path(cli.__file__).with_name("__main__.py")), *arguments]
    cli.main()
