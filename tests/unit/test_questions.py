"""Questions of `facegear new` at a terminal that is left without an answer."""

import os
import subprocess
import sys
import time
from contextlib import suppress

import pytest

from facegear.__main__ import main

TERMINAL = (
    "import os, pty, signal, sys; signal.signal(signal.SIGINT, signal.SIG_DFL); "
    "sys.exit(os.waitstatus_to_exitcode(pty.spawn(sys.argv[1:])))"
)
"""Runs a command at a terminal of its own, so that its keys mean what they mean to a user.

Ctrl-C has its meaning back, as jobs in the background of a shell ignore it.
"""
QUESTION = b"Teeth of a pinion: "
KEYS = {"Ctrl-C": b"\x03", "Ctrl-D": b"\x04"}


@pytest.mark.parametrize(
    ("key", "code", "line"),
    [
        ("Ctrl-C", 130, "new: stopped; no file was written"),
        ("Ctrl-D", 1, "new: --pinion-teeth was not answered; no file was written"),
    ],
)
def test_a_question_that_is_not_answered_ends_with_one_line(tmp_path, key, code, line):
    command = [sys.executable, "-m", "facegear", "new", "own.yaml"]
    with subprocess.Popen(
        [sys.executable, "-c", TERMINAL, *command],
        cwd=tmp_path,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        env=os.environ | {"TERM": "dumb"},
    ) as run:
        said = run.stdout.read(len(QUESTION))
        # Python loses a signal between its question and the wait for an answer: the key is pressed again.
        for _ in range(10):
            time.sleep(0.3)
            run.stdin.write(KEYS[key])
            run.stdin.flush()
            with suppress(subprocess.TimeoutExpired):
                run.wait(timeout=5)
                break
        run.kill()
        said += run.stdout.read()
        assert run.returncode == code
    lines = said.decode().splitlines()
    assert lines[0].startswith(QUESTION.decode()) and [text for text in lines[1:] if text] == [line]
    assert list(tmp_path.iterdir()) == []


def test_ctrl_c_during_a_command_ends_it_with_one_line(monkeypatch, tmp_path, capsys):
    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr("facegear.__main__.load_config", interrupted)
    assert main(["check", str(tmp_path / "own.yaml")]) == 130
    assert capsys.readouterr().err == "check: stopped\n"
