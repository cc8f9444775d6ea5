"""Process control without Snakemake: what is kept of a killed run, what is ended, what a newer one lacks."""

import logging
import os
import subprocess
import sys
import time
from inspect import signature
from pathlib import Path
from types import SimpleNamespace

import psutil
import pytest

from facegear.provenance.manifest import write_manifest
from workflow.process import engine
from workflow.process.jobs import STARTED, Jobs, is_current, settle
from workflow.process.orphans import end_orphans
from workflow.process.terminal import Quiet, end_jobs, quieten

NOTHING = SimpleNamespace()
"""A Snakemake that has none of the names."""


def line(level=logging.INFO, text="rule contact:"):
    return logging.LogRecord("snakemake", level, "", 0, text, (), None)


def running(**names):
    given = {
        "exec_mode": SimpleNamespace(name="DEFAULT"),
        "executor_plugin": object(),
        "dryrun": False,
        "output_settings": SimpleNamespace(verbose=False),
    }
    return SimpleNamespace(**{**given, **names})


def test_a_snakemake_without_these_names_shows_more_and_trusts_less():
    assert engine.shows_all(NOTHING)
    assert not engine.is_run(NOTHING) and not engine.jobs_are_elsewhere(NOTHING)
    assert list(engine.planned_jobs(NOTHING)) == [] and not engine.keep(NOTHING, object())
    assert engine.given_config(NOTHING) == {} and engine.given_directory(NOTHING) is None
    assert engine.terminal_handlers(SimpleNamespace(handlers=[object()])) == []
    assert engine.event_of(line()) == ""


def test_parameters_are_written_without_pandas_where_snakemake_can_and_else_as_it_likes(monkeypatch):
    plain, scripts = SimpleNamespace(_serialize_param_builtin=repr), SimpleNamespace(_safely_store_params=str)
    known = SimpleNamespace(PersistenceBase=plain, Snakemake=scripts)
    monkeypatch.setattr(engine, "import_module", lambda name: known)
    assert engine.write_parameters_without_pandas() and plain._serialize_param is repr
    assert scripts._safely_store_params is not str
    known.PersistenceBase = SimpleNamespace(_serialize_param=str)
    assert not engine.write_parameters_without_pandas() and known.PersistenceBase._serialize_param is str
    known.PersistenceBase = SimpleNamespace(_serialize_param_builtin=repr, _serialize_param=str)
    known.Snakemake = SimpleNamespace()
    assert not engine.write_parameters_without_pandas() and known.PersistenceBase._serialize_param is str


def test_a_script_finds_the_parameters_that_its_job_was_given_though_no_table_was_looked_for():
    import snakemake.api  # noqa: F401
    from snakemake.iocontainers import Params, Snakemake

    params = Params(fromdict={"needs": {"teeth": 23}, "code": "abc"})
    script = SimpleNamespace()
    engine._store_parameters(script, params)
    restored = Snakemake.params.fget(script)
    assert dict(restored.items()) == {"needs": {"teeth": 23}, "code": "abc"}
    assert restored.needs == {"teeth": 23}


def test_the_snakemake_that_is_locked_has_every_name():
    """Where this fails a run still works, but look what `workflow.process.engine` can do with the new one."""
    import snakemake.api  # noqa: F401  (its parts import each other in this order alone)
    from snakemake.benchmark import BenchmarkRecord
    from snakemake.iocontainers import Snakemake
    from snakemake.persistence import PersistenceBase
    from snakemake.script import PythonScript
    from snakemake.workflow import Workflow
    from snakemake_interface_logger_plugins.common import LogEvent

    assert hasattr(PersistenceBase, "_serialize_param_builtin") and hasattr(PersistenceBase, "finished")
    assert hasattr(Snakemake, "_safely_store_params") and vars(BenchmarkRecord()).keys() >= engine.RECORDED
    assert list(signature(PythonScript.execute_script).parameters)[1:] == ["fname", "edit"]
    for name in ("_build_dag", "dryrun", "non_local_exec", "async_run", "persistence", "overwrite_workdir"):
        assert hasattr(Workflow, name) or name in Workflow.__dataclass_fields__, name
    assert {"JOB_INFO", "JOB_FINISHED", "JOB_ERROR"} <= {event.name for event in LogEvent}


def test_a_run_shows_warnings_alone_and_nothing_while_it_is_stopped():
    quiet = Quiet(running())
    assert not quiet.filter(line()) and quiet.filter(line(logging.WARNING))
    assert quiet.filter(line(text="Nothing to be done (all requested files are present)."))
    assert Quiet(running(dryrun=True)).filter(line())
    assert Quiet(running(output_settings=SimpleNamespace(verbose=True))).filter(line())
    quiet.stopping = True
    assert not quiet.filter(line(logging.ERROR))


def test_only_what_goes_to_the_terminal_is_held_back():
    handlers = [logging.StreamHandler(), logging.NullHandler()]
    handlers[0].name = "DefaultStreamHandler"
    quiet = quieten(running(), SimpleNamespace(handlers=handlers))
    assert quiet in handlers[0].filters and quiet not in handlers[1].filters


def test_a_job_of_a_run_holds_nothing_back_and_can_be_stopped_as_a_run_can():
    """A run that a newer Snakemake does not call one had nothing to stop by, and ended in a traceback."""
    for workflow in (NOTHING, running(exec_mode=SimpleNamespace(name="SUBPROCESS"))):
        handler = logging.StreamHandler()
        handler.name = "DefaultStreamHandler"
        assert not quieten(workflow, SimpleNamespace(handlers=[handler])).stopping
        assert handler.filters == []


@pytest.fixture
def killed(tmp_path, monkeypatch):
    """A folder in which a killed run has left one job's files, with the job as it is planned today."""
    monkeypatch.chdir(tmp_path)
    folder = Path("results")
    folder.mkdir()
    (folder / "before.csv").write_text("1")
    (folder / "a.csv").write_text("2")
    params = {"needs": {"torque": 3.0}, "code": "abc"}
    manifest = str(folder / "a.provenance.json")
    write_manifest(manifest, [folder / "a.csv"], [folder / "before.csv"], params, "a", 0.1, "", "snakemake")
    job = SimpleNamespace(output=["results/a.csv", manifest], input=["results/before.csv"], params=params)
    STARTED.mkdir(parents=True)
    (STARTED / "7").write_text("\n".join(job.output))
    return job


def with_jobs(*jobs):
    kept = []
    persistence = SimpleNamespace(dag=SimpleNamespace(jobs=jobs), finished=lambda job: job)
    return SimpleNamespace(persistence=persistence, async_run=kept.append), kept


def test_what_a_job_of_a_killed_run_finished_by_itself_is_kept_where_it_would_do_the_same(killed):
    workflow, kept = with_jobs(killed)
    assert is_current(killed) and not settle(workflow)
    assert kept == [killed] and Path("results/a.csv").exists() and not list(STARTED.iterdir())


@pytest.mark.parametrize(
    "change",
    [
        lambda job: job.params.update(code="other"),
        lambda job: job.params.update(needs={"torque": 4.0}),
        lambda job: Path("results/before.csv").write_text("9"),
        lambda job: Path("results/a.csv").write_text("9"),
        lambda job: Path("results/a.provenance.json").write_text("{}"),
    ],
    ids=["code", "values", "input", "output", "manifest"],
)
def test_what_would_be_made_otherwise_today_is_dropped(killed, change):
    change(killed)
    workflow, kept = with_jobs(killed)
    assert settle(workflow) and not kept
    assert not Path("results/a.csv").exists() and not list(STARTED.iterdir())


def test_without_snakemake_s_own_account_finished_files_are_made_again(killed):
    assert settle(NOTHING) and not Path("results/a.csv").exists()


def test_jobs_that_begin_and_end_are_accounted_for_and_remote_ones_heard(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    Path("a.log").write_text("progress\ncontact: 24 contacts\n")
    jobs = Jobs(SimpleNamespace(non_local_exec=True))
    event = SimpleNamespace
    jobs.emit(event(event=event(name="JOB_INFO"), jobid=3, log=["a.log"], output=["x.csv", "y.csv"]))
    assert (STARTED / "3").read_text().split() == ["x.csv", "y.csv"]
    jobs.emit(event(event=event(name="JOB_FINISHED"), job_id=3))
    assert not (STARTED / "3").exists() and capsys.readouterr().err == "contact: 24 contacts\n"


def test_ended_jobs_leave_no_file_half_written(tmp_path):
    child = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(60)"])
    half, whole = tmp_path / f".{child.pid}.a.csv", tmp_path / "a.csv"
    half.touch()
    whole.touch()
    end_jobs(tmp_path)
    assert not psutil.pid_exists(child.pid) and not half.exists() and whole.exists()


def test_no_process_survives_that_begins_while_its_job_is_ended(tmp_path):
    """A shell killed between two commands left the second working, for nobody knew whose it was."""
    mark = f"60.{os.getpid()}"
    shell = subprocess.Popen(["sh", "-c", f"for i in $(seq 300); do sleep {mark} & done; wait"])
    while not working(mark):
        assert shell.poll() is None
    end_jobs(tmp_path)
    assert not psutil.pid_exists(shell.pid) and not working(mark)


def working(mark):
    """Processes whose command line holds a mark."""
    return [one for one in psutil.process_iter(["cmdline"]) if mark in (one.info["cmdline"] or [])]


def test_a_script_that_a_killed_run_left_working_here_is_ended_and_no_other(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    script = tmp_path / ".snakemake" / "scripts" / "stage.py"
    script.parent.mkdir(parents=True)
    script.write_text("import time; time.sleep(60)")
    orphan, other = (
        subprocess.Popen([sys.executable, str(script)], cwd=folder) for folder in (tmp_path, tmp_path.parent)
    )
    try:
        deadline = time.monotonic() + 10
        while not all(str(script) in psutil.Process(one.pid).cmdline() for one in (orphan, other)):
            assert time.monotonic() < deadline
        assert end_orphans()
        assert not psutil.pid_exists(orphan.pid) and other.poll() is None
        assert not end_orphans()
    finally:
        other.kill()
        other.wait()
