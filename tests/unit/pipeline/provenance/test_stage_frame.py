"""The frame around a script: manifest at the end, one-line errors, tracebacks only in the log."""

import errno
import json
import os
from pathlib import Path
from types import SimpleNamespace

import pytest

from facegear.errors import NotConverged
from facegear.io.atomic import sha256
from facegear.pipeline.provenance.stage import stage


@pytest.fixture
def job(tmp_path):
    (tmp_path / "given.csv").write_text("x\n2\n")
    return SimpleNamespace(
        input=[str(tmp_path / "given.csv")],
        output=[str(tmp_path / "a.csv"), str(tmp_path / "a.provenance.json")],
        log=[str(tmp_path / "a.log")],
        params={"code": "c0de", "section": {"teeth": 23}},
        rule="contact",
        wildcards={"case": "paper"},
        config={"rebuild_command": "snakemake --cores 2 --force"},
    )


def test_manifest_records_what_made_the_outputs(job, tmp_path, capsys):
    with stage(job) as run:
        (tmp_path / "a.csv").write_text("x\n1\n")
        run.summary("mean stiffness 4.1e8 N/m")
    made = json.loads((tmp_path / "a.provenance.json").read_text())
    assert made["rule"] == "contact"
    assert made["code"] == "c0de"
    assert made["params"] == {"section": {"teeth": 23}}
    assert made["summary"] == "mean stiffness 4.1e8 N/m"
    assert made["files"]["a.csv"]["bytes"] == 4
    assert made["inputs"] == {"given.csv": sha256(tmp_path / "given.csv")}
    assert {"python", "numpy"} <= set(made["versions"])
    assert ": mean stiffness" in capsys.readouterr().err
    assert "mean stiffness" in (tmp_path / "a.log").read_text()


def test_a_stage_without_findings_of_its_own_ends_with_the_files_it_wrote(job, tmp_path, capsys):
    with stage(job):
        (tmp_path / "a.csv").write_text("x\n1\n")
    assert capsys.readouterr().err == "contact paper: wrote a.csv\n"


def test_solver_failure_is_one_line_with_case_and_log(job, tmp_path, capsys):
    (tmp_path / "a.provenance.json").write_text("{}")
    with pytest.raises(SystemExit) as ended, stage(job):
        raise NotConverged("contact", "position 0.25, 600 N m", "40 active set steps")
    assert ended.value.code == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert line == (
        "error in contact of paper: contact did not converge at position 0.25, 600 N m: 40 active set steps "
        f"(log: {tmp_path / 'a.log'})"
    )
    assert not (tmp_path / "a.provenance.json").exists()


def test_traceback_of_a_programming_error_is_kept_in_the_log(job, tmp_path):
    with pytest.raises(ZeroDivisionError), stage(job):
        1 / 0  # noqa: B018
    assert "ZeroDivisionError" in (tmp_path / "a.log").read_text()


def test_no_room_for_the_log_is_one_line_as_well(job, tmp_path, capsys):
    (tmp_path / "a.log").symlink_to("/dev/full")
    with pytest.raises(SystemExit), stage(job) as run:
        run.summary("mean stiffness 4.1e8 N/m")
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
    message = capsys.readouterr().err.splitlines()
    assert message[0] == "contact paper: mean stiffness 4.1e8 N/m"
    (line,) = message[1:]
    assert "no space left on the disk; free some and run again" in line


def test_an_input_whose_manifest_is_gone_is_not_read(job, tmp_path, capsys, monkeypatch):
    """A manifest deleted together with the last row of its csv was read without a word."""
    monkeypatch.chdir(tmp_path)
    table = Path("results") / "paper" / "stiffness" / "harmonics.csv"
    table.parent.mkdir(parents=True)
    table.write_text("order\n0\n")
    job.input = [str(table)]
    with pytest.raises(SystemExit), stage(job):
        pytest.fail("the stage ran")
    (message,) = capsys.readouterr().err.splitlines()
    assert f"{table}: no manifest beside it says what its stage wrote; rebuild it with: " in message
