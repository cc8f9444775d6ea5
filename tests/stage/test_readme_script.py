"""The README's first script does what it says, from the installed wheel, in a folder that holds nothing."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text()
(SCRIPT,) = re.findall(r"```python\n(.*?)```", README, re.DOTALL)
FILES = {
    "facegear/py.typed",
    "facegear/example.yaml",
    "facegear/schema/config.schema.json",
    "facegear/report/page.html.j2",
    "facegear/report/page.css",
    "facegear/report/plotly-cartesian.min.js",
}


TENANTS = ("paper", "validation")
HELD = {"facegear", "snakemake_logger_plugin_facegear", "bin"}
BUILT = ("--config-settings=wheel.cmake=false", "--config-settings=wheel.py-api=py3")
"""The kernels are not compiled again: those of the checkout are put into the installed package."""


def pip(*arguments):
    command = [sys.executable, "-m", "pip", "--disable-pip-version-check", *arguments]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.fixture(scope="module")
def installed(tmp_path_factory):
    """Where the wheel of the sources as they stand is installed; no network, nothing of the checkout."""
    sources, wheels, site = (tmp_path_factory.mktemp(name) for name in ("sources", "wheels", "site"))
    for name in ("facegear", "snakemake_logger_plugin_facegear", "building", *TENANTS):
        ignored = shutil.ignore_patterns("__pycache__", "*.egg-info")
        shutil.copytree(ROOT / name, sources / name, ignore=ignored)
    for name in ("pyproject.toml", "README.md", "LICENSE", "CMakeLists.txt"):
        shutil.copy(ROOT / name, sources)
    offline = ("--no-deps", "--no-index", "--no-cache-dir")
    pip("wheel", *offline, *BUILT, "--no-build-isolation", "--wheel-dir", str(wheels), str(sources))
    (wheel,) = wheels.glob("facegear-*.whl")
    pip("install", *offline, "--no-compile", "--target", str(site), str(wheel))
    for module in (ROOT / "facegear" / "_kernels").glob("_*.so"):
        shutil.copy(module, site / "facegear" / "_kernels")
    return site


def run_installed(script, site, folder):
    done = subprocess.run(
        [sys.executable, "-c", script],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(site)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_readme_script_has_at_most_twelve_lines_and_stands_on_the_first_screen():
    assert len([line for line in SCRIPT.splitlines() if line]) <= 12
    assert README.index(SCRIPT) < 2500


@pytest.mark.xdist_group("wheel")
def test_wheel_holds_every_module_template_and_schema(installed):
    modules = {str(path.relative_to(ROOT)) for path in (ROOT / "facegear").rglob("*.py")}
    held = {str(path.relative_to(installed)) for path in installed.rglob("*") if path.is_file()}
    assert modules | FILES <= held


@pytest.mark.xdist_group("wheel")
def test_wheel_holds_neither_the_reproduction_nor_the_validation(installed):
    assert {path.name for path in installed.iterdir() if path.suffix != ".dist-info"} == HELD


@pytest.mark.xdist_group("wheel")
def test_wheel_brings_the_command_facegear(installed):
    assert [path.name for path in (installed / "bin").iterdir()] == ["facegear"]
    given = {**os.environ, "PYTHONPATH": str(installed)}
    done = subprocess.run(
        [installed / "bin" / "facegear", "--version"], env=given, capture_output=True, text=True, check=True
    )
    assert re.fullmatch(r"facegear \d\S*\n", done.stdout)


@pytest.mark.xdist_group("wheel")
def test_readme_script_runs_from_the_wheel_in_an_empty_folder(installed, tmp_path):
    printed = run_installed(f"{SCRIPT}\nprint(facegear.__file__)", installed, tmp_path)
    assert "frequency_hz" in printed and "[28 rows" in printed, "a mode for each degree of freedom"
    assert printed.splitlines()[-1] == str(installed / "facegear" / "__init__.py")
    pictures = {path.name: path.read_bytes()[:4] for path in tmp_path.iterdir()}
    assert pictures == dict.fromkeys(("contact_pattern.png", "load_sharing.png"), b"\x89PNG")
