"""A stage's fingerprint changes when, and only when, code it can reach changes."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from facegear.provenance import fingerprint as provenance_fingerprint
from facegear.provenance.fingerprint import fingerprint, reached_modules, recall, remember

ROOT = Path(__file__).parents[3]


@pytest.fixture
def package(tmp_path):
    files = {
        "facegear/__init__.py": "",
        "facegear/geometry/__init__.py": "",
        "facegear/geometry/flank.py": (
            "from facegear.io import tables\n\ndef flank():\n    '''Doc.'''\n    return tables.x\n"
        ),
        "facegear/io/__init__.py": "",
        "facegear/io/tables.py": "x = 1\n",
        "facegear/plots/__init__.py": "",
        "facegear/plots/flank.py": "import facegear.geometry.flank\n",
        "script.py": "from facegear.geometry.flank import flank\n",
    }
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    return tmp_path


def edit(path, text):
    path.write_text(text)
    stamp = path.stat().st_mtime_ns + 1_000_000
    os.utime(path, ns=(stamp, stamp))


def test_modules_are_found_through_imports_and_parents(package):
    assert reached_modules(package / "script.py", package) == (
        "facegear",
        "facegear.geometry",
        "facegear.geometry.flank",
        "facegear.io",
        "facegear.io.tables",
    )


@pytest.mark.parametrize(
    ("file", "text", "changes"),
    [
        ("facegear/io/tables.py", "x = 2\n", True),
        ("facegear/io/tables.py", "# only a comment\nx  =  1\n", False),
        ("facegear/geometry/__init__.py", '"""Only a docstring."""\n', False),
        ("facegear/plots/flank.py", "import facegear.geometry.flank\ny = 2\n", False),
        ("script.py", "from facegear.geometry.flank import flank\nflank()\n", True),
    ],
)
def test_only_reached_code_counts(package, file, text, changes):
    before = fingerprint(package / "script.py", package)
    edit(package / file, text)
    assert (fingerprint(package / "script.py", package) != before) is changes


@pytest.mark.parametrize("name", ["flanks/rays.hpp", "bindings/flanks.cpp"])
def test_sources_of_compiled_kernels_count_for_what_reaches_them(package, name):
    """A changed formula in C++ would otherwise leave the stored results of the one before."""
    kernels = package / "facegear/_kernels"
    (kernels / "src" / name).parent.mkdir(parents=True)
    edit(kernels / "__init__.py", "")
    edit(kernels / "src" / name, "1")
    without = fingerprint(package / "script.py", package)
    edit(package / "script.py", (package / "script.py").read_text() + "import facegear._kernels\n")
    before = fingerprint(package / "script.py", package)
    edit(kernels / "src" / name, "2")
    assert without != before != fingerprint(package / "script.py", package)


def test_package_never_imports_snakemake():
    guilty = [
        str(path)
        for path in (ROOT / "facegear").rglob("*.py")
        if "import snakemake" in path.read_text() or "from snakemake" in path.read_text()
    ]
    assert guilty == []


def test_what_one_clone_has_parsed_gives_another_the_same_fingerprint_without_parsing(
    package, tmp_path, monkeypatch
):
    """The first start of every clone parsed some 700 files, for three seconds, before it could plan."""
    file = tmp_path / "sources.json"
    monkeypatch.setattr(provenance_fingerprint, "_recalled", set())  # of other tests of this process
    before = fingerprint(package / "script.py", package)
    remember(file)
    moved = shutil.copytree(package, tmp_path / "moved", copy_function=shutil.copyfile)  # with new times
    monkeypatch.setattr(provenance_fingerprint, "_known", {})
    monkeypatch.setattr(provenance_fingerprint, "_parsed", None)
    recall(file)
    assert fingerprint(moved / "script.py", moved) == before
    monkeypatch.undo()
    edit(moved / "facegear/io/tables.py", "x = 2\n")
    assert fingerprint(moved / "script.py", moved) != before


def test_sources_used_last_are_remembered_and_no_more_than_a_limit(package, tmp_path, monkeypatch):
    """Every version of a file that was ever edited would stay."""
    file = tmp_path / "sources.json"
    monkeypatch.setattr(provenance_fingerprint, "_known", {})
    monkeypatch.setattr(provenance_fingerprint, "KEPT", 3)
    fingerprint(package / "script.py", package)
    edit(package / "facegear/io/tables.py", "x = 3\n")
    fingerprint(package / "script.py", package)
    last = [*provenance_fingerprint._known][-3:]
    remember(file)
    monkeypatch.setattr(provenance_fingerprint, "_known", {})
    recall(file)
    assert [*provenance_fingerprint._known] == last


@pytest.mark.parametrize("text", ["", "{}", "[]", '{"version": "another", "files": {}}', "\xff"])
def test_a_damaged_memory_is_passed_over(package, tmp_path, text):
    file = tmp_path / "sources.json"
    file.write_text(text, encoding="latin-1")
    recall(file)
    assert fingerprint(package / "script.py", package)


def test_reading_configs_leaves_solvers_and_tables_unloaded():
    """They took most of the five seconds in which a start with nothing to do ended."""
    code = (
        "import sys, paper.reproduction\n"
        "from facegear.config.cases import expand_cases\n"
        "from facegear.config.load import load_config\n"
        "expand_cases(load_config('config/paper.yaml'))\n"
        "print(*{'pandas', 'skfem', 'xarray', 'matplotlib', 'scipy.interpolate'} & {*sys.modules})"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == ""
