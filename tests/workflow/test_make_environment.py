"""Environments in `.venv` that `make` finds: kept, mended, or made anew."""

import shutil
import subprocess
import sys
import venv
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture
def checkout(tmp_path):
    """Return a folder that holds what `make` needs for its environment, and no package in its locks."""
    shutil.copy(ROOT / "Makefile", tmp_path)
    (tmp_path / "building").mkdir()
    shutil.copy(ROOT / "building" / "environment.py", tmp_path / "building")
    for name in ("run", "build", "zig"):
        (tmp_path / f"requirements-{name}.lock").write_text("numpy==2.0 \\\n    --hash=sha256:0\n")
    (tmp_path / "pyproject.toml").touch()
    return tmp_path


def make(folder, *words):
    """Run make in a folder, and return what it printed."""
    done = subprocess.run(
        ["make", f"PYTHON={sys.executable}", *words], cwd=folder, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def assert_pip_runs(folder):
    subprocess.run([folder / ".venv" / "bin" / "pip", "--version"], check=True, capture_output=True)


def test_an_environment_without_pip_gets_it_and_keeps_what_it_holds(checkout):
    """uv makes such environments: all commands of make ended with `No such file`."""
    venv.create(checkout / ".venv", symlinks=True)
    own = checkout / ".venv" / "own"
    own.touch()
    (checkout / ".venv" / "run").touch()
    assert "pip install" in make(checkout, "-n", ".venv/run"), "what a lock names is not there"
    make(checkout, ".venv/bin/pip")
    assert_pip_runs(checkout)
    assert own.exists()


def test_an_environment_whose_python_was_removed_is_made_anew(checkout):
    venv.create(checkout / ".venv", symlinks=True)
    python = checkout / ".venv" / "bin" / "python"
    python.unlink()
    python.symlink_to("/removed/python")
    (checkout / ".venv" / "bin" / "pip").touch()
    (checkout / ".venv" / "run").touch()
    assert "made anew" in make(checkout, ".venv/bin/pip")
    assert_pip_runs(checkout)
    assert not (checkout / ".venv" / "run").exists(), "the packages are installed again"


def test_packages_that_no_lock_names_are_kept_and_listed_with_what_removes_them(checkout):
    """An older version's libraries stayed without a word; a user's own are not for make to remove."""
    for name in ("numpy", "old_library", "facegear"):
        metadata = checkout / "site" / f"{name}-1.dist-info" / "METADATA"
        metadata.parent.mkdir(parents=True)
        metadata.write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 1\n")
    listed = subprocess.run(
        [sys.executable, "-S", "building/environment.py", "--check"],
        cwd=checkout,
        env={"PYTHONPATH": str(checkout / "site")},
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    assert "`.venv/bin/pip uninstall old-library` removes" in listed
    assert (checkout / "site" / "old_library-1.dist-info").exists()
