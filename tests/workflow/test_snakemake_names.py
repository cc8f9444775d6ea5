"""Names of Snakemake that it does not promise to keep: what they serve for, and what is done without them."""

import subprocess
from types import SimpleNamespace

import pytest

from workflow.process import engine


class Job:
    """A script of Snakemake's, as far as it is asked; Python's own start is only noted."""

    container_img = conda_env = env_modules = shadow_dir = bench_record = None
    rulename, threads, resources = "modal", 1, {"tmpdir": "/tmp"}

    def execute_script(self, file, edit=False):
        self.started = file


@pytest.fixture
def scripts(monkeypatch):
    """The class of scripts of a Snakemake, which the test may change."""
    scripts = type("PythonScript", (Job,), {"execute_script": Job.execute_script})
    module = SimpleNamespace(PythonScript=scripts)
    monkeypatch.setattr(engine, "import_module", lambda name: module)
    return scripts


def test_snakemake_hands_a_script_over_and_starts_python_where_it_is_not_taken(scripts):
    asked, code = [], 0
    assert engine.run_scripts_by(lambda script: asked.append(script) or code)
    job = scripts()
    job.execute_script("stage.py")
    assert (asked[0].rule, asked[0].file, asked[0].temporary) == ("modal", "stage.py", "/tmp")
    assert not hasattr(job, "started")
    code = 4
    with pytest.raises(subprocess.CalledProcessError, match="exit status 4"):
        job.execute_script("stage.py")
    code = None
    job.execute_script("stage.py")
    assert job.started == "stage.py"


@pytest.mark.parametrize("name", ["container_img", "conda_env", "env_modules", "shadow_dir"])
def test_a_job_with_an_environment_of_its_own_is_started_by_snakemake(scripts, name):
    setattr(scripts, name, "own")
    assert engine.run_scripts_by(lambda script: 0)
    job = scripts()
    job.execute_script("stage.py")
    assert job.started == "stage.py"


@pytest.mark.parametrize("name", ["rulename", "threads", "resources", "bench_record"])
def test_a_script_of_another_snakemake_is_started_by_it(scripts, monkeypatch, name):
    monkeypatch.delattr(Job, name)
    assert engine.run_scripts_by(lambda script: 0)
    job = scripts()
    job.execute_script("stage.py")
    assert job.started == "stage.py"


def test_what_another_snakemake_hands_to_its_own_names_is_handed_on(scripts, monkeypatch):
    """It ended in a TypeError."""

    def execute_script(job, file, edit, shell):
        job.started = file, edit, shell

    monkeypatch.setattr(scripts, "execute_script", execute_script)
    assert engine.run_scripts_by(lambda script: None)
    job = scripts()
    job.execute_script("stage.py", True, shell="sh")
    assert job.started == ("stage.py", True, "sh")
    workflow = SimpleNamespace(_build_dag=lambda *given, **named: (given, named))
    assert engine.before_planning(workflow, lambda: None)
    assert workflow._build_dag(1, forced=2) == ((1,), {"forced": 2})


def test_without_scripts_or_a_plan_snakemake_goes_on_as_ever(scripts, monkeypatch):
    assert not engine.before_planning(SimpleNamespace(), None)
    monkeypatch.setattr(engine, "import_module", lambda name: SimpleNamespace())
    assert not engine.run_scripts_by(lambda script: 0)


@pytest.mark.parametrize(
    ("settings", "mode", "begins"),
    [
        ((True, False, False), "DEFAULT", True),
        ((True, True, False), "DEFAULT", False),
        ((True, False, True), "DEFAULT", False),
        ((False, False, False), "DEFAULT", False),
        ((True, False, False), "SUBPROCESS", False),
    ],
    ids=["run", "dry run", "touch", "cluster", "job"],
)
def test_a_server_is_started_before_the_plan_of_a_local_run_alone(settings, mode, begins):
    done = []
    known = dict(zip(("local_exec", "dryrun_exec", "touch_exec"), settings, strict=True))
    workflow = SimpleNamespace(
        executor_plugin=SimpleNamespace(common_settings=SimpleNamespace(**known)),
        exec_mode=SimpleNamespace(name=mode),
        _build_dag=lambda: done.append("planned"),
    )
    assert engine.before_planning(workflow, lambda: done.append("begun"))
    workflow._build_dag()
    assert done == [*["begun"] * begins, "planned"]


def test_what_a_job_has_used_is_written_to_its_benchmark(scripts):
    from snakemake.benchmark import BenchmarkRecord

    def run(script):
        with script.watched(17) as note:
            note(engine.Used(processor=1.5, memory=2**28, read=0, written=2**20))
        return 0

    assert engine.run_scripts_by(run)
    job = scripts()
    job.bench_record = BenchmarkRecord()
    job.execute_script("stage.py")
    row = dict(zip(BenchmarkRecord.get_header(), job.bench_record.to_tsv(False).split("\t"), strict=True))
    wanted = {"cpu_time": "1.50", "max_rss": "256.00", "io_in": "0.00", "io_out": "1.00", "max_pss": "-"}
    assert wanted.items() <= row.items() and not job.bench_record.errors


def test_a_benchmark_of_another_snakemake_is_measured_by_it(scripts):
    assert engine.run_scripts_by(lambda script: 0)
    job = scripts()
    job.bench_record = SimpleNamespace(cpu_time=0)
    job.execute_script("stage.py")
    assert job.started == "stage.py"
