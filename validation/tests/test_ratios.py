"""Ratios of processor time against an earlier commit, and what they say of the answers."""

import ast
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import facegear
from facegear.pipeline.table import STAGES
from validation.ratios import trees, worker
from validation.ratios.points import POINTS, Point
from validation.ratios.run import BASELINE, COLUMNS, changes, main, ratio, read_answers
from validation.ratios.trees import LOCK, Tree, build_package, environment, present
from validation.ratios.worker import MODULES, flat, from_facegear

MOTIONS = np.array(["period-1", "chaotic", "period-2", "period-1"])


def test_code_is_measured_beside_itself_with_the_same_answers(tmp_path):
    point = Point("config/harmonics_only.yaml", "s", "docs/explanation/theory.md", "modal", amount=2)
    here = np.ones(80_000_000)  # 640 MB that are not the job's
    row = ratio("modal", point, (present(), present()), tmp_path, turns=1)
    assert 50.0 < row["memory_now_mb"] < 600.0 < here.nbytes / 2**20
    assert tuple(row) == COLUMNS
    assert row["change"] == 0.0 and row["labels_changed"] == 0
    assert row["before"] > 0.0 and row["ratio"] == pytest.approx(row["now"] / row["before"])
    frequencies = read_answers(tmp_path / "modal_now.npz")["frequencies/frequency_hz"]
    computed = facegear.load(point.config, results=None).modes().table()["frequency_hz"]
    assert frequencies == pytest.approx(computed, rel=1e-12, abs=1e-6)


def test_a_fresh_process_is_measured_from_its_start(tmp_path):
    row = ratio("import", POINTS["fresh_import"], (present(), present()), tmp_path, turns=1)
    assert row["before"] > 0.1 and row["now"] > 0.1  # a start of Python with pydantic, not a second call
    assert read_answers(tmp_path / "import_now.npz")["door"] == "Gearbox"


def test_answers_hold_no_python_objects():
    content = {"table": pd.DataFrame({"motion": ["a", None], "rms": [1.0, None]}), "list": [1, {"x": "y"}]}
    arrays = flat(content)
    assert list(arrays) == ["table/motion", "table/rms", "list/0", "list/1/x"]
    assert [values.dtype.kind for values in arrays.values()] == ["U", "f", "i", "U"]


@pytest.fixture
def commands(monkeypatch):
    """Commands for uv, none of which is run; folders that it would make are empty."""
    called = []

    def run(*arguments):
        called.append(arguments)
        folder = arguments[arguments.index("--target") + 1] if "--target" in arguments else arguments[-1]
        if arguments[0] == "venv" or "--target" in arguments:
            Path(folder).mkdir(parents=True)

    monkeypatch.setattr(trees, "_uv", run)
    return called


def make_sources(folder, lock="numpy==1", extension=False):
    folder.mkdir(parents=True)
    (folder / LOCK).write_text(lock)
    (folder / "pyproject.toml").write_text("[project]")
    if extension:
        (folder / "facegear" / "_kernels").mkdir(parents=True)
    return folder


def test_environment_is_that_of_the_lock_and_made_once(tmp_path, commands):
    locks = {"a": "numpy==1", "b": "numpy==1", "c": "numpy==2"}
    first, again, other = (
        environment(make_sources(tmp_path / name, lock), tmp_path) for name, lock in locks.items()
    )
    assert first == again != other
    assert [command[0] for command in commands] == ["venv", "pip", "venv", "pip"]
    assert "--require-hashes" in commands[1]


def test_environment_that_was_cut_short_is_made_again(tmp_path, monkeypatch):
    def fails(*arguments):
        raise subprocess.CalledProcessError(1, arguments)

    sources = make_sources(tmp_path / "sources")
    for _ in range(2):
        monkeypatch.setattr(trees, "_uv", fails)
        with pytest.raises(subprocess.CalledProcessError):
            environment(sources, tmp_path)


def test_only_a_commit_with_an_extension_is_built(tmp_path, commands, monkeypatch):
    monkeypatch.setattr(trees.subprocess, "check_output", lambda *_: b"94c3f7f7")
    python = tmp_path / "python"
    plain, compiled = make_sources(tmp_path / "a"), make_sources(tmp_path / "b", extension=True)
    assert build_package(plain, python, tmp_path) == plain and not commands
    package = build_package(compiled, python, tmp_path)
    assert build_package(compiled, python, tmp_path) == package != compiled
    assert len(commands) == 1 and commands[0][-1] == str(compiled)


def test_processes_keep_their_bytecode_and_run_on_one_thread(monkeypatch):
    monkeypatch.setenv("PYTHONDONTWRITEBYTECODE", "1")
    variables = Tree(Path("sources"), Path("package"), Path("python")).variables
    assert "PYTHONDONTWRITEBYTECODE" not in variables
    assert variables["PYTHONPATH"] == "package" and variables["OPENBLAS_NUM_THREADS"] == "1"


def test_unknown_points_are_refused_before_anything_is_checked_out(capsys):
    with pytest.raises(SystemExit):
        main(["modal", "--since", "no such commit"])
    assert "unknown points modal; allowed: pinion, face_gear" in capsys.readouterr().err


def test_baseline_is_a_commit_before_the_kernels():
    names = subprocess.run(
        ["git", "ls-tree", "--name-only", BASELINE, "facegear/"], capture_output=True, text=True
    ).stdout
    if not names:
        pytest.skip("no history here")
    assert "facegear/machine_code" in names and "facegear/_kernels" not in names


@pytest.mark.parametrize("name", MODULES)
def test_a_process_finds_its_names_in_this_code_and_in_the_baseline(name):
    assert from_facegear(name)[0].__name__ == name
    path = MODULES[name][-1].replace(".", "/") + ".py"
    source = subprocess.run(["git", "show", f"{BASELINE}:{path}"], capture_output=True, text=True)
    if subprocess.run(["git", "cat-file", "-e", BASELINE], capture_output=True).returncode:
        pytest.skip("no history here")
    assert source.returncode == 0, path
    assert name in {getattr(node, "name", None) for node in ast.parse(source.stdout).body}


def test_a_process_reads_its_clock_before_it_imports_a_library():
    imports = ast.parse(Path(worker.__file__).read_text()).body
    names = {node.module for node in imports if isinstance(node, ast.ImportFrom)}
    names |= {alias.name for node in imports if isinstance(node, ast.Import) for alias in node.names}
    assert {name.partition(".")[0] for name in names} <= sys.stdlib_module_names


def test_a_module_that_lacks_a_library_is_not_looked_for_elsewhere(tmp_path, monkeypatch):
    (tmp_path / "half_installed.py").write_text("import no_such_library")
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setitem(MODULES, "Half", ("half_installed", "json"))
    with pytest.raises(ModuleNotFoundError, match="no_such_library"):
        from_facegear("Half")


def test_numbers_of_irregular_motions_and_of_changed_labels_do_not_count_as_changes():
    value = np.array([[1.0], [2.0], [3.0], [4.0]])
    moved = value * np.array([[1.0], [1.5], [1.0 + 1e-7], [2.0]])
    now = np.where(np.arange(4) == 3, "irregular", MOTIONS)
    change, equal, labels_changed, labels = changes(
        {"motion": MOTIONS, "rms": value}, {"motion": now, "rms": moved}
    )
    assert equal == 0.5
    assert change == pytest.approx(1e-7, rel=1e-6)
    assert (labels_changed, labels) == (1, 4)


def test_a_motion_of_another_period_counts_by_its_label_and_residuals_of_solved_contacts_do_not():
    before = {
        "motion": np.array(["periodic", "periodic"]),
        "period": np.array([1, 2]),
        "rms": np.array([1.0, 2.0]),
    }
    now = {**before, "period": np.array([1, 4]), "rms": np.array([1.0, 3.0])}
    assert changes(before, now)[0] == 0.0
    assert changes({"kkt_residual": np.array([1e-16])}, {"kkt_residual": np.array([5e-16])})[0] == 0.0
    assert changes({"kkt_residual": np.array([1e-16])}, {"kkt_residual": np.array([1e-9])})[0] > 0.0


def test_differences_of_like_numbers_are_compared_down_to_rounding():
    before, now, other = ({"0/k_gamma_missed": np.array([number])} for number in (1e-15, -4e-16, 1e-9))
    assert changes(before, now)[0] == 0.0
    assert changes(before, other)[0] > 0.0


def test_arrays_of_another_shape_are_no_small_change():
    assert changes({"k": np.ones(3)}, {"k": np.ones(4)})[0] == np.inf


def test_an_array_that_is_missing_now_is_no_small_change():
    assert changes({"k": np.ones(3)}, {})[0] == np.inf
    assert changes({"k": np.ones(3)}, {"k": np.array([1.0, np.nan, 1.0])})[0] == np.inf


def test_every_point_is_a_job_or_calls_and_says_where_its_error_stands():
    for point in POINTS.values():
        facegear.load(point.config, results=None).with_values(point.changes)
        if point.stage:
            assert set(STAGES[point.stage].wildcards) == set(point.wildcards) and not point.calls
        assert all(callable(getattr(facegear.Gearbox, name)) for name in point.calls)
        assert Path(point.error.partition(",")[0]).is_file()
        assert json.loads(json.dumps(point.job)) == point.job
