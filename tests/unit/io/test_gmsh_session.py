"""State of the process after a session of gmsh."""

import os
import subprocess
import sys
import textwrap

import gmsh
import pytest

from facegear.io.cad import VARIABLE, gmsh_session

SESSION = """
import faulthandler, os, signal
from facegear.io.cad import gmsh_session
faulthandler.enable()
with gmsh_session("a"):
    pass
"""
PIPE = """
reads, writes = os.pipe()
os.close(reads)
try:
    os.write(writes, b".")
except BrokenPipeError:
    print("goes on")
"""


def program(*parts):
    text = "".join(textwrap.dedent(part) for part in parts)
    return subprocess.run([sys.executable, "-c", text], capture_output=True, text=True, check=False)


def test_a_broken_pipe_is_an_error_after_a_session_and_no_sudden_end():
    assert program(SESSION, PIPE).stdout == "goes on\n"


def test_a_crash_after_a_session_still_tells_where():
    assert "Fatal Python error" in program(SESSION, "os.kill(os.getpid(), signal.SIGSEGV)").stderr


@pytest.mark.parametrize("given", [None, "-malloc"])
def test_a_session_is_begun_without_handlers_and_with_what_the_user_asks_of_petsc(monkeypatch, given):
    if given:
        monkeypatch.setenv(VARIABLE, given)
    asked = []
    begin = gmsh.initialize
    monkeypatch.setattr(gmsh, "initialize", lambda **how: asked.append(os.environ[VARIABLE]) or begin(**how))
    with gmsh_session("a"):
        assert "a" in gmsh.model.list()
    assert asked == [" ".join([*filter(None, [given]), "-no_signal_handler"])]
    assert os.environ.get(VARIABLE) == given
