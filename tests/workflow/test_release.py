"""Parts of `make release`: notes, licences and the version; the builds themselves run in `make ci`."""

import hashlib
import importlib.util
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


def script(name):
    """A module of .ci, which is no package."""
    specification = importlib.util.spec_from_file_location(name, ROOT / ".ci" / f"{name}.py")
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    return module


CHANGES = "# Changelog\n\n## Unreleased\n### Added\n- A.\n\n## 0.2.0 (2026-12-01)\n- B.\n\n## 0.1.0\n- C.\n"


@pytest.mark.parametrize(
    ("version", "notes"),
    [
        ("0.2.0", "## 0.2.0 (2026-12-01)\n- B.\n"),
        ("0.1.0", "## 0.1.0\n- C.\n"),
        ("0.2.1.dev3", "## Unreleased\n### Added\n- A.\n"),
    ],
)
def test_release_notes_are_the_changelogs_section_of_the_version(version, notes):
    assert script("release_notes").notes(CHANGES, version) == notes


def test_a_licence_that_nobody_looked_at_stops_the_release():
    check = script("check_licences")
    rows = [
        {"Name": "fine", "Version": "1", "License": "MIT License"},
        {"Name": "New_Library", "Version": "2", "License": "Own terms"},
        {"Name": "gmsh", "Version": "4", "License": "GNU General Public License"},
        {"Name": "only-for-tests", "Version": "1", "License": "UNKNOWN"},
    ]
    assert check.unknown(rows, {"fine", "new-library", "gmsh"}) == [
        "New_Library 2: licence 'Own terms' must be looked at"
    ]


def test_the_list_of_components_names_the_bundled_plotly_with_its_version_and_licence():
    given = {"bomFormat": "CycloneDX", "components": [{"bom-ref": "numpy"}, {"bom-ref": "scipy"}]}
    listed = script("name_bundled").named(given)
    (plotly,) = [part for part in listed["components"] if part["bom-ref"].startswith("plotly.js")]
    assert listed["components"][:2] == given["components"] and listed["bomFormat"] == "CycloneDX"
    assert f"plotly.js-cartesian-dist-min` {plotly['version']}" in (ROOT / "CONTRIBUTING.md").read_text()
    content = (ROOT / "facegear" / "report" / "plotly-cartesian.min.js").read_bytes()
    assert plotly["hashes"] == [{"alg": "SHA-256", "content": hashlib.sha256(content).hexdigest()}]
    assert plotly["licenses"] == [{"license": {"id": "MIT"}}]


def test_the_lock_file_names_what_a_run_installs():
    names = script("check_licences").locked((ROOT / "requirements-run.lock").read_text())
    assert {"numpy", "scikit-fem", "gmsh", "snakemake"} <= names
    assert "pytest" not in names


def test_the_citation_names_the_version_that_copies_without_history_have():
    import tomllib

    version = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["setuptools_scm"][
        "fallback_version"
    ]
    assert f"version: {version}\n" in (ROOT / "CITATION.cff").read_text()
