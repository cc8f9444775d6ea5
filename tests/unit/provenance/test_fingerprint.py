"""A stage's fingerprint changes when, and only when, code it can reach changes."""

import os
from pathlib import Path

import pytest

from facegear.provenance.fingerprint import fingerprint, reached_modules

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


def test_package_never_imports_snakemake():
    guilty = [
        str(path)
        for path in (ROOT / "facegear").rglob("*.py")
        if "import snakemake" in path.read_text() or "from snakemake" in path.read_text()
    ]
    assert guilty == []
