"""Tries mutants: `python worker.py JOB` in a copy of the checkout, JOB a JSON file that `run.py` writes.

The libraries are imported once, and each mutant has a process of its own forked from there. Prints a line a
mutant: `killed` by its tests, `endless` where they take far more processor time than usual, or `survived`.
"""

import importlib
import json
import os
import resource
import signal
import sys
from contextlib import suppress
from multiprocessing import get_context
from pathlib import Path

import pytest
from hypothesis import Phase, settings

LIBRARIES = ("numpy", "scipy.linalg", "scipy.optimize", "scipy.sparse.linalg", "pandas", "pydantic")
FAILURE_CODES = (pytest.ExitCode.TESTS_FAILED, pytest.ExitCode.INTERRUPTED)
LONGER, START = 3.0, 6.0
"""Tests may take this many times the processor time that they take without a mutant, and so many s more."""
WITHOUT_MUTANT = 600.0
"""Processor time (s) for the tests without a mutant."""


def attempt(tests: list[str], limit: float) -> tuple[str, float]:
    """Run the tests in a forked process.

    Parameters
    ----------
    tests : list[str]
        Options and names of the tests for pytest.
    limit : float
        Largest processor time, s.

    Returns
    -------
    str, float
        How the tests end, and their processor time, s.
    """
    child = get_context("fork").Process(target=_run, args=(tests, limit))
    child.start()
    _, status, usage = os.wait4(child.pid or 0, 0)
    code, seconds = os.waitstatus_to_exitcode(status), usage.ru_utime + usage.ru_stime
    if code == -signal.SIGXCPU:
        return "endless", seconds
    if code not in (0, *FAILURE_CODES) and code >= 0:
        raise SystemExit(f"pytest ended with {code}: " + Path("tests.log").read_text(encoding="utf-8"))
    return ("killed" if code else "survived"), seconds


def _run(tests: list[str], limit: float) -> None:
    """Run the tests without shrinking what fails, and end the process."""
    resource.setrlimit(resource.RLIMIT_CPU, (int(limit), int(limit) + 5))
    log = os.open("tests.log", os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
    os.dup2(log, 1)
    os.dup2(log, 2)
    phases = (Phase.explicit, Phase.generate)
    settings.register_profile("mutants", derandomize=True, deadline=None, database=None, phases=phases)
    code = 3
    with suppress(BaseException):
        options = ["-x", "-n", "0", "-p", "no:cacheprovider", "--hypothesis-profile=mutants"]
        code = int(pytest.main([*options, *tests]))
    raise SystemExit(code)


def main() -> None:
    job = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))
    for library in LIBRARIES:
        importlib.import_module(library)
    end, usual = attempt(job["tests"], WITHOUT_MUTANT)
    if end != "survived":
        log = Path("tests.log").read_text(encoding="utf-8")
        raise SystemExit(f"the tests fail without a mutant: {log}")
    for mutant in job["mutants"]:
        file = Path(mutant["file"])
        source = file.read_text(encoding="utf-8")
        file.write_text(mutant["text"], encoding="utf-8")
        print(attempt(job["tests"], LONGER * usual + START)[0], flush=True)
        file.write_text(source, encoding="utf-8")


if __name__ == "__main__":
    main()
